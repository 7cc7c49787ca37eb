#include <cmath>
#include <cstring>
#include <limits>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::append;
using test::expectError;
using test::TempDir;

std::string header(const std::string& format, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + body + "end_header\n";
}

const std::string kXyzFloat = "property float x\nproperty float y\nproperty float z\n";
const std::string kXyzDouble = "property double x\nproperty double y\nproperty double z\n";
const std::string kRgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

Cloud read(const TempDir& dir, const std::string& content) {
  return readCloud(dir.write("cloud.ply", content));
}

void expectRefused(const std::string& content, std::initializer_list<const char*> parts) {
  const TempDir dir;
  expectError<InputError>([&] { read(dir, content); }, parts);
}

TEST(PlyReader, ReadsAsciiWithExtraPropertiesCommentsAndCrLf) {
  const TempDir dir;
  const Cloud cloud =
      read(dir,
           "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info x\r\n"
           "element vertex 2\r\nproperty float nx\r\nproperty float x\r\n"
           "property float y\r\nproperty float z\r\nproperty uchar red\r\n"
           "property uchar green\r\nproperty uchar blue\r\nproperty uchar alpha\r\n"
           "element face 1\r\nproperty list uchar int vertex_indices\r\n"
           "end_header\r\n"
           "0.5 1.5 -2 +3e0 255 128 0 255\r\n\r\n  0.5 2.5 4 5 1 2 3 4 \r\n3 0 1 0\r\n");
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.filePoint(0), Eigen::Vector3d(1.5, -2, 3));
  EXPECT_EQ(cloud.filePoint(1), Eigen::Vector3d(2.5, 4, 5));
  EXPECT_EQ(cloud.rgb[0], (Rgb{255, 128, 0}));
  EXPECT_EQ(cloud.rgb[1], (Rgb{1, 2, 3}));
}

TEST(PlyReader, ReadsBinaryOfBothByteOrdersAndAllCoordinateTypes) {
  const TempDir dir;
  for (const bool big : {false, true}) {
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    std::string content = header(format,
                                 "element vertex 2\nproperty double x\nproperty float y\n"
                                 "property short z\n" +
                                     kRgb);
    for (const int i : {0, 1}) {
      append(content, 10.25 + i, big);
      append(content, -0.5F * static_cast<float>(i), big);
      append(content, static_cast<std::int16_t>(-300 + i), big);
      content += std::string("\x01\x02", 2) + static_cast<char>(200 + i);
    }
    const Cloud cloud = read(dir, content);
    ASSERT_EQ(cloud.size(), 2U);
    EXPECT_EQ(cloud.filePoint(1), Eigen::Vector3d(11.25, -0.5, -299));
    EXPECT_EQ(cloud.rgb[1], (Rgb{1, 2, 201}));
  }
}

TEST(PlyReader, KeepsUtmCoordinatesToAMicrometre) {
  const TempDir dir;
  std::string content = header("binary_little_endian", "element vertex 2\n" + kXyzDouble);
  for (const double d : {0.123456789, 1.987654321}) {
    append(content, 500000.0 + d);
    append(content, 5000000.0 + d);
    append(content, 100.0 + d);
  }
  const Cloud cloud = read(dir, content);
  EXPECT_EQ(cloud.origin, Eigen::Vector3d(500000, 5000000, 100));
  EXPECT_NEAR(cloud.filePoint(0).y(), 5000000.123456789, 1e-8);  // float spacing at 0.12 m: 7e-9
  EXPECT_NEAR(cloud.filePoint(1).y(), 5000001.987654321, 1e-6);  // at 2 m: 1.2e-7
  EXPECT_TRUE(cloud.rgb.empty());
}

/// All warnings of a cloud in one text.
std::string warningsOf(const Cloud& cloud) {
  std::string text;
  for (const std::string& warning : cloud.warnings) text += warning + "\n";
  return text;
}

