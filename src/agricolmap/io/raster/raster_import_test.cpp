#include "agricolmap/io/raster/raster_import.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>

#include "agricolmap/io/raster/raster_test_support.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::Sheet;
using test::TempDir;
using test::writeSheet;

/// A plane: height 300 + 0.5·(x − 500000) + 0.25·(y − 5000000), seen by the place of the raster.
Sheet planeModel() {
  Sheet sheet;
  sheet.bands = 1;
  sheet.type = GDT_Float32;
  return sheet;
}

void setPlane(Sheet& sheet) {
  const auto g = sheet.place;
  sheet.value = [g](int, int col, int row) {
    const double x = g[0] + g[1] * (col + 0.5) + g[2] * (row + 0.5) - 500000.0;
    const double y = g[3] + g[4] * (col + 0.5) + g[5] * (row + 0.5) - 5000000.0;
    return 300.0 + 0.5 * x + 0.25 * y;
  };
}

void expectPlane(const Cloud& cloud, double tolerance) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.filePoint(i);
    EXPECT_NEAR(p.z(), 300.0 + 0.5 * (p.x() - 500000.0) + 0.25 * (p.y() - 5000000.0), tolerance);
  }
}

TEST(RasterImport, GivesOnePointPerPixelAtItsCentre) {
  const TempDir dir;
  Sheet model = planeModel();
  setPlane(model);
  const Cloud cloud =
      importOrthoDsm(writeSheet(dir / "o.tif", {}), writeSheet(dir / "d.tif", model));
  ASSERT_EQ(cloud.size(), 48U);
  EXPECT_EQ(cloud.dropped_points, 0U);
  EXPECT_EQ(cloud.filePoint(0).head<2>(), Eigen::Vector2d(500000.25, 4999999.75));
  EXPECT_EQ(cloud.filePoint(47).head<2>(), Eigen::Vector2d(500003.75, 4999997.25));
  EXPECT_EQ(cloud.rgb[9], (Rgb{12, 22, 32}));  // row 1, col 1
  expectPlane(cloud, 1e-4);
}

TEST(RasterImport, InterpolatesAModelOfOtherResolutionExtentAndRotation) {
  const TempDir dir;
  const auto ortho = writeSheet(dir / "o.tif", {});
  Sheet model = planeModel();
  model.cols = 40;
  model.rows = 40;
  // Turned by 30° with pixels of 0.3 m, reaching beyond the picture on all sides.
  const double c = 0.3 * std::cos(0.5236);
  const double s = 0.3 * std::sin(0.5236);
  model.place = {499995.0, c, s, 5000002.0, s, -c};
  setPlane(model);
  const Cloud turned = importOrthoDsm(ortho, writeSheet(dir / "d.tif", model));
  EXPECT_EQ(turned.size(), 48U);
  expectPlane(turned, 1e-3);
  // A model that covers the left half only.
  model = planeModel();
  model.place[0] -= 2.0;
  setPlane(model);
  const Cloud half = importOrthoDsm(ortho, writeSheet(dir / "h.tif", model));
  EXPECT_EQ(half.size(), 24U);
  EXPECT_EQ(half.dropped_points, 24U);
}

TEST(RasterImport, RespectsNodataAlphaBlackAndAbsurdHeights) {
  const TempDir dir;
  Sheet model = planeModel();
  model.value = [](int, int col, int row) {
    if (col == 7) return -32767.0;
    if (row == 5) return -9999.0;  // not declared
    return 300.0;
  };
  model.nodata = -32767.0;
  const auto dsm = writeSheet(dir / "d.tif", model);
  const Cloud heights = importOrthoDsm(writeSheet(dir / "o.tif", {}), dsm);
  EXPECT_EQ(heights.size(), 35U);
  EXPECT_EQ(heights.dropped_points, 13U);
  Sheet alpha;
  alpha.bands = 4;
  alpha.alpha = true;
  alpha.value = [](int band, int col, int) { return band < 3 ? 0.0 : col < 2 ? 255.0 : 20.0; };
  EXPECT_EQ(importOrthoDsm(writeSheet(dir / "a.tif", alpha), dsm).size(), 10U);
  Sheet black;
  black.value = [](int band, int col, int) {
    return col == 0 ? 0.0 : col == 1 ? 40.0 * band : 9.0;
  };
  const auto path = writeSheet(dir / "b.tif", black);
  EXPECT_EQ(importOrthoDsm(path, dsm).size(), 30U);
  ImportOptions keep_black;
  keep_black.raster.black_is_nodata = false;
  EXPECT_EQ(importOrthoDsm(path, dsm, keep_black).size(), 35U);
  black.nodata = 9.0;
  EXPECT_EQ(importOrthoDsm(writeSheet(dir / "n.tif", black), dsm).size(), 10U);
}

