#include "agricolmap/io/crs/crs.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/las/las_test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::LasBytes;
using test::TempDir;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The record of GeoTIFF keys; all values stand in the directory itself.
std::string geoKeys(const std::vector<std::array<std::uint16_t, 2>>& keys) {
  std::string data;
  for (const std::size_t head : {std::size_t{1}, std::size_t{1}, std::size_t{0}, keys.size()}) {
    test::append(data, static_cast<std::uint16_t>(head));
  }
  for (const auto& [key, value] : keys) {
    for (const std::uint16_t part : {key, std::uint16_t{0}, std::uint16_t{1}, value}) {
      test::append(data, part);
    }
  }
  return LasBytes::record("LASF_Projection", 34735, data);
}
constexpr std::uint16_t kModel = 1024;
constexpr std::uint16_t kGeographic = 2048;
constexpr std::uint16_t kProjected = 3072;
constexpr std::uint16_t kVerticalUnit = 4099;

class CrsTest : public ::testing::Test {
 protected:
  std::string las(const std::string& record, Eigen::Vector3d at = {500000, 5400000, 100},
                  int minor = 2) {
    LasBytes file;
    file.minor = minor;
    file.offset = {at.x(), at.y(), at.z()};
    if (!record.empty()) file.records.push_back(record);
    file.add(0, 0, 0, {1, 2, 3});
    return folder_.write(std::to_string(++files_) + ".las", file.bytes());
  }
  static FileCrs known(const std::string& code) { return crsOf("/dev/null", code); }
  static Eigen::Vector3d through(const CoordinateMap* map, Eigen::Vector3d point) {
    if (map != nullptr) map->apply(&point.x(), &point.y(), &point.z(), 1);
    return point;
  }
  static void expectNear(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    EXPECT_LT((a - b).norm(), 1e-3) << a.transpose() << " and " << b.transpose();
  }
  TempDir folder_;
  int files_ = 0;
};

TEST_F(CrsTest, ComesFromGeoTiffKeys) {
  const FileCrs found = crsOf(las(geoKeys({{kModel, 1}, {kProjected, 32632}})));
  ASSERT_TRUE(found.crs);
  EXPECT_EQ(found.crs->name, "WGS 84 / UTM zone 32N");
  EXPECT_THAT(found.crs->wkt, HasSubstr("32632"));
  EXPECT_EQ(found.crs->horizontal_unit, 1.0);
  EXPECT_THAT(found.warnings, IsEmpty());
}

TEST_F(CrsTest, ComesFromWkt) {
  const std::string wkt = known("EPSG:25833").crs->wkt;
  const FileCrs found = crsOf(las(LasBytes::record("LASF_Projection", 2112, wkt + '\0')));
  ASSERT_TRUE(found.crs);
  EXPECT_EQ(found.crs->name, "ETRS89 / UTM zone 33N");
}

TEST_F(CrsTest, ComesFromAFileBeside) {
  folder_.write("a.ply", "ply\n");
  EXPECT_FALSE(crsOf(folder_ / "a.ply").crs);
  folder_.write("a_wkt.prj", known("EPSG:32633").crs->wkt);
  EXPECT_EQ(crsOf(folder_ / "a.ply").crs->name, "WGS 84 / UTM zone 33N");
  folder_.write("a.prj", known("EPSG:32632").crs->wkt + "\n");
  EXPECT_EQ(crsOf(folder_ / "a.ply").crs->name, "WGS 84 / UTM zone 32N");
  EXPECT_EQ(crsOf(folder_ / "a.ply", (folder_ / "a_wkt.prj").string()).crs->name,
            "WGS 84 / UTM zone 33N");
  folder_.write("a.prj", "somewhere");
  expectError<InputError>([&] { crsOf(folder_ / "a.ply"); }, {"a.prj", "no coordinate system"});
}

TEST_F(CrsTest, WhatIsNotUnderstoodIsSaid) {
  const FileCrs found = crsOf(las(LasBytes::record("LASF_Projection", 2112, "rubbish")));
  EXPECT_FALSE(found.crs);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("cannot be understood")));
  expectError<UsageError>([&] { known("EPSG:1"); }, {"EPSG:1", "EPSG:32632"});
}

TEST_F(CrsTest, MovingIsReprojectedToFixed) {
  const CommonFrame frame = commonFrame(known("EPSG:32632"), known("EPSG:32633"));
  EXPECT_EQ(frame.crs.name, "WGS 84 / UTM zone 32N");
  EXPECT_EQ(frame.fixed, nullptr);
  EXPECT_TRUE(frame.moving_reprojected);
  EXPECT_THAT(frame.warnings, Contains(HasSubstr("reprojected from")));
  // 11.9 degrees east, 50 north.
  expectNear(through(frame.moving.get(), {277850.81514, 5543236.47175, 7.0}),
             {707819.17468, 5542661.16699, 7.0});
}

TEST_F(CrsTest, TheSameSystemNeedsNothing) {
  const CommonFrame frame = commonFrame(known("EPSG:32632"), known("EPSG:32632"));
  EXPECT_EQ(frame.fixed, nullptr);
  EXPECT_EQ(frame.moving, nullptr);
  EXPECT_FALSE(frame.moving_reprojected);
  EXPECT_THAT(frame.warnings, IsEmpty());
}