TEST(PlyReader, WarnsOfCoarseFloatsAndOutliers) {
  const TempDir dir;
  const auto file = [](float y) {
    std::string content = header("binary_little_endian", "element vertex 2\n" + kXyzFloat);
    for (const float v : {1.0F, y, 2.0F, 1.0F, y, 2.0F}) append(content, v);
    return content;
  };
  const std::string coarse = warningsOf(read(dir, file(5000000.0F)));
  EXPECT_NE(coarse.find("cloud.ply: "), std::string::npos) << coarse;
  EXPECT_NE(coarse.find("in steps of 50.0 cm"), std::string::npos) << coarse;
  EXPECT_NE(coarse.find("double"), std::string::npos) << coarse;
  EXPECT_EQ(warningsOf(read(dir, file(99000.0F))), "");
}

/// An ascii cloud with these lines.
std::string asciiFile(const std::vector<std::string>& lines) {
  std::string text =
      header("ascii", "element vertex " + std::to_string(lines.size()) + "\n" + kXyzDouble);
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Lines of a field in UTM coordinates.
std::vector<std::string> utmLines(int count) {
  std::vector<std::string> lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(std::to_string(500000.125 + 0.01 * i) + " " +
                    std::to_string(5000000.5 + 0.005 * i) + " 300.25");
  }
  return lines;
}

// Exporters write (0, 0, 0) for points that they do not have. Kept about it, floats in UTM come in
// steps of half a metre.
TEST(PlyReader, PlaceholdersAtZeroDoNotCoarsenTheCloud) {
  const TempDir dir;
  const Cloud clean = read(dir, asciiFile(utmLines(300)));
  ASSERT_EQ(clean.origin, Eigen::Vector3d(500000, 5000001, 300));
  for (const std::size_t bad : {1, 20, 400}) {
    for (const bool first : {true, false}) {
      std::vector<std::string> lines = utmLines(300);
      lines.insert(first ? lines.begin() : lines.end(), bad, "0 0 0");
      const Cloud cloud = read(dir, asciiFile(lines));
      EXPECT_EQ(cloud.dropped_points, bad);
      EXPECT_EQ(cloud.origin, clean.origin);
      EXPECT_EQ(cloud.xyz, clean.xyz);
      EXPECT_NE(warningsOf(cloud).find(std::to_string(bad) + " points were left out"),
                std::string::npos)
          << warningsOf(cloud);
    }
  }
  // Around zero they are points like others.
  EXPECT_EQ(read(dir, asciiFile({"0 0 0", "1 2 3", "2 3 4"})).size(), 3U);
  EXPECT_EQ(read(dir, asciiFile({"0 0 0"})).size(), 1U);
}

TEST(PlyReader, AStrayFirstPointIsNotTheOrigin) {
  const TempDir dir;
  std::vector<std::string> lines = utmLines(300);
  lines.insert(lines.begin(), "7 -3 1");
  const Cloud cloud = read(dir, asciiFile(lines));
  EXPECT_EQ(cloud.dropped_points, 1U);
  EXPECT_NEAR(cloud.origin.x(), 500001.6, 1.0);
  EXPECT_NEAR(cloud.filePoint(0).y(), 5000000.5, 1e-6);
  // One that is off by less than a field may be is kept, and the others lose nothing by it.
  lines[0] = "500000 5015000 300";
  const Cloud with = read(dir, asciiFile(lines));
  EXPECT_EQ(with.dropped_points, 0U);
  EXPECT_NEAR(with.origin.y(), 5000001.0, 1.0);
  EXPECT_NEAR(with.filePoint(300).y(), 5000000.5 + 0.005 * 299, 1e-6);
}

