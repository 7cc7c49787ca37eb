// What is not needed does not stop reading, and no single value decides for all.
#include <cmath>
#include <cstdint>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::append;
using test::expectError;
using test::TempDir;

const std::string kAscii = "ply\nformat ascii 1.0\n";
const std::string kVertex =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kRgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
const std::string kEnd = "end_header\n";
const std::string kLines = "1 2 3 10 20 30\n2 3 4 40 50 60\n3 3 5 70 80 90\n";
const std::string kPcd =
    "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n";
const std::string kPcdLines = "1 2 3 660510\n2 3 4 2634300\n3 3 5 4608090\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

Cloud read(const std::string& content) {
  const TempDir dir;
  return readCloud(dir.write("cloud", content));
}

void expectThree(const std::string& content) {
  SCOPED_TRACE(content);
  const Cloud cloud = read(content);
  ASSERT_EQ(cloud.size(), 3U);
  EXPECT_EQ(cloud.filePoint(1), Eigen::Vector3d(2, 3, 4));
  EXPECT_EQ(cloud.filePoint(2), Eigen::Vector3d(3, 3, 5));
  ASSERT_TRUE(cloud.hasColour());
  EXPECT_EQ(cloud.rgb[0], (Rgb{10, 20, 30}));
  EXPECT_EQ(cloud.rgb[2], (Rgb{70, 80, 90}));
  EXPECT_TRUE(cloud.warnings.empty()) << cloud.warnings[0];
}

std::string warningsOf(const Cloud& cloud) {
  std::string text;
  for (const std::string& warning : cloud.warnings) text += warning + "\n";
  return text;
}

TEST(LenientReading, ByteOrderMarksAndLineEnds) {
  for (const std::string& file : {kAscii + kVertex + kRgb + kEnd + kLines, kPcd + kPcdLines}) {
    expectThree(file);
    expectThree("\xEF\xBB\xBF" + file);
    expectThree(replaced(file, "\n", "\r"));
    expectThree(replaced(file, "\n", "\r\n"));
    expectThree("\xEF\xBB\xBF" + replaced(file, "\n", "\r"));
  }
}

// The first data byte behind a header whose lines end in CR may look like the LF of CR LF.
TEST(LenientReading, BinaryBehindALineEndOfItsOwn) {
  for (const char first : {'\n', '\x01'}) {
    std::string file = replaced(
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar tag\nproperty "
        "float "
        "x\nproperty float y\nproperty float z\nend_header\n",
        "\n", "\r");
    file += first;
    for (const float value : {1.0F, 2.0F, 3.0F}) append(file, value);
    EXPECT_EQ(read(file).filePoint(0), Eigen::Vector3d(1, 2, 3));
  }
}

TEST(LenientReading, CapitalsInNames) {
  std::string vertex = replaced(replaced(kVertex, " x\n", " X\n"), "vertex", "Vertex");
  expectThree(kAscii + vertex + replaced(kRgb, "red", "Red") + kEnd + kLines);
  expectThree(replaced(kPcd, "x y z rgb", "X Y Z RGB") + kPcdLines);
  // Where both are there, the plain one counts; two plain ones are one too many.
  const std::string more = kAscii + kVertex + kRgb + "property float X\n" + kEnd;
  expectThree(more + replaced(kLines, "\n", " 9\n"));
  const TempDir dir;
  const auto twice =
      dir.write("c", replaced(more, "float X", "float x") + replaced(kLines, "\n", " 9\n"));
  expectError<InputError>([&] { readCloud(twice); }, {"'x' is there twice"});
}

TEST(LenientReading, TypesOfWhatIsNotRead) {
  const std::string rest =
      "element face 1\nproperty list uchar quint vertex_indices\nelement note 1\nproperty string "
      "text\n";
  expectThree(kAscii + kVertex + kRgb + rest + kEnd + kLines + "3 0 1 2\nhello\n");
  // 64-bit integers, before and after what is needed.
  for (const std::string type : {"int64", "uint64"}) {
    const std::string stamped = replaced(kVertex, "3\n", "3\nproperty " + type + " t\n");
    expectThree(kAscii + stamped + kRgb + kEnd + "7 " +
                replaced(kLines, "0\n", "0\n7 ").substr(0, kLines.size() + 4));
    std::string binary = "ply\nformat binary_little_endian 1.0\n" + stamped + kRgb + rest + kEnd;
    for (int i = 0; i < 3; ++i) {
      append(binary, std::uint64_t{7});
      const float xyz[3][3] = {{1, 2, 3}, {2, 3, 4}, {3, 3, 5}};
      for (const float value : xyz[i]) append(binary, value);
      binary += static_cast<char>(10 + 30 * i);
      binary += static_cast<char>(20 + 30 * i);
      binary += static_cast<char>(30 + 30 * i);
    }
    expectThree(binary + "whatever");
  }
  // Binary vertices need theirs.
  const TempDir dir;
  const auto unknown = dir.write("c",
                                 "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
                                 "property quint x\nend_header\n");
  expectError<InputError>([&] { readCloud(unknown); }, {"line 4", "unknown type 'quint'"});
}