TEST_F(CrsTest, WhereNobodySaysNothingIsDone) {
  const FileCrs none{"a.ply", std::nullopt, {}};
  const CommonFrame frame = commonFrame(none, none);
  EXPECT_TRUE(frame.crs.wkt.empty());
  EXPECT_EQ(frame.moving, nullptr);
  EXPECT_THAT(frame.warnings, IsEmpty());
}

TEST_F(CrsTest, AMissingOneIsTakenAsTheOthers) {
  const FileCrs none{"a.ply", std::nullopt, {}};
  const CommonFrame frame = commonFrame(known("EPSG:32632"), none);
  EXPECT_EQ(frame.crs.name, "WGS 84 / UTM zone 32N");
  EXPECT_EQ(frame.moving, nullptr);
  EXPECT_THAT(frame.warnings, Contains(HasSubstr("a.ply: it does not say")));
}

TEST_F(CrsTest, DegreesAreBroughtToTheOthersMetresOrRefused) {
  const CommonFrame frame = commonFrame(known("EPSG:4326"), known("EPSG:32632"));
  EXPECT_EQ(frame.crs.name, "WGS 84 / UTM zone 32N");
  EXPECT_EQ(frame.moving, nullptr);
  expectNear(through(frame.fixed.get(), {11.9, 50.0, 3.0}), {707819.17468, 5542661.16699, 3.0});
  expectError<InputError>([&] { commonFrame(known("EPSG:4326"), known("EPSG:4258")); },
                          {"degrees", "EPSG:326<zone>"});
}

TEST_F(CrsTest, FeetBecomeMetres) {
  constexpr double kUsFoot = 1200.0 / 3937.0;
  const CommonFrame frame = commonFrame(known("EPSG:2225"), known("EPSG:2225"));
  EXPECT_THAT(frame.crs.name, HasSubstr("in metres"));
  EXPECT_EQ(frame.crs.horizontal_unit, 1.0);
  expectNear(through(frame.fixed.get(), {6561666.6667, 1000.0, 10.0}),
             {6561666.6667 * kUsFoot, 1000.0 * kUsFoot, 10.0 * kUsFoot});
  EXPECT_FALSE(frame.moving_reprojected);
  EXPECT_THAT(frame.warnings, Contains(HasSubstr("brought to metres")));
  // The system in metres is where the one in feet is.
  const CommonFrame back = commonFrame({"metric", frame.crs, {}}, known("EPSG:2225"));
  EXPECT_FALSE(back.moving_reprojected);
  const CommonFrame utm = commonFrame(known("EPSG:32610"), {"metric", frame.crs, {}});
  const CommonFrame feet = commonFrame(known("EPSG:32610"), known("EPSG:2225"));
  const Eigen::Vector3d p(6561666.6667, 610000.0, 0.0);
  expectNear(through(utm.moving.get(), kUsFoot * p), through(feet.moving.get(), p));
}

TEST_F(CrsTest, HeightsHaveUnitsOfTheirOwn) {
  FileCrs metres = known("EPSG:32610");
  const FileCrs keys =
      crsOf(las(geoKeys({{kModel, 1}, {kProjected, 32610}, {kVerticalUnit, 9003}})));
  EXPECT_NEAR(keys.crs->vertical_unit, 0.3048006, 1e-7);
  EXPECT_EQ(keys.crs->horizontal_unit, 1.0);
  const CommonFrame frame = commonFrame(metres, keys);
  EXPECT_FALSE(frame.moving_reprojected);
  EXPECT_NEAR(through(frame.moving.get(), {1.0, 2.0, 1000.0}).z(), 304.8006, 1e-4);
  EXPECT_EQ(through(frame.moving.get(), {1.0, 2.0, 1000.0}).x(), 1.0);

  // A compound system: feet above NAVD88.
  const FileCrs compound = known("EPSG:32610+6360");
  EXPECT_NEAR(compound.crs->vertical_unit, 0.3048006, 1e-7);
  EXPECT_THAT(commonFrame(compound, compound).crs.wkt, HasSubstr("VERT_CS"));
  EXPECT_NEAR(
      commonFrame({"metric", commonFrame(compound, compound).crs, {}}, compound).crs.vertical_unit,
      1.0, 1e-12);
}

TEST_F(CrsTest, HeightsWithoutUnitAreSaid) {
  const FileCrs feet = crsOf(las(geoKeys({{kModel, 1}, {kProjected, 2225}})));
  EXPECT_NEAR(feet.crs->vertical_unit, 0.3048006, 1e-7);
  EXPECT_THAT(feet.warnings, Contains(HasSubstr("unit of its heights")));
}

TEST_F(CrsTest, ReadingGoesThroughTheMap) {
  const std::string path =
      las(geoKeys({{kModel, 2}, {kGeographic, 4326}}), Eigen::Vector3d(11.9, 50.0, 3.0));
  const CommonFrame frame = commonFrame(known("EPSG:32632"), crsOf(path));
  const Cloud cloud = readCloud(path, {true, frame.moving.get()});
  expectNear(cloud.filePoint(0), {707819.17468, 5542661.16699, 3.0});
}

