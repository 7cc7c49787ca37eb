#include "agricolmap/io/cloud/move_file.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/cloud/point_source.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::append;
using test::contentOf;
using test::TempDir;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Turned, stretched, tilted and shifted.
Eigen::Affine3d someAffine(const Eigen::Vector3d& shift) {
  return Eigen::Translation3d(shift) * Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.1, 0.0, 1.0)) *
         Eigen::Scaling(Eigen::Vector3d(1.1, 0.9, 1.0));
}

class MoveFile : public ::testing::Test {
 protected:
  static CloudMove moveBy(const Eigen::Vector3d& shift) {
    CloudMove move;
    move.target_from_file = someAffine(shift);
    return move;
  }
  CopiedCloud moved(const std::string& content, const CloudMove& move,
                    CloudFormat format = CloudFormat::kPly) {
    return moveFile(folder_.write("in", content), folder_ / "out", format, move);
  }
  std::string out() const { return contentOf(folder_ / "out"); }
  TempDir folder_;
};

/// x y z as T, an intensity and a label between and behind them, faces behind all.
template <typename T>
std::string plyOf(const std::string& type, const std::vector<Eigen::Vector3d>& points, bool big,
                  const std::string& faces) {
  std::string text = "ply\nformat binary_";
  text += big ? "big_endian" : "little_endian";
  text += " 1.0\ncomment made by hand\nelement vertex " + std::to_string(points.size()) + "\n";
  text += "property uchar red\nproperty " + type + " x\nproperty " + type +
          " y\nproperty float intensity\nproperty " + type +
          " z\nproperty ushort label\nproperty float nx\nproperty float ny\nproperty float nz\n";
  text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    append(text, static_cast<std::uint8_t>(i), big);
    append(text, static_cast<T>(points[i].x()), big);
    append(text, static_cast<T>(points[i].y()), big);
    append(text, 0.5F * static_cast<float>(i), big);
    append(text, static_cast<T>(points[i].z()), big);
    append(text, static_cast<std::uint16_t>(1000 + i), big);
    for (const float n : {0.0F, 0.0F, 2.0F}) append(text, n, big);
  }
  return text + faces;
}

std::vector<Eigen::Vector3d> somePoints(std::size_t count) {
  Random random(3);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), random.uniform());
  }
  return points;
}

TEST_F(MoveFile, PlyKeepsAllButCoordinatesAndNormals) {
  const std::string faces("\x03\x00\x00\x00\x00\x01\x00\x00\x00\x02\x00\x00\x00", 13);
  const std::vector<Eigen::Vector3d> points = somePoints(40000);
  const CloudMove move = moveBy({1.0, 2.0, 3.0});
  for (const bool big : {false, true}) {
    const std::string before = plyOf<double>("double", points, big, faces);
    const CopiedCloud copied = moved(before, move);
    EXPECT_EQ(copied.points, points.size());
    EXPECT_THAT(copied.warnings, IsEmpty());
    const std::string after = out();
    ASSERT_EQ(after.size(), before.size());
    std::vector<Eigen::Vector3d> expected = points;
    for (Eigen::Vector3d& point : expected) point = move.target_from_file(point);
    std::string wanted = plyOf<double>("double", expected, big, faces);
    const std::size_t body = wanted.find("end_header\n") + 11;
    const std::size_t length = 1 + 3 * 8 + 4 + 2 + 12;
    const Eigen::Vector3d up =
        someAffine(Eigen::Vector3d::Zero()).linear().inverse().transpose().col(2);
    std::string normal;
    const Eigen::Vector3f twice = (2.0 * up.normalized()).cast<float>();
    for (int c = 0; c < 3; ++c) append(normal, twice[c], big);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t record = body + i * length;
      wanted.replace(record + length - 12, 12, normal);
      // The last bits of coordinates hang on how the processor adds up.
      for (const std::size_t at : {1, 9, 21}) {
        const auto value = [&](const std::string& text) {
          const auto* const bytes = reinterpret_cast<const std::byte*>(&text[record + at]);
          return loadScalar(bytes, ScalarType::kFloat64, big);
        };
        ASSERT_NEAR(value(after), value(wanted), 1e-12);
        wanted.replace(record + at, 8, after, record + at, 8);
      }
    }
    EXPECT_TRUE(after == wanted);  // all else is as it was
  }
}

TEST_F(MoveFile, ThreadsDoNotMatter) {
  const std::string ply = plyOf<double>("double", somePoints(100000), false, std::string(1, '\0'));
  moved(ply, moveBy({1.0, 2.0, 3.0}));
  const std::string many = out();
  const ThreadLimit one(1);
  moved(ply, moveBy({1.0, 2.0, 3.0}));
  EXPECT_TRUE(out() == many);
}

