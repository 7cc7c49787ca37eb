#include "agricolmap/control_points/control_points_file.hpp"

#include <gtest/gtest.h>

#include "agricolmap/io/test_support.hpp"

namespace agricolmap::control_points {
namespace {

using test::TempDir;

const std::string kHeader = "name,moving_x,moving_y,moving_z,fixed_x,fixed_y,fixed_z,use\n";

void fails(const std::string& content, std::initializer_list<const char*> parts) {
  const TempDir folder;
  const auto path = folder.write("pairs.csv", content);
  test::expectError<InputError>([&] { readControlPairs(path); }, {path.c_str()});
  test::expectError<InputError>([&] { readControlPairs(path); }, parts);
}

TEST(ControlPointsFile, ReadsWhatASpreadsheetWrites) {
  const TempDir folder;
  const auto pairs = readControlPairs(
      folder.write("pairs.csv",
                   "\xEF\xBB\xBF# picked on 24 May\r\n"
                   "Use,Name,note,moving_x,moving_y,moving_z,fixed_x,fixed_y,fixed_z\r\n"
                   ",A1,plant,1.5,-2,+0.25,432017.25,5255321.75,4.1e2\r\n"
                   "\r\n"
                   ",,,,,,,,\r\n"
                   "  # a comment\r\n"
                   "Check, \"post, \"\"north\"\"\" ,,1,2,3,4,5,6"));
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].name, "A1");
  EXPECT_EQ(pairs[0].use, PairUse::kControl);
  EXPECT_EQ(pairs[0].moving, Eigen::Vector3d(1.5, -2.0, 0.25));
  EXPECT_EQ(pairs[0].fixed, Eigen::Vector3d(432017.25, 5255321.75, 410.0));
  EXPECT_EQ(pairs[1].name, "post, \"north\"");
  EXPECT_EQ(pairs[1].use, PairUse::kCheck);
}

TEST(ControlPointsFile, OtherSeparatorsAndNoUse) {
  const TempDir folder;
  for (const char separator : {';', '\t'}) {
    std::string text =
        "name,moving_x,moving_y,moving_z,fixed_x,fixed_y,fixed_z\na,1,2,3,4,5,6\nb,6,5,4,3,2,1\n";
    std::replace(text.begin(), text.end(), ',', separator);
    const auto pairs = readControlPairs(folder.write("pairs.csv", text));
    ASSERT_EQ(pairs.size(), 2U);
    EXPECT_EQ(pairs[1].moving, Eigen::Vector3d(6, 5, 4));
    EXPECT_EQ(pairs[1].use, PairUse::kControl);
  }
}

TEST(ControlPointsFile, ErrorsNameThePlaceAndTheRemedy) {
  fails("name,moving_x,moving_y,fixed_x,fixed_y,fixed_z\n",
        {"line 1", "lacks moving_z", "name,moving_x"});
  fails("# only a comment\n", {"line 1", "no header"});
  fails("1,2,3,4,5,6,7\n", {"line 1", "lacks moving_x", "name"});
  fails("name,moving_x,moving_x,moving_y,moving_z,fixed_x,fixed_y,fixed_z\n",
        {"line 1", "column moving_x", "twice"});
  fails(kHeader + "a,1,2,3,4,5,6,\nb,1,2,three,4,5,6,\n",
        {"line 3", "column moving_z", "'three' is no number", "decimal point"});
  fails(kHeader + "a,1,2,3,4,5 m,6,\n", {"line 2", "column fixed_y", "'5 m'", "unit"});
  fails(kHeader + "a,1,2,3,4,nan,6,\n", {"line 2", "column fixed_y", "not finite"});
  fails(kHeader + "a,1,2,3,4,,6,\n", {"line 2", "column fixed_y", "no number"});
  fails(kHeader + "a,1,2,3,4,5,1e999,\n", {"line 2", "column fixed_z", "not finite"});
  fails(kHeader + "a,1,2,3,4,5,6,maybe\n", {"line 2", "column use", "'maybe'", "'check'"});
  fails(kHeader + "a,1,2,3,4,5,6,\n\na,1,2,3,4,5,6,\n",
        {"line 4", "column name", "'a' is the name of line 2", "rename"});
  fails(kHeader + ",1,2,3,4,5,6,\n", {"line 2", "column name", "no name"});
  fails(kHeader + "a,1,5,2,3,4,5,6,\n", {"line 2", "9 fields", "has 8", "decimal comma"});
  fails(kHeader + "a,1,2,3\n", {"line 2", "4 fields"});
  fails(kHeader + "\"a,1,2,3,4,5,6,\n", {"line 2", "quote is not closed"});
  fails(kHeader + "\"a\"b,1,2,3,4,5,6,\n", {"line 2", "after the quoted field"});
  fails(kHeader + std::string(2U << 20, '#'), {"too long"});
}

TEST(ControlPointsFile, MissingFile) {
  test::expectError<InputError>([] { readControlPairs("/nowhere/pairs.csv"); },
                                {"/nowhere/pairs.csv"});
}

}  // namespace
}  // namespace agricolmap::control_points
