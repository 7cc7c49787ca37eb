// Options: where they come from, which wins, and what is said about those that make no sense.
#include <gtest/gtest.h>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

using OptionsTest = CliTest;

TEST_F(OptionsTest, ADumpedConfigurationGivesTheSameOptions) {
  for (const std::string verb : {"register", "simulate"}) {
    const ProgramResult dumped = runAgricolmap({verb, "--dump-config"});
    ASSERT_EQ(dumped.exit_code, 0) << dumped.err;
    const std::string file = write(verb + ".yaml", dumped.out);
    const ProgramResult again = runAgricolmap({verb, "--config", file, "--dump-config"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.out, dumped.out);
  }
}

TEST_F(OptionsTest, FlagsWinOverTheFileAndTheFileOverThePreset) {
  const std::string file = write("options.yaml", "grid:\n  cell: 0.03\n  sigma: 0.05\n");
  const ProgramResult result = runAgricolmap(
      {"register", "--preset", "paper", "--config", file, "--grid.sigma", "0.07", "--dump-config"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("cell: 0.03"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("sigma: 0.07"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("association: flow"), std::string::npos) << result.out;
}

TEST_F(OptionsTest, EveryPresetCanBeWrittenAndReadBack) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--preset", "default"},
                                               {"--preset", "paper"},
                                               {"--preset", "paper-literal"},
                                               {"--geometry-only"},
                                               {"--signal.term", "rgb"},
                                               {"--association", "flow"},
                                               {"--seed", "7"}}) {
    std::vector<std::string> arguments = {"register", "--dump-config"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult dumped = runAgricolmap(arguments);
    ASSERT_EQ(dumped.exit_code, 0) << dumped.err;
    const std::string file = write("all.yaml", dumped.out);
    EXPECT_EQ(runAgricolmap({"register", "--config", file, "--dump-config"}).out, dumped.out);
  }
}

TEST_F(OptionsTest, TheSeedOfTheFileGivesWayToTheFlag) {
  const std::string file = write("seed.yaml", "seed: 3\n");
  for (const std::string verb : {"register", "simulate"}) {
    const auto seedOf = [&](std::vector<std::string> arguments) {
      arguments.insert(arguments.begin(), {verb, "--dump-config"});
      const std::string out = runAgricolmap(arguments).out;
      const std::size_t at = out.find("\nseed: ");
      return at == std::string::npos ? out : out.substr(at + 7, out.find('\n', at + 7) - at - 7);
    };
    EXPECT_EQ(seedOf({}), "1");
    EXPECT_EQ(seedOf({"--config", file}), "3");
    EXPECT_EQ(seedOf({"--config", file, "--seed", "1"}), "1");
  }
}

TEST_F(OptionsTest, FlagsMayBeSpelledAsKeysOfTheFile) {
  const ProgramResult dashes =
      runAgricolmap({"register", "--prior.heading-deg=3", "--geometry-only", "--dump-config"});
  const ProgramResult underscores =
      runAgricolmap({"register", "--prior.heading_deg=3", "--geometry_only", "--dump_config"});
  EXPECT_EQ(dashes.exit_code, 0) << dashes.err;
  EXPECT_NE(dashes.out.find("heading_deg: 3\n"), std::string::npos) << dashes.out;
  EXPECT_EQ(underscores.out, dashes.out) << underscores.err;
}

TEST_F(OptionsTest, WhatWouldDoNothingIsRefused) {
  const auto expectIdle = [&](const std::vector<std::string>& more, const std::string& option,
                              const std::string& missing) {
    std::vector<std::string> arguments = {"register", "--dump-config"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expectFailure(arguments, 2, {option, missing});
  };
  expectIdle({"--flow.flow.levels", "2"}, "--flow.flow.levels", "association = flow");
  expectIdle({"--affine.least", "10"}, "--affine.least", "association = flow");
  expectIdle({"--cpd.decay", "0.5"}, "--cpd.decay", "refine = cpd");
  expectIdle({"--preset", "paper", "--search.cell", "0.1"}, "--search.cell",
             "association = correlation");
  expectIdle({"--preset", "paper", "--dense.hops", "2"}, "--dense.hops", "refine = dense");
  expectIdle({"--preset", "paper-literal", "--flow.scale-tolerance", "0.1"},
             "--flow.scale-tolerance", "flow.warps = true");
  expectIdle({"--geometry-only", "--signal.term", "exg"}, "--signal.term", "geometry_only");
  // As a flag even at its default; in a file, which may list all options, only otherwise.
  expectIdle({"--flow.flow.levels", "3"}, "--flow.flow.levels", "association = flow");
  const std::string usual = write("usual.yaml", "flow: {flow: {levels: 3}}\n");
  EXPECT_EQ(runAgricolmap({"register", "--config", usual, "--dump-config"}).exit_code, 0);
  const std::string other = write("other.yaml", "flow: {flow: {levels: 2}}\n");
  expectIdle({"--config", other}, "flow.flow.levels = 2", "association = flow");
  EXPECT_EQ(runAgricolmap({"register", "--config", other, "--association", "flow", "--dump-config"})
                .exit_code,
            0);
  // What a preset brings along is nobody's request.
  EXPECT_EQ(runAgricolmap({"register", "--preset", "paper-literal", "--association", "correlation",
                           "--dump-config"})
                .exit_code,
            0);
}

TEST_F(OptionsTest, HelpHasWhatIsForUsersAndHelpAllTheRest) {
  const std::string some = runAgricolmap({"register", "--help"}).out;
  const std::string all = runAgricolmap({"register", "--help-all"}).out;
  for (const char* basic : {"--grid.cell", "--prior.heading-deg", "--verdict.min-probability"}) {
    EXPECT_NE(some.find(basic), std::string::npos) << basic;
    EXPECT_NE(all.find(basic), std::string::npos) << basic;
  }
  for (const char* advanced : {"--dense.hop ", "--flow.describe.daisy.radius"}) {
    EXPECT_EQ(some.find(advanced), std::string::npos) << advanced;
    EXPECT_NE(all.find(advanced), std::string::npos) << advanced;
  }
  EXPECT_NE(some.find("agricolmap register --help-all"), std::string::npos) << some;
  EXPECT_EQ(all.find("more options"), std::string::npos);
}

TEST_F(OptionsTest, AConfigurationIsObeyed) {
  const PairFiles files = pair();
  const std::string file = write("options.yaml", "grid:\n  cell: 0.04\n");
  const ProgramResult result = runAgricolmap({"register", files.uav(), files.ugv(), "--config",
                                              file, "-o", inFolder("out"), "--no-pictures"});
  ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 10) << result.err;
  const nlohmann::json report = jsonOf(inFolder("out/registration.json"));
  EXPECT_NEAR(report.at("options").at("grid").at("cell").get<double>(), 0.04, 1e-12);
}

TEST_F(OptionsTest, MisuseIsNamed) {
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(3.0)));
  expectFailure({}, 2, {});
  expectFailure({"registre"}, 2, {"registre"});
  expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--grid.sell", "1"}, 2,
                {"no option '--grid.sell'", "--grid.cell"});
  expectFailure({"register", cloud, cloud, "--prior-sgima", "1,2,3", "-o", inFolder("out")}, 2,
                {"register has no option '--prior-sgima'; is --prior-sigma meant?"});
  expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--wheels=4"}, 2,
                {"register has no option '--wheels'; see agricolmap register --help"});
  expectFailure({"info", cloud, cloud}, 2, {"cloud.ply' is more than info takes"});
  expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--preset", "papre"}, 2,
                {"papre", "paper"});
  expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--grid.cell", "-1"}, 2,
                {"grid.cell", "-1"});
  expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--grid.cell", "small"}, 2,
                {"grid.cell", "small"});
  expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--threads", "-3"}, 2,
                {"--threads"});
  for (const char* sigma : {"5", "5,11.5", "5,11.5,30,1", "a,b,c", "nothing"}) {
    expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--prior-sigma", sigma}, 2,
                  {"--prior-sigma", sigma, "T_M,HEADING_DEG,SCALE_PERCENT"});
  }
  for (const char* sigma : {"-5,11.5,30", "5,200,30", "5,11.5,90", "nan,1,1"}) {
    expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--prior-sigma", sigma}, 2,
                  {"--prior-sigma", sigma, "prior."});
  }
  expectFailure({"register", cloud, cloud, "-o", inFolder("out"), "--prior-sigma", "none",
                 "--preset", "paper"},
                2, {"flow", "--prior-sigma"});
  expectFailure({"register", cloud, "-o", inFolder("out")}, 2, {"MOVING"});
  expectFailure({"register", cloud, cloud}, 2, {"-o"});
  expectFailure({"simulate"}, 2, {"-o"});
  expectFailure({"evaluate", cloud, cloud}, 2, {"--truth"});
}