TEST(LenientReading, ListsBeforeVertices) {
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  expectThree(kAscii + face + kVertex + kRgb + kEnd + "3 0 1 2\n" + kLines);
}

TEST(LenientReading, ValuesOverSeveralLines) {
  expectThree(kAscii + kVertex + kRgb + kEnd + replaced(kLines, "0 ", "0\n"));
  expectThree(kAscii + kVertex + kRgb + kEnd + replaced(kLines, "\n", " "));
  expectThree(kAscii + kVertex + kRgb + kEnd + "1\n2 3 10\n20 30 2 3 4 40 50 60 3 3 5 70 80\n90");
  expectThree(kPcd + replaced(kPcdLines, " ", "\n"));
  // More than one piece of the text.
  std::string words;
  constexpr int kMany = 60000;
  for (int i = 0; i < kMany; ++i) {
    words += std::to_string(i % 1000) + (i % 7 == 0 ? "\n" : " ") + "2.5 3.25" +
             (i % 3 == 0 ? "\n" : " ");
  }
  const Cloud cloud = read(
      replaced(kAscii + kVertex + kEnd, "vertex 3", "vertex " + std::to_string(kMany)) + words);
  ASSERT_EQ(cloud.size(), static_cast<std::size_t>(kMany));
  for (int i = 0; i < kMany; ++i) {
    ASSERT_EQ(cloud.filePoint(static_cast<std::size_t>(i)), Eigen::Vector3d(i % 1000, 2.5, 3.25));
  }
  // A value that is missing is not made up for by the next line.
  const TempDir dir;
  const auto shorter = dir.write(
      "c", kAscii + kVertex + kRgb + kEnd + "1 2 3 10 20\n" + kLines.substr(kLines.find('\n') + 1));
  expectError<InputError>([&] { readCloud(shorter); }, {"point 1", "fewer"});
}

TEST(LenientReading, PcdOfTheFirstVersions) {
  for (const std::string version : {".6", "0.6", ".5", "0.5"}) {
    expectThree(replaced(kPcd, "VERSION .7", "VERSION " + version) + kPcdLines);
  }
  expectThree(replaced(replaced(kPcd, "VERSION .7\n", ""), "FIELDS", "COLUMNS") + kPcdLines);
  const Cloud cloud = read("COLUMNS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n2 3 4\n");
  EXPECT_EQ(cloud.filePoint(1), Eigen::Vector3d(2, 3, 4));
  const TempDir dir;
  const auto newer = dir.write("c", replaced(kPcd, ".7", ".8") + kPcdLines);
  expectError<InputError>([&] { readCloud(newer); }, {"unknown PCD version '.8'"});
}

TEST(LenientReading, WhatWindowsCallsNoNumber) {
  for (const std::string none :
       {"1.#QNAN", "-1.#IND", "1.#INF00", "nan(ind)", "-nan", "1.#QNAN0"}) {
    const Cloud cloud =
        read(kAscii + kVertex + kRgb + kEnd + replaced(kLines, "2 3 4 40", "2 " + none + " 4 40"));
    EXPECT_EQ(cloud.size(), 2U) << none;
    EXPECT_EQ(cloud.dropped_points, 1U) << none;
  }
}

TEST(LenientReading, ColoursThatAreNoneAtPointsThatAreNone) {
  const std::string nan = "nan nan nan nan nan nan\n";
  const Cloud ply =
      read(kAscii + kVertex + kRgb + kEnd + replaced(kLines, "2 3 4 40 50 60\n", nan));
  EXPECT_EQ(ply.size(), 2U);
  EXPECT_EQ(ply.rgb[1], (Rgb{70, 80, 90}));
  const Cloud pcd = read(kPcd + replaced(kPcdLines, "2 3 4 2634300", "nan nan nan nan"));
  EXPECT_EQ(pcd.size(), 2U);
  EXPECT_EQ(pcd.rgb[1], (Rgb{70, 80, 90}));
  // A packed colour that got lost at a point that is one cannot be guessed.
  const TempDir dir;
  const auto lost = dir.write("c", kPcd + replaced(kPcdLines, "2634300", "nan"));
  expectError<InputError>([&] { readCloud(lost); }, {"point 2", "write the cloud as binary"});
}

