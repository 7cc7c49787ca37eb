// Files that are no clouds say what they are and what to do.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/path_file.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::TempDir;

struct Foreign {
  std::string content;
  const char* what;
  const char* remedy;
};

const std::vector<Foreign>& foreignFiles() {
  static const std::vector<Foreign> kFiles{
      {"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n", "Git LFS",
       "git lfs pull"},
      {std::string("\x1f\x8b\x08\0\0", 5), "gzip", "gunzip -k"},
      {"PK\x03\x04 doc.kml", "zip", "unpack"},
      {"# Blender\nmtllib a.mtl\nv 1 2 3 0.1 0.2 0.3\n", "OBJ", "PLY"},
      {"# vtk DataFile Version 3.0\nfield\nASCII\nPOINTS 2 float\n0 0 0\n1 2 3\n", "VTK", "PLY"},
      {"solid field\nfacet normal 0 0 1\n", "STL", "no colours"},
      {"#ROSBAG V2.0\n", "ROS bag", "PCD"},
      {"\x89MCAP0\r\n", "MCAP", "PCD"},
      {std::string("SQLite format 3\0", 16), "SQLite", "LAS"},
      {"ASTM-E57\1", "E57", "LAS"},
      {"\n<!DOCTYPE html>\n<html><head><title>404</title>", "web page", "download"},
      {"<?xml version='1.0'?><Error><Code>AccessDenied</Code></Error>", "server", "download"},
      {std::string("II*\0\x08", 5), "TIFF", "ORTHO.tif,DSM.tif"},
      {std::string("MM\0*", 4), "TIFF", "ORTHO.tif,DSM.tif"},
      {"\x89PNG\r\n\x1a\n", "PNG", "where it lies"},
      {std::string("\xFF\xFEp\0l\0y\0", 8), "UTF-16", "iconv"},
      {std::string(4096, '\0'), "zeros", "copy it again"},
  };
  return kFiles;
}

TEST(ForeignFiles, AreNamedWhereACloudIsWanted) {
  const TempDir dir;
  for (const Foreign& file : foreignFiles()) {
    const auto path = dir.write("cloud.ply", file.content);
    expectError<InputError>([&] { readCloud(path); }, {"cloud.ply", file.what, file.remedy});
  }
  const auto letter = dir.write("letter.txt", "Dear farmer,\n");
  expectError<InputError>([&] { readCloud(letter); }, {"LAS", "PLY", "x y z r g b"});
}

TEST(ForeignFiles, AreNamedWhereNumbersAreWanted) {
  const TempDir dir;
  const Foreign& lfs = foreignFiles().front();
  const auto path = dir.write("prior.txt", lfs.content);
  expectError<InputError>([&] { readMatrix(path); }, {"prior.txt", lfs.what, lfs.remedy});
  expectError<InputError>([&] { readPath(path); }, {"prior.txt", lfs.what, lfs.remedy});
}

TEST(ForeignFiles, AMatrixIsNoCloudOfFourPoints) {
  const TempDir dir;
  const std::string rows = "1 0 0 500000\n0 1 0 5400000\n0 0 1 3.5\n";
  for (const std::string& text :
       {"# p_fixed = M * p_moving\n" + rows + "0 0 0 1\n", rows + "0.0,0.0,0.0,1e0",
        std::string("[[1, 0, 0, 5],\n [0, 1, 0, 6],\n [0, 0, 1, 7],\n [0, 0, 0, 1]]\n"),
        std::string("1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1\n")}) {
    const auto path = dir.write("transform.txt", text);
    EXPECT_EQ(formatByContent(text), std::nullopt) << text;
    expectError<InputError>([&] { readCloud(path); }, {"transform.txt", "4x4 matrix", "name"});
    EXPECT_EQ(readMatrix(path)(2, 2), 1.0);
  }
}

TEST(ForeignFiles, FourPointsAreACloud) {
  const TempDir dir;
  const std::string three = "1 0 0 5\n0 1 0 6\n0 0 1 7\n";
  for (const std::string& text :
       {three + "0 0 0 2\n", three + "0 0 1 1\n", "x y z intensity\n" + three + "0 0 0 1\n",
        std::string("1 0 0\n0 1 0\n0 0 1\n0 0 0\n")}) {
    EXPECT_EQ(readCloud(dir.write("four.xyz", text)).size(), 4U) << text;
  }
  EXPECT_EQ(readCloud(dir.write("five.xyz", three + "0 0 0 1\n1 1 1 1\n")).size(), 5U);
}

TEST(ForeignFiles, GaussianSplatsAreTold) {
  const TempDir dir;
  const auto path = dir.write("splat.ply",
                              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                              "property float y\nproperty float z\nproperty float f_dc_0\n"
                              "property float opacity\nend_header\n1 2 3 0.5 0.1\n");
  const Cloud cloud = readCloud(path);
  ASSERT_EQ(cloud.warnings.size(), 1U);
  EXPECT_NE(cloud.warnings[0].find("Gaussian splats"), std::string::npos) << cloud.warnings[0];
}

}  // namespace
}  // namespace agricolmap::io