TEST_F(OptionsTest, ConfigurationsThatMakeNoSenseAreNamed) {
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(3.0)));
  const auto expectBad = [&](const std::string& name, const std::string& text,
                             const std::string& part) {
    const std::string file = write(name, text);
    expectFailure({"register", cloud, cloud, "--config", file, "-o", inFolder("out")}, 2,
                  {file, part});
  };
  expectBad("unknown.yaml", "grid:\n  sell: 0.03\n", "grid.cell");
  expectBad("limits.yaml", "grid:\n  cell: 300\n", "grid.cell");
  expectBad("type.yaml", "grid:\n  cell: [1, 2]\n", "grid.cell");
  expectBad("twice.yaml", "grid:\n  cell: 0.1\n  cell: 0.2\n", "cell");
  expectBad("syntax.yaml", "grid: {cell: 0.1\n", "");
  const std::string none = inFolder("none.yaml");
  expectFailure({"register", cloud, cloud, "--config", none, "-o", inFolder("out")}, 3,
                {none, "no such file"});
}

TEST_F(OptionsTest, HelpAndVersionAreNoErrors) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"register", "--help"}, {"--version"}}) {
    const ProgramResult result = runAgricolmap(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(result.out.empty());
  }
}

}  // namespace
}  // namespace agricolmap::test