// The few points that can be used are found, in whichever part of the file they are.
TEST(PlyReader, MostPointsMayBeUnusable) {
  const TempDir dir;
  constexpr std::size_t kPoints = 3'000'000;
  for (const std::size_t at : {std::size_t{40'000}, kPoints - 20}) {
    std::string content = header("binary_little_endian",
                                 "element vertex " + std::to_string(kPoints) + "\n" + kXyzFloat);
    const std::size_t body = content.size();
    content.append(kPoints * 12, '\xFF');  // NaN
    const float zero[3] = {};
    std::memcpy(content.data() + body, zero, 12);
    for (std::size_t i = at; i < at + 10; ++i) {
      const float point[3] = {400000.0F, 30000.0F + static_cast<float>(i - at), 300.0F};
      std::memcpy(content.data() + body + 12 * i, point, 12);
    }
    const Cloud cloud = read(dir, content);
    EXPECT_EQ(cloud.size(), 10U);
    EXPECT_EQ(cloud.dropped_points, kPoints - 10);
    EXPECT_EQ(cloud.origin, Eigen::Vector3d(400000, 30000, 300));
  }
}

TEST(PlyReader, RefusesCloudsLargerThanAField) {
  const TempDir dir;
  // Millimetres.
  std::vector<std::string> lines;
  for (int i = 0; i < 100; ++i) lines.push_back(std::to_string(5000 * i) + " 5 0");
  expectError<InputError>([&] { read(dir, asciiFile(lines)); }, {"cloud.ply", "20 km", "metres"});
}

TEST(PlyReader, WarnsOfWhatItIgnores) {
  const TempDir dir;
  const std::string rest = header("ascii", "element vertex 1\n" + kXyzFloat) + "0 1 2\n3 4 5\n";
  EXPECT_NE(warningsOf(read(dir, rest)).find("1 lines after the last point"), std::string::npos);
  std::string binary = header("binary_little_endian", "element vertex 1\n" + kXyzFloat);
  EXPECT_NE(warningsOf(read(dir, binary + std::string(15, '\0'))).find("3 bytes after"),
            std::string::npos);
  const std::string part =
      header("ascii", "element vertex 1\n" + kXyzFloat + "property uchar red\n") + "0 1 2 3\n";
  EXPECT_NE(warningsOf(read(dir, part)).find("colours are incomplete"), std::string::npos);
}

TEST(PlyReader, ScalesWideColoursByTheFilesRange) {
  const TempDir dir;
  const auto file = [](const std::string& type, const std::string& first) {
    return header("ascii", "element vertex 2\n" + kXyzFloat + "property " + type + " r\nproperty " +
                               type + " g\nproperty " + type + " b\n") +
           "0 0 0 " + first + "\n1 1 1 0 0 0\n";
  };
  EXPECT_EQ(read(dir, file("ushort", "65535 32768 257")).rgb[0], (Rgb{255, 128, 1}));
  EXPECT_EQ(read(dir, file("ushort", "255 128 1")).rgb[0], (Rgb{255, 128, 1}));
  EXPECT_EQ(read(dir, file("float", "1.0 0.5 0.25")).rgb[0], (Rgb{255, 128, 64}));
  EXPECT_EQ(read(dir, file("float", "255.0 128.0 64")).rgb[0], (Rgb{255, 128, 64}));
  expectError<InputError>([&] { read(dir, file("int", "-1 0 0")); }, {"colours go from -1"});
  expectError<InputError>([&] { read(dir, file("int", "70000 0 0")); }, {"70000"});
  expectError<InputError>([&] { read(dir, file("uchar", "256 0 0")); }, {"point 1", "256"});
  std::string binary =
      header("binary_big_endian", "element vertex 1\n" + kXyzFloat +
                                      "property ushort diffuse_red\nproperty ushort diffuse_green\n"
                                      "property ushort diffuse_blue\n");
  binary += std::string(12, '\0');
  for (const int c : {65535, 257, 0}) append(binary, static_cast<std::uint16_t>(c), true);
  EXPECT_EQ(read(dir, binary).rgb[0], (Rgb{255, 1, 0}));
}

TEST(PlyReader, SkipsListsAndElementsAroundTheVertices) {
  const TempDir dir;
  for (const bool big : {false, true}) {
    std::string content =
        header(big ? "binary_big_endian" : "binary_little_endian",
               "element camera 1\nproperty float a\nproperty int b\n"
               "element face 2\nproperty list uchar int vertex_indices\n"
               "element vertex 3\nproperty float x\nproperty list ushort double l\n"
               "property float y\nproperty float z\n" +
                   kRgb + "element edge 1\nproperty int a\n");
    append(content, 1.0F, big);
    append(content, 7, big);
    for (const int n : {3, 4}) {
      append(content, static_cast<std::uint8_t>(n));
      for (int k = 0; k < n; ++k) append(content, k, big);
    }
    for (const int i : {0, 1, 2}) {
      append(content, static_cast<float>(i), big);
      append(content, static_cast<std::uint16_t>(i), big);
      for (int k = 0; k < i; ++k) append(content, 1e300, big);
      append(content, 10.0F, big);
      append(content, 20.0F, big);
      content += "abc";
    }
    append(content, 5, big);
    const Cloud cloud = read(dir, content);
    ASSERT_EQ(cloud.size(), 3U);
    EXPECT_EQ(cloud.filePoint(2), Eigen::Vector3d(2, 10, 20));
    EXPECT_EQ(cloud.rgb[2], (Rgb{'a', 'b', 'c'}));
  }
  const Cloud ascii = read(dir, header("ascii",
                                       "element face 1\nproperty list uchar int v\n"
                                       "element vertex 1\nproperty list uchar int l\n" +
                                           kXyzFloat) +
                                    "3 0 1 2\n2 8 9 1 2 3\n");
  EXPECT_EQ(ascii.filePoint(0), Eigen::Vector3d(1, 2, 3));
}

TEST(PlyReader, DropsAndCountsPointsThatAreNotFinite) {
  const TempDir dir;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::string content = header("binary_little_endian", "element vertex 5\n" + kXyzFloat + kRgb);
  for (const float x : {nan, 1.0F, std::numeric_limits<float>::infinity(), 2.0F, 3e38F}) {
    for (const float value : {x, 5.0F, 6.0F}) append(content, value);
    content += std::string(3, static_cast<char>(x));
  }
  const Cloud cloud = read(dir, content);
  ASSERT_EQ(cloud.size(), 2U);
  ASSERT_EQ(cloud.rgb.size(), 2U);
  EXPECT_EQ(cloud.dropped_points, 3U);
  EXPECT_EQ(cloud.filePoint(1), Eigen::Vector3d(2, 5, 6));
  EXPECT_EQ(cloud.rgb[1].r, 2);
  expectRefused(header("ascii", "element vertex 2\n" + kXyzFloat) + "nan 0 0\n0 inf 0\n",
                {"none of its 2 points"});
  EXPECT_EQ(
      read(dir, header("ascii", "element vertex 2\n" + kXyzFloat) + "-nan 0 1e999\n0 1 1e-999\n")
          .dropped_points,
      1U);
}

TEST(PlyReader, CatchesLyingHeaders) {
  const std::string bin = "binary_little_endian";
  expectRefused(header(bin, "element vertex 3\n" + kXyzFloat) + std::string(30, '\0'),
                {"truncated", "3 points", "30 bytes", "(2 points)"});
  expectRefused(header(bin, "element vertex 9223372036854775807\n" + kXyzFloat), {"truncated"});
  expectRefused(header(bin, "element vertex 92233720368547758070\n" + kXyzFloat),
                {"line 3", "count"});
  expectRefused(header(bin, "element vertex -1\n" + kXyzFloat), {"line 3", "'-1'"});
  expectRefused(header(bin, "element vertex many\n" + kXyzFloat), {"line 3", "'many'"});
  expectRefused(header(bin, "element vertex 0\n" + kXyzFloat), {"empty cloud"});
  expectRefused(header(bin, "element vertex 1\nproperty half x\n"), {"line 4", "'half'"});
  expectRefused(header(bin, "element vertex 1\nproperty float x\nproperty float x\n"), {"twice"});
  expectRefused(header(bin, "element vertex 1\nelement vertex 1\n"), {"twice"});
  expectRefused(header(bin, "element vertex 1\nproperty float x\nproperty float y\n") + "12345678",
                {"lack", "x, y, z"});
  expectRefused(header(bin, "element face 1\nproperty float x\n") + "1234", {"vertex"});
  expectRefused(header(bin, "property float x\n"), {"before the first element"});
  expectRefused(header(bin, "element vertex 1\nproperty list float int l\n"), {"list"});
  expectRefused(header("binary", ""), {"'binary'"});
  expectRefused("ply\nformat ascii 2.0\nend_header\n", {"'2.0'"});
  expectRefused("ply\nformat ascii 1.0\nelement vertex 1\n" + kXyzFloat, {"end_header"});
  expectRefused("ply\nelement vertex 1\n", {"format"});
  expectRefused("ply\n", {"format"});
  expectRefused("", {"empty"});
  expectRefused("hello", {"not a point cloud"});
  expectRefused("LASF", {"truncated"});
  expectRefused("ply\rformat ascii 1.0\r", {"end_header"});
}

TEST(PlyReader, CatchesLyingData) {
  const std::string ascii = header("ascii", "element vertex 2\n" + kXyzFloat);
  expectRefused(ascii + "0 0 0\n", {"truncated", "2 points", "1 lines"});
  expectRefused(ascii, {"truncated"});
  expectRefused(ascii + "0 0 0\n0 0\n", {"point 2", "fewer"});
  expectRefused(ascii + "0 0 0\n0 0 0 0\n", {"point 2", "more"});
  expectRefused(ascii + "0 0 0\n0 x 0\n", {"point 2", "'x'"});
  const std::string bin = "binary_little_endian";
  const std::string listed = header(bin, "element vertex 1\nproperty list int int l\n" + kXyzFloat);
  std::string negative = listed;
  append(negative, -1);
  expectRefused(negative + std::string(12, '\0'), {"length -1"});
  std::string huge = listed;
  append(huge, 2000000000);
  expectRefused(huge + std::string(12, '\0'), {"truncated", "vertex"});
  expectRefused(
      header(bin,
             "element face 4000000000\nproperty list uchar int l\nelement vertex 1\n" + kXyzFloat) +
          "\x01",
      {"truncated", "face"});
  expectRefused(header("ascii",
                       "element face 4000000000\nproperty list uchar int l\n"
                       "element vertex 1\n" +
                           kXyzFloat) +
                    "1 2\n1 1 1\n",
                {"truncated"});
}

TEST(PlyReader, RefusesWhatIsNoFile) {
  const TempDir dir;
  expectError<InputError>([&] { readCloud(dir / "none.ply"); }, {"none.ply", "No such file"});
  expectError<InputError>([&] { readCloud(dir.path()); }, {"directory"});
  expectError<InputError>([&] { readCloud("/dev/null"); }, {"device"});
}

TEST(PlyReader, ToleratesTrailingBytesAndLeavesColoursOutOnRequest) {
  const TempDir dir;
  const std::string content =
      header("ascii", "element vertex 1\n" + kXyzFloat + kRgb) + "1 2 3 4 5 6\nmore\n";
  EXPECT_EQ(read(dir, content).size(), 1U);
  EXPECT_FALSE(readCloud(dir / "cloud.ply", {.colours = false}).hasColour());
  std::string binary = header("binary_little_endian", "element vertex 1\n" + kXyzFloat);
  EXPECT_EQ(read(dir, binary + std::string(17, '\0')).size(), 1U);
}

TEST(PlyReader, KeepsFileOrderOnAnyNumberOfThreads) {
  const TempDir dir;
  constexpr int kPoints = 100000;
  std::string ascii =
      header("ascii", "element vertex " + std::to_string(kPoints) + "\n" + kXyzFloat);
  std::string binary = header("binary_little_endian",
                              "element vertex " + std::to_string(kPoints) + "\n" + kXyzDouble);
  for (int i = 0; i < kPoints; ++i) {
    const bool bad = i % 1000 == 17;
    const std::string x = bad ? "nan" : std::to_string(0.015625 * i);
    ascii += x + " " + std::to_string(i % 7) + ".5 0\n";
    append(binary, bad ? std::nan("") : 0.015625 * i);
    append(binary, i % 7 + 0.5);
    append(binary, 0.0);
  }
  const auto a = dir.write("a.ply", ascii);
  const auto b = dir.write("b.ply", binary);
  const Cloud first = readCloud(a);
  EXPECT_EQ(first.size(), static_cast<std::size_t>(kPoints - 100));
  EXPECT_EQ(first.dropped_points, 100U);
  for (std::size_t i = 1; i < first.size(); ++i) {
    ASSERT_GT(first.xyz[i].x(), first.xyz[i - 1].x());
  }
  const ThreadLimit limit(1);
  EXPECT_EQ(readCloud(a).xyz, first.xyz);
  EXPECT_EQ(readCloud(b).xyz, first.xyz);
}

}  // namespace
}  // namespace agricolmap::io
