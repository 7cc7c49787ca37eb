// Rows as text, and the table that they are kept in.
#include "experiments/runner/row.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/test_support.hpp"
#include "experiments/runner/row_table.hpp"

namespace agricolmap::experiments {
namespace {

Row someRow(int seed) {
  Row row;
  row.suite = "translation";
  row.settings = "develop";
  row.case_name = "soybean";
  row.seed = seed;
  row.setting = 0.25;
  row.method = "default:grid.cell=0.03";
  row.accepted = row.right = true;
  row.rms = 0.0061234567;
  row.message = "no plants, at \"all\"\nhere";
  row.source = "abc1234";
  row.options = "0123456789abcdef";
  return row;
}

TEST(Row, EveryColumnComesBack) {
  Row row = someRow(7);
  int number = 1;
  for (const Column& column : columns()) {
    if (const auto* real = std::get_if<double Row::*>(&column.member)) row.*(*real) = number;
    if (const auto* whole = std::get_if<int Row::*>(&column.member)) row.*(*whole) = number;
    if (const auto* flag = std::get_if<bool Row::*>(&column.member)) row.*(*flag) = number % 2 == 0;
    if (const auto* text = std::get_if<std::string Row::*>(&column.member)) {
      row.*(*text) = std::to_string(number);
    }
    ++number;
  }
  std::string line = toCsv(row);
  line.pop_back();
  const Row back = rowFromCsv(line, "rows.csv:2");
  EXPECT_EQ(toCsv(back), toCsv(row));
  EXPECT_EQ(back.suite, "1");
  EXPECT_EQ(back.options, std::to_string(columns().size()));
}

TEST(Row, ColumnsHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Column& column : columns()) EXPECT_TRUE(names.insert(column.name).second);
  Row row;
  row.*numberColumn("uniqueness") = 2.0;
  EXPECT_EQ(row.uniqueness, 2.0);
  EXPECT_THROW(numberColumn("beauty"), Error);
  EXPECT_THROW(numberColumn("method"), Error);
}

TEST(Row, TextsDoNotPartFieldsOrLines) {
  std::string line = toCsv(someRow(7));
  line.pop_back();
  const Row back = rowFromCsv(line, "rows.csv:2");
  EXPECT_EQ(back.message, "no plants; at 'all' here");
  EXPECT_DOUBLE_EQ(back.rms, 0.0061234567);
  EXPECT_TRUE(std::isnan(back.e_s)) << "what there is not is empty";
}

TEST(Row, DamagedLinesAreNamed) {
  test::expectError<InputError>([] { rowFromCsv("a,b", "rows.csv:9"); },
                                {"rows.csv:9", "2 fields", "damaged"});
  Row row = someRow(7);
  std::string line = toCsv(row);
  line.pop_back();
  line.replace(line.find(",0.25,"), 6, ",much,");
  test::expectError<InputError>([&] { rowFromCsv(line, "rows.csv:9"); },
                                {"rows.csv:9", "'much' is no number"});
}

TEST(RowTable, RowsSurviveReopening) {
  const test::TempDir folder;
  {
    RowTable table(folder / "rows.csv", "abc1234");
    table.append(someRow(7));
    EXPECT_NE(table.find(someRow(7).key()), nullptr);
    EXPECT_THROW(RowTable(folder / "rows.csv", "abc1234"), OutputError) << "in use";
  }
  std::ofstream(folder / "rows.csv", std::ios::app) << "translation,develop,soy";  // a crash
  {
    RowTable table(folder / "rows.csv", "abc1234");
    ASSERT_EQ(table.rows().size(), 1U);
    EXPECT_NE(table.find(someRow(7).key()), nullptr);
    EXPECT_EQ(table.find(someRow(8).key()), nullptr);
    table.append(someRow(8));
  }
  EXPECT_EQ(RowTable(folder / "rows.csv", "abc1234").rows().size(), 2U);
}

TEST(RowTable, RowsOfOtherSourcesOrColumnsAreRefused) {
  const test::TempDir folder;
  RowTable(folder / "rows.csv", "abc1234").append(someRow(7));
  test::expectError<InputError>([&] { RowTable(folder / "rows.csv", "def5678"); },
                                {"rows.csv:2", "abc1234", "def5678", "another --output"});
  folder.write("old.csv", "case,seed\n");
  test::expectError<InputError>([&] { RowTable(folder / "old.csv", "abc1234"); },
                                {"old.csv", "other columns", "another --output"});
  EXPECT_THROW(RowTable(folder / "no" / "rows.csv", "abc1234"), OutputError);
}

}  // namespace
}  // namespace agricolmap::experiments
