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
  for (const std::string preset : {"default", "paper"}) {
    const ProgramResult dumped = runAgricolmap({"register", "--preset", preset, "--dump-config"});
    ASSERT_EQ(dumped.exit_code, 0) << dumped.err;
    const std::string file = write(preset + ".yaml", dumped.out);
    EXPECT_EQ(runAgricolmap({"register", "--config", file, "--dump-config"}).out, dumped.out);
  }
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
                {"--grid.sell"});
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
  expectFailure({"register", cloud, cloud, "--config", none, "-o", inFolder("out")}, 3, {none});
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