TEST_F(CrsTest, PointsWithoutAnImageAreLeftOut) {
  const CommonFrame frame = commonFrame(known("EPSG:32632"), known("EPSG:4326"));
  EXPECT_FALSE(through(frame.moving.get(), {500.0, 400.0, 0.0}).allFinite());
}

TEST_F(CrsTest, LengthsThatAreNoneOnTheGroundAreRefused) {
  const Crs mercator = *known("EPSG:3857").crs;
  expectError<InputError>(
      [&] {
        checkGroundScale("a.las", mercator, {1324701.9380, 6446275.8410});
      },
      {"a.las", "0.64", "EPSG:326<zone>"});
  checkGroundScale("a.las", *known("EPSG:32632").crs, {707870.0, 5542763.0});
  checkGroundScale("a.las", *known("EPSG:2225").crs, {6561666.0, 610000.0});
  checkGroundScale("a.las", {}, {0.0, 0.0});
  // Where all map projections of the equator keep lengths, this one does.
  checkGroundScale("a.las", mercator, {1324701.9380, 1000.0});
}

TEST_F(CrsTest, CloudsAreBroughtIntoOneThatIsNamed) {
  const FileCrs cloud = known("EPSG:32633");
  const CommonFrame frame = frameIn(cloud, "EPSG:32632");
  EXPECT_EQ(frame.crs.name, "WGS 84 / UTM zone 32N");
  expectNear(through(frame.moving.get(), {277850.81514, 5543236.47175, 7.0}),
             {707819.17468, 5542661.16699, 7.0});
  expectError<UsageError>([&] { frameIn(cloud, "EPSG:4326"); }, {"EPSG:4326", "projected"});
  expectError<InputError>(
      [&] {
        frameIn({"a.ply", std::nullopt, {}}, "EPSG:32632");
      },
      {"a.ply", "does not say"});
}

/// Files of PDAL's tests and what they say; skipped where they are absent.
TEST_F(CrsTest, FilesOfManyWriters) {
  const char* const shared = std::getenv("AGRICOLMAP_SHARED");
  const std::filesystem::path files =
      std::filesystem::path(shared == nullptr ? AGRICOLMAP_SHARED_DEFAULT : shared) /
      "data/las_pdal";
  if (!std::filesystem::exists(files)) GTEST_SKIP() << files << " is absent";
  struct Expected {
    const char* file;
    const char* name;
    double unit;
    double vertical_unit;
  };
  constexpr double kFoot = 1200.0 / 3937.0;
  for (const Expected& expected : {
           Expected{"1.0_0.las", "NAD83 / UTM zone 15N", 1.0, 1.0},
           Expected{"bad_vlr_count.las", "WGS 84 / UTM zone 17N", 1.0, 1.0},
           Expected{"autzen_clip_native.copc.laz", "NAD83 / Oregon LCC (m) + NAVD88 height (ftUS)",
                    1.0, kFoot},
           Expected{"epsg_4326.las", "WGS 84", 1.0, 1.0},
           Expected{"spurious.las", "WGS 84", 1.0, 1.0},
           Expected{"lots_of_vlr.las", "unnamed", kFoot, kFoot},
       }) {
    const FileCrs found = crsOf(files / expected.file);
    ASSERT_TRUE(found.crs) << expected.file;
    EXPECT_EQ(found.crs->name, expected.name);
    EXPECT_NEAR(found.crs->horizontal_unit, expected.unit, 1e-12) << expected.file;
    EXPECT_NEAR(found.crs->vertical_unit, expected.vertical_unit, 1e-12) << expected.file;
  }
  EXPECT_FALSE(crsOf(files / "simple.las").crs);
}

TEST_F(CrsTest, OpenDroneMapsFilesAreUnderstoodAndNamed) {
  const auto cloud = folder_.write("field.ply", "ply\n");
  const std::string proj =
      folder_.write("proj.txt", "+proj=utm +zone=32 +datum=WGS84 +units=m +no_defs");
  const FileCrs silent = crsOf(cloud);
  EXPECT_FALSE(silent.crs);
  ASSERT_EQ(silent.warnings.size(), 1U);
  EXPECT_NE(silent.warnings[0].find("proj.txt beside it is not asked"), std::string::npos);
  EXPECT_EQ(crsOf(cloud, proj).crs.value().horizontal_unit, 1.0);
  const std::string coords = folder_.write("coords.txt", "WGS84 UTM 33S\n500000 5400000\n1 2 3\n");
  EXPECT_EQ(crsOf(cloud, coords).crs.value().name, "WGS 84 / UTM zone 33S");
  EXPECT_EQ(crsOf(cloud, "WGS84 UTM 32N").crs.value().name, "WGS 84 / UTM zone 32N");
  EXPECT_THROW(crsOf(cloud, "WGS84 UTM 99N"), UsageError);
}

}  // namespace
}  // namespace agricolmap::io
