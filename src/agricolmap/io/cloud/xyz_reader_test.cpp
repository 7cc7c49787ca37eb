#include <vector>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/io/text/path_file.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::TempDir;

Cloud read(const std::string& content) {
  const TempDir dir;
  return readCloud(dir.write("cloud.xyz", content));
}

void expectTwo(const std::string& content, bool colours = true) {
  SCOPED_TRACE(content);
  const Cloud cloud = read(content);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.filePoint(0), Eigen::Vector3d(1.5, 2.5, -3));
  EXPECT_EQ(cloud.filePoint(1), Eigen::Vector3d(2.5, 3.5, 4.25));
  ASSERT_EQ(cloud.hasColour(), colours);
  if (!colours) return;
  EXPECT_EQ(cloud.rgb[0], (Rgb{10, 20, 30}));
  EXPECT_EQ(cloud.rgb[1], (Rgb{40, 50, 255}));
}

void expectRefused(const std::string& content, std::initializer_list<const char*> parts) {
  SCOPED_TRACE(content);
  const TempDir dir;
  const auto path = dir.write("cloud.xyz", content);
  expectError<InputError>([&] { readCloud(path); }, parts);
}

TEST(XyzReader, AnySeparator) {
  expectTwo("1.5 2.5 -3 10 20 30\n2.5 3.5 4.25 40 50 255\n");
  expectTwo("1.5\t2.5\t-3\t10\t20\t30\r\n2.5\t3.5\t4.25\t40\t50\t255\r\n");
  expectTwo("1.5,2.5,-3,10,20,30\n2.5,3.5,4.25,40,50,255\n");
  expectTwo("1.5, 2.5, -3, 10, 20, 30\n2.5, 3.5, 4.25, 40, 50, 255\n");
  expectTwo("1.5;2.5;-3;10;20;30\r2.5;3.5;4.25;40;50;255\r");
  expectTwo("1,5;2,5;-3;10;20;30\n2,5;3,5;4,25;40;50;255\n");
  expectTwo(
      "\xEF\xBB\xBF"
      "1.5 2.5 -3\n\n 2.5 3.5 4.25 \n",
      false);
  expectTwo("1.5 2.5 -3 0.5\n2.5 3.5 4.25 0.7\n", false);
}

TEST(XyzReader, ColumnsByName) {
  expectTwo("//X Y Z R G B\n1.5 2.5 -3 10 20 30\n2.5 3.5 4.25 40 50 255\n");
  expectTwo("//X,Y,Z,R,G,B,Intensity\n2\n1.5,2.5,-3,10,20,30,7\n2.5,3.5,4.25,40,50,255,\n");
  expectTwo(
      "# made by hand\n\"Red\";\"Green\";\"Blue\";\"Easting [m]\";\"Northing [m]\";\"Z\"\n"
      "10;20;30;1,5;2,5;-3\n40;50;255;2,5;3,5;4,25\n");
  expectTwo("x y z nx ny nz\n1.5 2.5 -3 0 0 1\n2.5 3.5 4.25 0 1 0\n", false);
  EXPECT_EQ(read("x y z foo r g b\n1 2 3 7 10 20 30\n").fields, "x, y, z, foo, r, g, b");
}

TEST(XyzReader, PtsWithACount) {
  expectTwo("2\n1.5 2.5 -3 -1234 10 20 30\n2.5 3.5 4.25 12 40 50 255\n");
  expectTwo("2\n1.5 2.5 -3 12 10 20 30\n2.5 3.5 4.25 12 40 50 255\n");
  expectRefused("3\n1.5 2.5 -3 12 10 20 30\n2.5 3.5 4.25 12 40 50 255\n",
                {"truncated", "3 points"});
  expectRefused("2\n2\n0 0 0\n1 0 0\n", {"PTX"});
}

TEST(XyzReader, ColoursByPlace) {
  expectTwo("1.5 2.5 -3 10 20 30 -0.5\n2.5 3.5 4.25 40 50 255 0.5\n");
  expectTwo("1.5 2.5 -3 -0.5 10 20 30\n2.5 3.5 4.25 0.5 40 50 255\n");
  const Cloud shares = read("1 2 3 0.5 0.25 1\n1 2 3 0.5 0.1 0.1\n");
  EXPECT_EQ(shares.rgb[0], (Rgb{128, 64, 255}));
}

TEST(XyzReader, RefusesWhatMayBeReadInTwoWays) {
  expectRefused("1 2 3 12 10 20 30\n2 3 4 12 40 50 60\n", {"7 columns", "x y z r g b"});
  expectRefused("1 2 3 0.6 0 0.8\n2 3 4 0 0.6 0.8\n", {"6 columns", "nx ny nz"});
  expectRefused("1 2 3 -0.6 0.5 0.8\n2 3 4 0 0.6 0.8\n", {"6 columns"});
  expectRefused("1,5 2,5 3,5 10 20 30\n", {"commas", "semicolons"});
  expectRefused("x y w\n1 2 3\n", {"x, y, w", "x, y and z"});
  expectRefused("x,x,y,z\n1,2,3,4\n", {"x, x, y, z"});
  expectRefused("lon lat z\n9.1 47.2 300\n", {"degrees"});
}

TEST(XyzReader, DamagedLinesAreNamed) {
  expectRefused("1 2 3 10 20 30\n2 3 4 40 50\n", {"point 2", "fewer values than the first"});
  expectRefused("1 2 3 10 20 30\n2 3 4 40 50 60 70\n", {"point 2", "more values than the first"});
  expectRefused("1 2 3\n2 three 4\n", {"point 2", "'three'"});
  expectRefused("1;2;3\n1;2\n", {"point 2", "fewer"});
}

TEST(Commas, AreDecimalMarksOrSeparatorsNeverBoth) {
  const TempDir dir;
  const auto offset = [&](const std::string& text) { return readOffset(dir.write("o.xyz", text)); };
  const Eigen::Vector3d expected(1.5, 2.5, 3.5);
  EXPECT_EQ(offset("1.5,2.5,3.5\n").translation(), expected);
  EXPECT_EQ(offset("1.5, 2.5, 3.5\n").translation(), expected);
  EXPECT_EQ(offset("1,5; 2,5; 3,5\n").translation(), expected);
  EXPECT_EQ(offset("1,2,3\n").translation(), Eigen::Vector3d(1, 2, 3));
  for (const std::string text :
       {"1,5 2,5 3,5\n", "1,5\t2,5\t3\n", "1,5, 2,5, 3,5\n", "1,5 2 3\n"}) {
    const auto path = dir.write("o.xyz", text);
    expectError<InputError>([&] { readOffset(path); }, {"o.xyz", "line 1", "decimal marks"});
  }
  const auto matrix = dir.write("m.txt", "1,0 0,0 0,0 2,5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expectError<InputError>([&] { readMatrix(matrix); }, {"m.txt", "line 1", "decimal marks"});
  EXPECT_EQ(readPath(dir.write("p.txt", "1,5\n3,7\n"))[1], Eigen::Vector3d(3, 7, 0));
  EXPECT_EQ(readPath(dir.write("p.txt", "1,5;2,5\n3,5;4,5\n"))[1], Eigen::Vector3d(3.5, 4.5, 0));
  const auto path = dir.write("p.txt", "1,5 2,5\n3,5 4,5\n");
  expectError<InputError>([&] { readPath(path); }, {"p.txt", "line 1", "decimal marks"});
}

}  // namespace
}  // namespace agricolmap::io