/// `count` points along a line, with these colours at the first.
std::string colouredPly(const std::string& type, const std::string& first,
                        const std::string& others, int count) {
  std::string file = kAscii + replaced(kVertex, "3\n", std::to_string(count) + "\n") +
                     replaced(kRgb, "uchar", type) + kEnd;
  for (int i = 0; i < count; ++i) {
    file += std::to_string(0.01 * i) + " 2 3 " + (i == 0 ? first : others) + "\n";
  }
  return file;
}

TEST(LenientReading, ColoursJustBeyondTheirRangeAreAtItsEnd) {
  const Cloud cloud = read(colouredPly("float", "-1e-6 0.5 1.0000001", "0.2 0.4 0.6", 3));
  ASSERT_EQ(cloud.size(), 3U);
  EXPECT_EQ(cloud.rgb[0], (Rgb{0, 128, 255}));
  EXPECT_EQ(cloud.rgb[1], (Rgb{51, 102, 153}));
}

TEST(LenientReading, NoSingleColourDecidesForAll) {
  struct Case {
    const char* type;
    const char* stray;
    const char* others;
    Rgb expected;
  };
  for (const Case& c : {Case{"float", "1.5 0.1 0.1", "0.2 0.4 0.6", {51, 102, 153}},
                        Case{"float", "-3 0.1 0.1", "0.2 0.4 0.6", {51, 102, 153}},
                        Case{"float", "1e30 5 5", "20 40 60", {20, 40, 60}},
                        Case{"ushort", "256 0 0", "20 40 60", {20, 40, 60}},
                        Case{"int", "-1 70000 0", "20 40 60", {20, 40, 60}}}) {
    const Cloud cloud = read(colouredPly(c.type, c.stray, c.others, 2000));
    EXPECT_EQ(cloud.size(), 1999U) << c.stray;
    EXPECT_EQ(cloud.dropped_points, 1U);
    EXPECT_EQ(cloud.rgb[5], c.expected) << c.stray;
    EXPECT_NE(warningsOf(cloud).find("1 points were left out: colours outside"), std::string::npos)
        << warningsOf(cloud);
  }
  // Where more are so, they are the file's range.
  EXPECT_EQ(read(colouredPly("ushort", "25700 0 0", "20 40 60", 100)).rgb[0], (Rgb{100, 0, 0}));
  // Black says nothing of the range: few points with colours are enough to tell it.
  EXPECT_EQ(read(colouredPly("ushort", "25700 0 0", "0 0 0", 3000)).rgb[0], (Rgb{100, 0, 0}));
}

TEST(LenientReading, HolesThatNobodyDeclaredAreLeftOut) {
  const auto cloud = [](const std::string& hole, int holes) {
    std::string file = kAscii + replaced(kVertex, "3\n", "1000\n") + kEnd;
    for (int i = 0; i < 1000; ++i) {
      file += std::to_string(0.01 * i) + " 2 " +
              (i % 10 < holes ? hole : std::to_string(300.0 + 0.001 * i)) + "\n";
    }
    return read(file);
  };
  for (const std::string hole : {"-9999", "0", "-32767"}) {
    const Cloud with = cloud(hole, 3);
    EXPECT_EQ(with.size(), 700U) << hole;
    EXPECT_NE(warningsOf(with).find("300 points were left out"), std::string::npos)
        << warningsOf(with);
  }
  // A pit is not one.
  EXPECT_EQ(cloud("275", 3).size(), 1000U);
}

TEST(LenientReading, AViewpointIsTold) {
  EXPECT_EQ(warningsOf(read(kPcd + kPcdLines)), "");
  const std::string warning =
      warningsOf(read(replaced(kPcd, "0 0 0 1 0 0 0", "5 6 7 0 0 0 1") + kPcdLines));
  EXPECT_NE(warning.find("VIEWPOINT is not applied"), std::string::npos) << warning;
  EXPECT_NE(warning.find(": 5 6 7 0 0 180"), std::string::npos) << warning;
  const TempDir dir;
  const auto odd = dir.write("c", replaced(kPcd, "0 0 0 1", "0 here 0 1") + kPcdLines);
  expectError<InputError>([&] { readCloud(odd); }, {"VIEWPOINT", "'here'"});
}

}  // namespace
}  // namespace agricolmap::io
