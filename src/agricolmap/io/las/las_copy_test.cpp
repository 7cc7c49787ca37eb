#include "agricolmap/io/las/las_copy.hpp"

#include <gmock/gmock.h>

#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/las/las_points.hpp"
#include "agricolmap/io/las/las_test_support.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {
namespace {

using test::LasBytes;
using test::TempDir;

/// A header and all records.
struct Contents {
  LasHeader header;
  std::string records;
};

Contents contentsOf(const std::filesystem::path& path) {
  const MappedFile file(path);
  Contents contents;
  contents.header = parseLasHeader(file.bytes(), path.string());
  const auto points = lasPoints(file.bytes(), contents.header, path.string());
  for (std::size_t chunk = 0; chunk < points->chunks(); ++chunk) {
    points->decode(chunk, LasWanted::kAll, [&](const std::byte* from, std::size_t count) {
      contents.records.append(reinterpret_cast<const char*>(from),
                              count * contents.header.layout.length);
    });
  }
  for (LasRecord& record : contents.header.records) record.data = {};  // the file is gone
  return contents;
}

LasBytes source(int format) {
  Random random(2);
  LasBytes file;
  file.format = format;
  file.minor = format < 6 ? 2 : 4;
  file.extra_bytes = 6;
  file.scale = 0.01;
  file.records.push_back(LasBytes::record("LASF_Spec", 4, std::string(192, 'e')));
  file.records.push_back(LasBytes::record("LASF_Projection", 34735, std::string(8, '\0')));
  file.records.push_back(LasBytes::record("copc", 1, std::string(160, '\0')));
  for (std::int32_t i = 0; i < 1000; ++i) {
    file.add(100 * i, 7 * i, 3, {}, i % 5 == 0);
    std::string& point = file.points.back();
    for (std::size_t at = 12; at < point.size(); ++at) {
      const bool time = file.layout().gps_time && at >= *file.layout().gps_time &&
                        at < *file.layout().gps_time + 8;
      if (at != 15 && !time) point[at] = static_cast<char>(random.below(256));
    }
  }
  return file;
}

class LasCopying : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
#ifndef AGRICOLMAP_HAS_LASZIP
    if (GetParam()) GTEST_SKIP() << "built without LASzip";
#endif
  }
  static CloudFormat target() { return GetParam() ? CloudFormat::kLaz : CloudFormat::kLas; }
  TempDir folder_;
};

TEST_P(LasCopying, KeepsAllAsItIs) {
  for (const int format : {1, 3, 7, 8}) {
    const LasBytes file = source(format);
    const auto path = folder_.write("in.las", file.bytes());
    const CopiedCloud copied = copyLas(path, folder_ / "out", target());
    EXPECT_EQ(copied.points, 1000U);
    EXPECT_THAT(copied.warnings, ::testing::IsEmpty());
    const Contents in = contentsOf(path);
    const Contents out = contentsOf(folder_ / "out");
    EXPECT_TRUE(in.records == out.records);
    EXPECT_EQ(in.header.scale, out.header.scale);
    EXPECT_EQ(in.header.offset, out.header.offset);
    EXPECT_NE(out.header.find("LASF_Spec", 4), nullptr);
    EXPECT_NE(out.header.find("LASF_Projection", 34735), nullptr);
    EXPECT_EQ(out.header.find("copc", 1), nullptr);
  }
}

