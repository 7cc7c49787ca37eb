#include "agricolmap/io/raster/map_files.hpp"

#include <gtest/gtest.h>

#include "agricolmap/io/raster/raster_test_support.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::Sheet;
using test::surfaceModel;
using test::TempDir;
using test::writeSheet;

TEST(MapFiles, AreTwoRastersWithACommaOrOneFile) {
  const TempDir dir;
  const std::string ortho = writeSheet(dir / "o.tif", {});
  const std::string dsm = writeSheet(dir / "d,1.tif", surfaceModel());
  const MapFiles both = mapFilesOf(ortho + "," + dsm);
  EXPECT_TRUE(both.raster);
  EXPECT_EQ(both.main, ortho);
  EXPECT_EQ(both.model, dsm);
  EXPECT_TRUE(mapFilesOf(ortho).raster);
  EXPECT_EQ(mapFilesOf(ortho).model, std::nullopt);
  EXPECT_FALSE(mapFilesOf(dir.write("a,b.xyz", "1 2 3\n")).raster);
  EXPECT_FALSE(mapFilesOf("nowhere.ply").raster);
  expectError<InputError>([&] { mapFilesOf(ortho + ",none.tif"); }, {"none.tif", "surface model"});
  expectError<InputError>([&] { mapFilesOf("none.tif," + dsm); }, {"none.tif", "orthomosaic"});
}

TEST(MapFiles, RastersAreCloudsInTheirOwnSystem) {
  const TempDir dir;
  const std::string ortho = writeSheet(dir / "o.tif", {});
  const MapFiles both =
      mapFilesOf(ortho + "," + writeSheet(dir / "d.tif", surfaceModel()).string());
  EXPECT_EQ(crsOfMap(both).crs.value().name, "WGS 84 / UTM zone 32N");
  const Cloud cloud = readMap(both);
  ASSERT_EQ(cloud.size(), 48U);
  EXPECT_TRUE(cloud.warnings.empty());
  EXPECT_NEAR(cloud.filePoint(1).z(), 300.25, 1e-4);
  const Cloud flat = readMap(mapFilesOf(ortho));
  ASSERT_EQ(flat.size(), 48U);
  EXPECT_EQ(flat.filePoint(1), Eigen::Vector3d(500000.75, 4999999.75, 0.0));
  ASSERT_EQ(flat.warnings.size(), 1U);
  EXPECT_NE(flat.warnings[0].find("laid flat"), std::string::npos);
}

TEST(MapFiles, PassByAsTheyAreRead) {
  const TempDir dir;
  const std::string ortho = writeSheet(dir / "o.tif", {});
  const std::string dsm = writeSheet(dir / "d.tif", surfaceModel());
  const std::string lines = dir.write("lines.xyz", "1 2 3\n4 5 6\n7 8 9\n");
  for (const std::string& text : {ortho + "," + dsm, lines}) {
    const Cloud cloud = readMap(mapFilesOf(text));
    StreamOptions options;
    options.keep = 0;
    options.crs.name = "here";
    const auto stream = streamMap(mapFilesOf(text), options);
    EXPECT_EQ(stream->facts().name, cloud.name);
    EXPECT_EQ(stream->facts().origin, cloud.origin);
    EXPECT_EQ(stream->facts().crs.name, "here");
    std::vector<Eigen::Vector3f> points;
    stream->pass([&](const PointBatch& batch) {
      points.insert(points.end(), batch.xyz.begin(), batch.xyz.end());
    });
    EXPECT_TRUE(points == cloud.xyz);
  }
}

TEST(MapFiles, RastersAreBroughtToTheSystemOfTheOther) {
  const TempDir dir;
  Sheet feet;
  feet.epsg = 2263;  // New York, US survey feet
  feet.place = {980000.0, 2.0, 0.0, 200000.0, 0.0, -2.0};
  Sheet model = surfaceModel();
  model.epsg = 2263;
  model.place = feet.place;
  model.unit = "ft";
  const MapFiles files = mapFilesOf(writeSheet(dir / "o.tif", feet).string() + "," +
                                    writeSheet(dir / "d.tif", model).string());
  const FileCrs crs = crsOfMap(files);
  EXPECT_NEAR(crs.crs.value().horizontal_unit, 1200.0 / 3937.0, 1e-12);
  EXPECT_EQ(crs.crs.value().vertical_unit, 1.0);
  const CommonFrame frame = commonFrame(crs, crs);
  ASSERT_NE(frame.fixed, nullptr);
  const Cloud cloud = readMap(files, {true, frame.fixed.get()});
  EXPECT_NEAR(cloud.filePoint(1).x(), 980003.0 * 1200.0 / 3937.0, 1e-4);
  EXPECT_NEAR(cloud.filePoint(1).z(), 300.25 * 0.3048, 1e-4);
}

}  // namespace
}  // namespace agricolmap::io