TEST_F(MoveFile, FloatsStayWhereTheyAreFineEnough) {
  const std::vector<Eigen::Vector3d> points = somePoints(100);
  const std::string ply = plyOf<float>("float", points, false, std::string(1, '\0'));
  EXPECT_THAT(moved(ply, moveBy({1.0, 2.0, 3.0})).warnings, IsEmpty());
  EXPECT_THAT(out(), HasSubstr("property float x\n"));
  const CloudMove far = moveBy({500000.0, 5400000.0, 100.0});
  EXPECT_THAT(moved(ply, far).warnings, ElementsAre(HasSubstr("doubles")));
  EXPECT_THAT(out(), HasSubstr("property double x\nproperty double y\nproperty float intensity\n"
                               "property double z\nproperty ushort label\n"));
  const Cloud cloud = readCloud(folder_ / "out", {false, nullptr});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d wanted = far.target_from_file(points[i].cast<float>().cast<double>());
    EXPECT_LT((cloud.filePoint(i) - wanted).norm(), 1e-5);
  }
}

TEST_F(MoveFile, TextStaysText) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement note 1\nproperty int x\nelement vertex 2\n"
      "property float x\nproperty list uchar int seen\nproperty float y\nproperty float z\n"
      "property float quality\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n7\n1.5  2 8 9 2.5\t3.5 0.125\n4 0\n5 nan 1e-3\n3 0 1 0\n";
  CloudMove move;
  move.target_from_file = Eigen::Affine3d(Eigen::Translation3d(500000.0, 0.25, -1.0));
  const CopiedCloud copied = moved(ply, move);
  EXPECT_THAT(copied.warnings, ElementsAre(HasSubstr("'note'"), HasSubstr("doubles")));
  const std::string after = out();
  EXPECT_THAT(after, HasSubstr("element note 1\nproperty int x\nelement vertex 2\n"
                               "property double x\nproperty list uchar int seen\n"));
  EXPECT_EQ(
      after.substr(after.find("end_header\n")),
      "end_header\n7\n500001.500000  2 8 9 2.750000\t2.500000 0.125\n4.000000 0\n5.000000 nan "
      "1e-3\n3 0 1 0\n");
  test::expectError<InputError>([&] { moved(ply.substr(0, ply.size() - 22), move); },
                                {"truncated", "2 points"});
}

std::string pcdOf(const std::string& data, const std::string& body, const std::string& viewpoint) {
  return "# a comment\nVERSION 0.7\nFIELDS x y z rgb ring normal_x normal_y normal_z\n"
         "SIZE 4 4 4 4 2 4 4 4\nTYPE F F F U U F F F\nCOUNT 1 1 1 1 2 1 1 1\nWIDTH 2\nHEIGHT 1\n"
         "VIEWPOINT " +
         viewpoint + "\nPOINTS 2\nDATA " + data + "\n" + body;
}

TEST_F(MoveFile, PcdKeepsAllFields) {
  std::string binary;
  for (int i = 0; i < 2; ++i) {
    for (const float value : {1.0F, 2.0F, 3.0F}) append(binary, value + static_cast<float>(i));
    append(binary, 0x00102030U + static_cast<std::uint32_t>(i));
    for (const int ring : {5, 6}) append(binary, static_cast<std::uint16_t>(ring + i));
    for (const float value : {0.0F, 1.0F, 0.0F}) append(binary, value);
  }
  CloudMove move;
  move.target_from_file = Eigen::Affine3d(Eigen::Translation3d(400000.0, 10.0, 0.0) *
                                          Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitZ()));
  const CopiedCloud copied =
      moved(pcdOf("binary", binary, "1 0 0 1 0 0 0"), move, CloudFormat::kPcd);
  EXPECT_THAT(copied.warnings, ElementsAre(HasSubstr("doubles"), HasSubstr("VIEWPOINT")));
  std::string wanted =
      "# a comment\nVERSION 0.7\nFIELDS x y z rgb ring normal_x normal_y normal_z\n"
      "SIZE 8 8 8 4 2 4 4 4\nTYPE F F F U U F F F\nCOUNT 1 1 1 1 2 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n";
  EXPECT_THAT(out(), ::testing::StartsWith(wanted));
  const std::string body = out().substr(wanted.size());
  ASSERT_EQ(body.size(), 2U * (24 + 4 + 4 + 12));
  for (std::size_t i = 0; i < 2; ++i) {
    std::array<double, 3> xyz{};
    std::memcpy(xyz.data(), &body[i * 44], 24);
    EXPECT_NEAR(xyz[0], 400000.0 - 2.0 - static_cast<double>(i), 1e-9);
    EXPECT_NEAR(xyz[1], 11.0 + static_cast<double>(i), 1e-9);
    EXPECT_EQ(body.substr(i * 44 + 24, 8), binary.substr(i * 32 + 12, 8));
    std::array<float, 3> normal{};
    std::memcpy(normal.data(), &body[i * 44 + 32], 12);
    EXPECT_NEAR(normal[0], -1.0F, 1e-6F);
  }
  // Text, word by word.
  moved(pcdOf("ascii", "1 2 3 77 5 6 0 1 0\n2 3 4 78 6 7 0 1 0\n", "0 0 0 1 0 0 0"), move,
        CloudFormat::kPcd);
  EXPECT_THAT(out(), HasSubstr("DATA ascii\n399998.000000 11.000000 3.000000 77 5 6 -1.000000 "));
  test::expectError<InputError>(
      [&] { moved(pcdOf("binary", binary.substr(1), "0 0 0 1 0 0 0"), move, CloudFormat::kPcd); },
      {"truncated"});
}

