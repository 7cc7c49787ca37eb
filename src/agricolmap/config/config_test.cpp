#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "agricolmap/config/json.hpp"
#include "agricolmap/config/markdown.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap::config {
namespace {

using testing::HasSubstr;

enum class Kind { kPlain, kChromatic };
struct LeafOptions {
  double rate = 0.25;
};
struct GridLike {
  double cell = 0.02;
  LeafOptions leaf;
  Kind exg = Kind::kChromatic;
};
struct AllOptions {
  bool fast = true;
  GridLike grid;
  int count = 3;
};
void listOptions(OptionTable& table, LeafOptions& o) {
  table.number("rate", o.rate, 0.0, 1.0, "1/s", "how often; 'now: or # never'");
}
void listOptions(OptionTable& table, GridLike& o) {
  table.number("cell", o.cell, 0.005, 1.0, "m", "side of a cell");
  table.group("leaf", o.leaf);
  table.choice("exg", o.exg, {"plain", "chromatic"}, "plain | chromatic\nindex");
}
void listOptions(OptionTable& table, AllOptions& o) {
  table.flag("fast", o.fast, "whether to hurry");
  table.group("grid", o.grid);
  table.integer("count", o.count, 1, 5, "", "how many");
}

/// The message of the UsageError that `text` causes; options must stay as they were.
std::string refusal(const std::string& text) {
  AllOptions options;
  OptionTable table = optionTable(options);
  const std::string before = dumpYaml(table);
  try {
    loadYamlText(text, "my.yaml", table);
  } catch (const UsageError& error) {
    EXPECT_EQ(dumpYaml(table), before);
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << text;
  return "";
}

TEST(Yaml, SetsWhatIsNamedAndKeepsTheRest) {
  AllOptions options;
  OptionTable table = optionTable(options);
  loadYamlText("fast: false\ngrid:\n  cell: 5e-2\n  leaf: {rate: 1}\n", "my.yaml", table);
  EXPECT_FALSE(options.fast);
  EXPECT_EQ(options.grid.cell, 0.05);
  EXPECT_EQ(options.grid.leaf.rate, 1.0);
  EXPECT_EQ(options.grid.exg, Kind::kChromatic);
  EXPECT_EQ(options.count, 3);
  loadYamlText("grid.exg: plain\ncount: 5", "my.yaml", table);
  EXPECT_EQ(options.grid.exg, Kind::kPlain);
  EXPECT_EQ(options.count, 5);
  for (const char* nothing : {"", "# only a comment\n", "grid:\n", "---\n"}) {
    EXPECT_NO_THROW(loadYamlText(nothing, "my.yaml", table));
  }
}

TEST(Yaml, DumpReadsBackTheSameBits) {
  AllOptions options;
  options.fast = false;
  options.count = 4;
  options.grid.cell = 0.1 + 0.2;
  options.grid.leaf.rate = 1.0 / 3.0;
  options.grid.exg = Kind::kPlain;
  const std::string text = dumpYaml(optionTable(options));
  AllOptions back;
  OptionTable table = optionTable(back);
  loadYamlText(text, "dump", table);
  EXPECT_EQ(back.fast, options.fast);
  EXPECT_EQ(back.count, options.count);
  EXPECT_EQ(back.grid.cell, options.grid.cell);
  EXPECT_EQ(back.grid.leaf.rate, options.grid.leaf.rate);
  EXPECT_EQ(back.grid.exg, options.grid.exg);
  EXPECT_EQ(dumpYaml(table), text);
}

TEST(Yaml, DumpExplainsEveryOption) {
  AllOptions options;
  EXPECT_EQ(dumpYaml(optionTable(options)), R"(# true or false; whether to hurry
fast: true
grid:
  # 0.005 to 1 m; side of a cell
  cell: 0.02
  leaf:
    # 0 to 1 1/s; how often; 'now: or # never'
    rate: 0.25
  # plain or chromatic; plain | chromatic index
  exg: chromatic
# 1 to 5; how many
count: 3
)");
}

TEST(Yaml, NamesUnknownKeysAndTheClosestKnownOne) {
  const std::string message = refusal("fast: true\ngrid:\n  cel: 0.1\n");
  EXPECT_THAT(message, HasSubstr("my.yaml:3:"));
  EXPECT_THAT(message, HasSubstr("'grid.cel'"));
  EXPECT_THAT(message, HasSubstr("did you mean 'grid.cell'"));
  EXPECT_THAT(refusal("cell: 0.1"), HasSubstr("did you mean 'grid.cell'"));
  EXPECT_THAT(refusal("gird: {cell: 0.1}"),
              HasSubstr("unknown option 'gird' (did you mean 'grid'"));
  EXPECT_EQ(refusal("completely_different_thing: 1").find("did you mean"), std::string::npos);
}

TEST(Yaml, RefusesWrongTypesAndLimitsWithTheirLine) {
  const auto check = [](const std::string& text, const std::string& part) {
    const std::string message = refusal(text);
    EXPECT_THAT(message, HasSubstr("my.yaml:2:")) << text;
    EXPECT_THAT(message, HasSubstr(part)) << text;
  };
  check("fast: no\ngrid: {cell: 5}", "0.005 to 1 m");
  check("fast: no\ngrid: {cell: wide}", "'wide'");
  check("fast: no\ngrid: {cell: .nan}", "grid.cell");
  check("fast: no\ngrid: {cell: nan}", "grid.cell");
  check("fast: no\ngrid: {cell: 0.02 m}", "grid.cell");
  check("fast: no\ngrid: {cell: }", "needs one value");
  check("fast: no\ngrid: {cell: [0.02]}", "needs one value");
  check("fast: no\ngrid: {exg: green}", "plain or chromatic");
  check("fast: no\ngrid: 3", "needs a map");
  check("grid: {cell: 0.1}\ncount: 2.5", "whole number");
  check("grid: {cell: 0.1}\ncount: 99999999999", "1 to 5");
  check("grid: {cell: 0.1}\nfast: perhaps", "true or false");
  check("count: 2\ncount: 3", "line 1 already");
  check("grid: {cell: 0.1}\ngrid.cell: 0.2", "line 1 already");
  check("count: 1\n? [a, b]\n: 3", "plain text");
}

TEST(Yaml, RefusesWhatIsNoMapOfOptions) {
  EXPECT_THAT(refusal("- a\n- b"), HasSubstr("map of options"));
  EXPECT_THAT(refusal("just text"), HasSubstr("map of options"));
  EXPECT_THAT(refusal("fast: true\n  count: [1"), HasSubstr("my.yaml:"));
  EXPECT_THAT(refusal("count: 2\n---\ncount: 3"), HasSubstr("second document"));
  EXPECT_THAT(refusal("grid: &g {leaf: *g}"), HasSubstr("unknown option"));
  EXPECT_THAT(refusal(",count: 3"), HasSubstr("my.yaml:1: not valid YAML"));
}

TEST(Yaml, ReadsFilesAndSaysWhichItCannot) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("agricolmap_config_" + std::to_string(::getpid()) + ".yaml");
  std::ofstream(file) << "count: 2\n";
  AllOptions options;
  OptionTable table = optionTable(options);
  loadYaml(file, table);
  EXPECT_EQ(options.count, 2);
  std::filesystem::remove(file);
  EXPECT_THROW(loadYaml(file, table), InputError);
  EXPECT_THROW(loadYaml(std::filesystem::temp_directory_path(), table), InputError);
}

TEST(Text, SetsNothingBeforeAsked) {
  AllOptions options;
  const OptionTable table = optionTable(options);
  const std::function<void()> set = parseOption(*table.find("count"), "+5");
  EXPECT_EQ(options.count, 3);
  set();
  EXPECT_EQ(options.count, 5);
  EXPECT_THROW(parseOption(*table.find("count"), ""), UsageError);
  EXPECT_THROW(parseOption(*table.find("count"), " 2"), UsageError);
  EXPECT_THROW(parseOption(*table.find("count"), "+-2"), UsageError);
}

TEST(Json, NestsGroupsInOrder) {
  AllOptions options;
  EXPECT_EQ(
      toJson(optionTable(options)).dump(),
      R"({"fast":true,"grid":{"cell":0.02,"leaf":{"rate":0.25},"exg":"chromatic"},"count":3})");
}

/// One option for users, one that is not.
struct MixedOptions {
  double near = 1.0;
  GridLike grid;
};
void listOptions(OptionTable& table, MixedOptions& o) {
  table.number("near", o.near, 0.0, 2.0, "m", "what is near").basic();
  table.group("grid", o.grid, "the grid");
}

TEST(Levels, AreToldApartWhereThereAreBoth) {
  AllOptions plain;
  EXPECT_FALSE(hasLevels(optionTable(plain)));
  MixedOptions options;
  const OptionTable table = optionTable(options);
  EXPECT_TRUE(hasLevels(table));
  EXPECT_THAT(dumpYaml(table), HasSubstr("# 0 to 2 m; what is near\nnear: 1\n"));
  EXPECT_THAT(dumpYaml(table), HasSubstr("# advanced; 0.005 to 1 m; side of a cell\n"));
  const std::string text = toMarkdown(table);
  EXPECT_EQ(text.find("### For users"), 0U);
  EXPECT_THAT(text, HasSubstr("### All: grid, the grid\n"));
  EXPECT_LT(text.find("| `near`"), text.find("### All"));
  EXPECT_GT(text.find("| `grid.cell`"), text.find("### All: grid"));
}

TEST(Yaml, NamesWhatItSet) {
  AllOptions options;
  OptionTable table = optionTable(options);
  const std::vector<std::string> expected = {"count", "grid.leaf.rate"};
  EXPECT_EQ(loadYamlText("grid: {leaf: {rate: 1}}\ncount: 3", "my.yaml", table), expected);
}

TEST(Markdown, IsATableWithOneRowPerOption) {
  AllOptions options;
  const std::string text = toMarkdown(optionTable(options));
  EXPECT_THAT(text, HasSubstr("| `grid.cell` | 0.02 | m | 0.005 to 1 | side of a cell |\n"));
  EXPECT_THAT(text, HasSubstr("| plain or chromatic | plain \\| chromatic index |\n"));
  EXPECT_THAT(text, HasSubstr("| `fast` | true |  |  | whether to hurry |\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 7);
}

}  // namespace
}  // namespace agricolmap::config