TEST(RasterImport, ThinsOut) {
  const TempDir dir;
  Sheet model = planeModel();
  setPlane(model);
  ImportOptions options;
  options.step = 3;
  const Cloud cloud =
      importOrthoDsm(writeSheet(dir / "o.tif", {}), writeSheet(dir / "d.tif", model), options);
  ASSERT_EQ(cloud.size(), 6U);
  EXPECT_EQ(cloud.filePoint(1).head<2>(), Eigen::Vector2d(500001.75, 4999999.75));
  expectPlane(cloud, 1e-4);
  options.step = 0;
  EXPECT_THROW(importOrthoDsm("a", "b", options), UsageError);
}

TEST(RasterImport, RefusesWhatHasNoMetres) {
  const TempDir dir;
  Sheet model = planeModel();
  setPlane(model);
  const auto dsm = writeSheet(dir / "d.tif", model);
  const auto refused = [&](const Sheet& sheet, std::initializer_list<const char*> parts) {
    const auto ortho = writeSheet(dir / "o.tif", sheet);
    expectError<InputError>([&] { importOrthoDsm(ortho, dsm); }, parts);
  };
  Sheet sheet;
  sheet.epsg = 4326;
  sheet.place = {9.0, 1e-6, 0.0, 45.0, 0.0, -1e-6};
  refused(sheet, {"o.tif", "degrees", "gdalwarp -t_srs"});
  sheet = {};
  sheet.epsg = 32633;
  refused(sheet, {"different coordinate systems", "32N", "33N"});
  sheet.epsg = 2263;  // New York, US survey feet
  refused(sheet, {"units of 0.3048"});
  sheet.epsg = 3857;  // Web Mercator
  refused(sheet, {"o.tif", "Pseudo-Mercator", "0.7", "on the ground"});
  sheet = {};
  sheet.epsg = 0;
  sheet.georeferenced = false;
  refused(sheet, {"not georeferenced"});
  sheet = {};
  sheet.place[0] += 100.0;
  refused(sheet, {"do the two show the same field"});
  sheet = {};
  sheet.bands = 1;
  refused(sheet, {"1 band(s)", "no colours"});
  sheet = {};
  sheet.value = [](int, int, int) { return 0.0; };
  refused(sheet, {"no pixel"});
  model.value = [](int, int, int) { return std::nan(""); };
  const auto empty = writeSheet(dir / "e.tif", model);
  const auto ortho = writeSheet(dir / "o.tif", {});
  expectError<InputError>([&] { importOrthoDsm(ortho, empty); }, {"e.tif", "height"});
  expectError<InputError>([&] { importOrthoDsm(dir / "none.tif", dsm); }, {"no such file"});
  dir.write("text.tif", "hello");
  expectError<InputError>([&] { importOrthoDsm(dir / "text.tif", dsm); }, {"text.tif", "raster"});
}

TEST(RasterImport, ToleratesAMissingCoordinateSystemAndSaysSo) {
  const TempDir dir;
  Sheet model = planeModel();
  setPlane(model);
  Sheet sheet;
  sheet.epsg = 0;
  const Cloud cloud =
      importOrthoDsm(writeSheet(dir / "o.tif", sheet), writeSheet(dir / "d.tif", model));
  EXPECT_EQ(cloud.size(), 48U);
  ASSERT_EQ(cloud.warnings.size(), 1U);
  EXPECT_NE(cloud.warnings[0].find("o.tif: coordinate system not given"), std::string::npos)
      << cloud.warnings[0];
}