TEST_F(MoveFile, WhatIsFarFromTheStripIsRefused) {
  const std::string ply = plyOf<double>("double", somePoints(10), false, std::string(1, '\0'));
  CloudMove move;
  move.origin = {500000.0, 5400000.0, 0.0};
  for (const CloudFormat format : {CloudFormat::kPly, CloudFormat::kPcd}) {
    test::expectError<InputError>([&] { moved(ply, move, format); },
                                  {"10 of its 10 points", "units"});
  }
}

TEST_F(MoveFile, OtherFormatsGetWhatReadingGives) {
  const std::string ply = plyOf<double>("double", somePoints(3000), false, std::string(1, '\0'));
  CloudMove move = moveBy({1.0, 2.0, 3.0});
  move.crs = {"somewhere", "PROJCS[\"somewhere\"]"};
  EXPECT_EQ(moved(ply, move, CloudFormat::kLas).points, 3000U);
  Cloud cloud = readCloud(folder_ / "in");
  cloud.crs = move.crs;
  writeCloud(folder_ / "wanted", cloud, CloudFormat::kLas, move.target_from_file);
  EXPECT_TRUE(out() == contentOf(folder_ / "wanted"));
}

TEST_F(MoveFile, WithoutCoordinatesThereIsNothingToMove) {
  test::expectError<InputError>(
      [&] {
        moved("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", {});
      },
      {"x, y, z"});
  test::expectError<InputError>([&] { moved("%PDF-1.4", {}); }, {"not a point cloud"});
}

TEST_F(MoveFile, FieldsAreFoundAsReadersFindThem) {
  const std::string head = "ply\nformat ascii 1.0\nelement Vertex 1\nproperty float X\n";
  const std::string rest = "property float Y\nproperty float Z\nend_header\n1 2 3\n";
  EXPECT_EQ(moved(head + rest, {}).points, 1U);
  test::expectError<InputError>([&] { moved(head + "property float X\n" + rest, {}); },
                                {"'x' is there twice"});
}

TEST_F(MoveFile, PointsThatTheProjectionDoesNotHaveAreSaid) {
  class Edge : public CoordinateMap {
    void apply(double* x, double* /*y*/, double* /*z*/, std::size_t count) const override {
      for (std::size_t i = 0; i < count; ++i) x[i] = x[i] > 8.0 ? HUGE_VAL : x[i];
    }
  };
  const Edge edge;
  CloudMove move;
  move.map = &edge;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n9 2 3\n2 nan 3\n";
  EXPECT_THAT(moved(ply, move).warnings, ElementsAre(HasSubstr("1 points have no place")));
  EXPECT_THAT(out(), HasSubstr("1.000000 2.000000 3.000000\nnan nan nan\n2.000000 nan 3.000000\n"));
}

TEST_F(MoveFile, NormalsTurnWithTheProjection) {
  // A map that turns by a right angle, in degrees as it were.
  class Turn : public CoordinateMap {
    void apply(double* x, double* y, double* /*z*/, std::size_t count) const override {
      for (std::size_t i = 0; i < count; ++i) {
        const double before = x[i];
        x[i] = -1e5 * y[i];
        y[i] = 1e5 * before;
      }
    }
  };
  const Turn turn;
  CloudMove move;
  move.map = &turn;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n"
      "0.01 0.02 3 1 0 0\n";
  moved(ply, move);
  EXPECT_THAT(out(), HasSubstr("-2000.000000 1000.000000 3.000000 0.000000 1.000000 0.000000\n"));
}

}  // namespace
}  // namespace agricolmap::io
