// Files of LAS, LAZ and COPC that real tools wrote, some of them broken on purpose (of the tests of
// PDAL): each is read, or refused for the reason that it has. Skipped where they are absent.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

std::filesystem::path folder() {
  const char* const shared = std::getenv("AGRICOLMAP_SHARED");
  return std::filesystem::path(shared == nullptr ? AGRICOLMAP_SHARED_DEFAULT : shared) /
         "data/las_pdal";
}

struct Expected {
  const char* name;
  std::size_t points;  ///< 0: refused
  bool colours;
  const char* says;  ///< part of a warning, or of the error; empty: no warning
};

constexpr Expected kFiles[] = {
    {"1.0_0.las", 1, false, ""},
    {"1.1_1.las", 1, false, ""},
    {"1.2-with-color.copc.laz", 1065, true, ""},
    {"1.2-with-color.las", 1065, true, ""},
    {"1.2_2.las", 1, true, ""},
    {"1.2_3.las", 1, true, ""},
    {"autzen_clip_native.copc.laz", 43, true, ""},
    {"bad-geotiff-keys.las", 10, false, ""},
    {"bad_vlr_count.las", 10, false, "announces 3 variable length records, only 2"},
    {"epsg_4326.las", 5380, false, "are degrees"},
    {"ept_node.laz", 1065, true, ""},
    {"extrabytes.las", 1065, true, ""},
    {"faceraster_numerical_imprecision.laz", 18074, false, "all its colours are black"},
    {"garbage_nVariableLength.las", 0, false, "announces 719 points of 20 bytes"},
    {"gps-time-nan.las", 1, false, ""},
    {"laszip-generated.laz", 1065, true, ""},
    {"liblas-generated.laz", 1065, true, ""},
    {"lots_of_vlr.las", 1, false, ""},
    {"no-points.las", 0, false, "0 points"},
    {"prec3.las", 110, true, ""},
    {"sample_c_thin.las", 2732, true, ""},
    {"simple.las", 1065, true, ""},
    {"simple.laz", 1065, true, ""},
    {"spec_3.las", 10, false, "all its colours are black"},
    {"spurious.las", 1065, true, "are degrees"},
    {"test1_4.las", 1000, false, ""},
    {"test_epsg_4047.las", 10, false, "all its colours are black"},
    {"utm15.las", 1, true, ""},
};

class LasFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << folder() << " is absent";
  }
  static Cloud read(const std::string& name) { return readCloud(folder() / name); }
  static bool readable(const std::string& name) {
#ifdef AGRICOLMAP_HAS_LASZIP
    return !name.empty();
#else
    return !name.ends_with(".laz");
#endif
  }
};

TEST_F(LasFiles, AreReadOrRefusedForTheirFault) {
  for (const Expected& file : kFiles) {
    SCOPED_TRACE(file.name);
    if (!readable(file.name)) {
      test::expectError<InputError>([&] { read(file.name); }, {file.name, "liblaszip-dev"});
      continue;
    }
    if (file.points == 0) {
      test::expectError<InputError>([&] { read(file.name); }, {file.name, file.says});
      continue;
    }
    const Cloud cloud = read(file.name);
    EXPECT_EQ(cloud.size(), file.points);
    EXPECT_EQ(cloud.dropped_points, 0U);
    EXPECT_EQ(cloud.hasColour(), file.colours);
    if (*file.says == 0) {
      EXPECT_THAT(cloud.warnings, ::testing::IsEmpty());
    } else {
      EXPECT_THAT(cloud.warnings, ::testing::Contains(::testing::HasSubstr(file.says)));
    }
  }
}

TEST_F(LasFiles, AreAllKnownHere) {
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(std::any_of(std::begin(kFiles), std::end(kFiles), [&](const Expected& file) {
      return file.name == name;
    })) << name;
  }
}

#ifdef AGRICOLMAP_HAS_LASZIP
using Row = std::array<double, 6>;

/// All points with their colours, in an order of their own.
std::vector<Row> sortedRows(const Cloud& cloud) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.filePoint(i);
    const auto hundredths = [](double value) { return std::round(100.0 * value); };
    rows.push_back({hundredths(p.x()), hundredths(p.y()), hundredths(p.z()),
                    static_cast<double>(cloud.rgb[i].r), static_cast<double>(cloud.rgb[i].g),
                    static_cast<double>(cloud.rgb[i].b)});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

TEST_F(LasFiles, CompressedOrNotHoldTheSamePoints) {
  const std::vector<Row> rows = sortedRows(read("simple.las"));
  for (const char* name : {"simple.laz", "laszip-generated.laz", "liblas-generated.laz",
                           "1.2-with-color.copc.laz", "ept_node.laz", "extrabytes.las"}) {
    EXPECT_EQ(sortedRows(read(name)), rows) << name;
  }
}
#endif

}  // namespace
}  // namespace agricolmap::io