TEST(RasterFile, OrdersBandsAndReadsWithoutGeoreference) {
  const TempDir dir;
  Sheet sheet;
  sheet.epsg = 0;
  sheet.georeferenced = false;
  const auto path = writeSheet(dir / "plain.tif", sheet);
  const RasterImage image = readRaster(path);
  EXPECT_FALSE(image.place.world_from_pixel.has_value());
  EXPECT_TRUE(image.place.crs.empty());
  EXPECT_EQ(image.colour(5, 7), (Rgb{22, 32, 42}));  // row 5 is the file's last
  RasterOptions options;
  options.bands = BandOrder::kGrb;
  EXPECT_EQ(readRaster(path, options).colour(0, 0), (Rgb{20, 10, 30}));
  options.bands = BandOrder::kGbr;
  EXPECT_EQ(readRaster(path, options).colour(0, 0), (Rgb{30, 10, 20}));
}

TEST(RasterFile, ScalesDeepValuesByOneFactor) {
  const TempDir dir;
  Sheet sheet;
  sheet.type = GDT_UInt16;
  sheet.value = [](int band, int col, int) { return col == 0 ? 0.0 : 1000.0 * (band + 1); };
  const RasterImage deep = readRaster(writeSheet(dir / "u.tif", sheet));
  EXPECT_EQ(deep.colour(0, 1), (Rgb{85, 170, 255}));
  EXPECT_EQ(deep.valid(0, 0), 0);
  sheet.value = [](int band, int, int) { return 100.0 + band; };
  EXPECT_EQ(readRaster(writeSheet(dir / "v.tif", sheet)).colour(0, 0), (Rgb{100, 101, 102}));
  sheet.type = GDT_Float32;
  sheet.value = [](int band, int col, int) {
    return col == 0 ? std::numeric_limits<double>::quiet_NaN() : 0.2 * (band + 1);
  };
  const RasterImage reflectance = readRaster(writeSheet(dir / "f.tif", sheet));
  EXPECT_EQ(reflectance.colour(0, 1), (Rgb{85, 170, 255}));
  EXPECT_EQ(reflectance.valid(0, 0), 0);
}

std::optional<std::filesystem::path> sharedData() {
  const char* const folder = std::getenv("AGRICOLMAP_SHARED");
  std::filesystem::path path = folder != nullptr ? folder : AGRICOLMAP_SHARED_DEFAULT;
  path /= "data";
  return std::filesystem::is_directory(path) ? std::optional(path) : std::nullopt;
}

TEST(RasterImport, ReadsARealSoybeanTrial) {
  const auto data = sharedData();
  if (!data) GTEST_SKIP() << "no shared data; set AGRICOLMAP_SHARED to their folder";
  const Cloud cloud =
      importOrthoDsm(*data / "soybean_pliman/soy_ortho.tif", *data / "soybean_pliman/soy_dsm.tif");
  EXPECT_GT(cloud.size(), 100000U);
  EXPECT_LT(cloud.dropped_points, cloud.size() / 20);
  const Box3 box = boundingBox(cloud);
  EXPECT_NEAR(box.extent().x(), 11.4F, 0.1F);
  EXPECT_NEAR(box.extent().y(), 5.57F, 0.1F);
  EXPECT_GT(cloud.origin.z() + static_cast<double>(box.min.z()), 303.0);
  EXPECT_LT(cloud.origin.z() + static_cast<double>(box.max.z()), 304.2);
}

TEST(RasterFile, ReadsARealPictureWithoutGeoreference) {
  const auto data = sharedData();
  if (!data) GTEST_SKIP() << "no shared data; set AGRICOLMAP_SHARED to their folder";
  RasterOptions options;
  options.bands = BandOrder::kGrb;
  const RasterImage image = readRaster(*data / "sugarbeet_weedmap_E/map_E.png", options);
  EXPECT_EQ(image.colour.cols(), 4320);
  EXPECT_EQ(image.colour.rows(), 4680);
  EXPECT_FALSE(image.place.world_from_pixel.has_value());
  const auto valid = std::count(image.valid.begin(), image.valid.end(), 1);
  EXPECT_NEAR(static_cast<double>(valid), 11.0e6, 0.1e6);
}

}  // namespace
}  // namespace agricolmap::io