TEST_P(LasCopying, MovesCoordinatesAndNothingElse) {
  const LasBytes file = source(3);
  const auto path = folder_.write("in.las", file.bytes());
  CloudMove move;
  move.target_from_file = Eigen::Affine3d(Eigen::Translation3d(100000.005, -4e6, 12.0) *
                                          Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                          Eigen::Scaling(Eigen::Vector3d(1.1, 0.9, 1.0)));
  const Cloud before = readCloud(path);
  move.origin = before.origin;
  move.crs = {"somewhere", "PROJCS[\"somewhere\"]"};
  const CopiedCloud copied = copyLas(path, folder_ / "out", target(), move);
  EXPECT_EQ(copied.points, 1000U);
  EXPECT_EQ(copied.left_out, 0U);

  const Contents in = contentsOf(path);
  const Contents out = contentsOf(folder_ / "out");
  ASSERT_EQ(out.header.points, 1000U);
  const std::size_t length = in.header.layout.length;
  for (std::size_t i = 0; i < 1000; ++i) {
    const std::string a = in.records.substr(i * length, length);
    const std::string b = out.records.substr(i * length, length);
    ASSERT_EQ(a.substr(12), b.substr(12));
    const Eigen::Vector3d from = in.header.pointOf(reinterpret_cast<const std::byte*>(a.data()));
    const Eigen::Vector3d to = out.header.pointOf(reinterpret_cast<const std::byte*>(b.data()));
    ASSERT_LT((to - move.target_from_file(from)).cwiseAbs().maxCoeff(), 0.00501);
  }
  EXPECT_EQ(out.header.scale.x(), 0.01);
  EXPECT_EQ(out.header.find("LASF_Projection", 34735), nullptr);
  EXPECT_NE(out.header.find("LASF_Projection", 2112), nullptr);
  EXPECT_EQ(readCloud(folder_ / "out").dropped_points, before.dropped_points);
}

TEST_P(LasCopying, WavePacketsThatStayBehindAreSaid) {
  LasBytes file;
  file.format = 4;
  file.add(1, 2, 3);
  const CopiedCloud copied =
      copyLas(folder_.write("in.las", file.bytes()), folder_ / "out", target());
  EXPECT_THAT(copied.warnings, ::testing::ElementsAre(::testing::HasSubstr("wave packets")));
}

TEST_P(LasCopying, NormalsThatAreNotTurnedAreSaid) {
  LasBytes file;
  file.extra_bytes = 12;
  std::string entry(192, '\0');
  entry.replace(4, 7, "NormalX");
  file.records.push_back(LasBytes::record("LASF_Spec", 4, entry));
  file.add(1, 2, 3);
  const auto path = folder_.write("in.las", file.bytes());
  EXPECT_THAT(copyLas(path, folder_ / "out", target()).warnings, ::testing::IsEmpty());
  CloudMove move;
  move.origin = Eigen::Vector3d(file.offset[0], file.offset[1], file.offset[2]);
  EXPECT_THAT(copyLas(path, folder_ / "out", target(), move).warnings,
              ::testing::ElementsAre(::testing::HasSubstr("normals")));
}

TEST_P(LasCopying, WildPointsAreLeftOutAndStepsAreMetric) {
  LasBytes file;
  file.scale = 1e-7;  // degrees
  file.add(0, 0, 0, {1, 2, 3});
  file.add(100, 0, 0, {4, 5, 6});
  file.add(101, 0, 0, {4, 5, 6});
  class Wild : public CoordinateMap {
    void apply(double* x, double* /*y*/, double* /*z*/, std::size_t count) const override {
      for (std::size_t i = 0; i < count; ++i) x[i] += i == 0 ? 0.0 : i == 1 ? HUGE_VAL : 3e4;
    }
  };
  const Wild wild;
  CloudMove move;
  move.map = &wild;
  move.origin = Eigen::Vector3d(file.offset[0], file.offset[1], file.offset[2]);
  const CopiedCloud copied =
      copyLas(folder_.write("in.las", file.bytes()), folder_ / "out", target(), move);
  EXPECT_EQ(copied.points, 1U);
  EXPECT_EQ(copied.left_out, 2U);
  EXPECT_EQ(contentsOf(folder_ / "out").header.scale.x(), 0.001);
}

INSTANTIATE_TEST_SUITE_P(LasAndLaz, LasCopying, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Laz" : "Las"; });

}  // namespace
}  // namespace agricolmap::io
