#include "agricolmap/io/text/path_file.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

class PathFile : public ::testing::Test {
 protected:
  std::vector<Eigen::Vector3d> read(const std::string& text) {
    return readPath(dir_.write("path.txt", text));
  }
  void expectRefused(const std::string& text, const char* why) {
    test::expectError<InputError>([&] { read(text); }, {"path.txt", why});
  }
  test::TempDir dir_;
};

TEST_F(PathFile, EveryKindOfLineGivesTheSamePlaces) {
  const std::vector<Eigen::Vector3d> expected = {{1.5, 2.0, 0.0}, {4.0, 2.5, 0.0}};
  EXPECT_EQ(read("1.5 2\n4 2.5\n"), expected);
  EXPECT_EQ(read("# robot\n1.5 2 0\n\n4 2.5 0 # end\n"), expected);
  EXPECT_EQ(read("100.1 1.5 2 0\r\n100.2 4 2.5 0\r\n"), expected);
  EXPECT_EQ(read("100.1 1.5 2 0 0 0 0 1\n100.2 4 2.5 0 0 0 0 1\n"), expected);
  EXPECT_EQ(read("time,Y,heading,X\n1,2,nan,1.5\n2,2.5,3,4\n"), expected);
}

TEST_F(PathFile, WhatIsWrittenIsReadBackToTheBit) {
  const std::vector<Eigen::Vector3d> places = {{352417.36, 0.1, -3.0}, {352418.0, 1.0 / 3.0, 2.0}};
  writePath(dir_ / "way.txt", places, "driven");
  EXPECT_EQ(readPath(dir_ / "way.txt"), places);
}

TEST_F(PathFile, WhatIsNoPathIsNamedWithLineAndRemedy) {
  expectRefused("# nothing\n", "this is no path");
  expectRefused("1 2 3\n1 2 3\n", "none of them");
  expectRefused("1 2\n3 nan\n", "line 2: 'nan' is not finite");
  expectRefused("1 2\n3 b\n", "line 2: 'b' is no number");
  expectRefused("1 2\n3 4 5\n", "line 2: 3 values where lines before have 2");
  expectRefused("1 2 3 4 5\n", "names the columns x and y");
  expectRefused("a b c\n1 2 3\n", "no line of names with x and y");
  expectRefused("", "empty");
  EXPECT_THROW(readPath(dir_ / "missing.txt"), InputError);
}

}  // namespace
}  // namespace agricolmap::io
