// What bands are: colours, transparency, heights and their units.
#include <gtest/gtest.h>

#include <string>

#include "agricolmap/io/raster/raster_import.hpp"
#include "agricolmap/io/raster/raster_test_support.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::Sheet;
using test::surfaceModel;
using test::TempDir;
using test::writeSheet;

std::string textOf(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += warning + "\n";
  return text;
}

TEST(RasterBands, HeightsComeInMetresWhateverTheirUnit) {
  const TempDir dir;
  const auto height = [&](const Sheet& sheet) {
    const RasterHeights model = readHeights(writeSheet(dir / "d.tif", sheet));
    return std::pair(static_cast<double>(model.height(0, 0)), textOf(model.warnings));
  };
  Sheet model = surfaceModel();
  EXPECT_EQ(height(model).first, 300.0);
  EXPECT_EQ(height(model).second, "");
  for (const std::string unit : {"ft", "foot", "Feet"}) {
    model.unit = unit;
    EXPECT_NEAR(height(model).first, 300.0 * 0.3048, 1e-4) << unit;
    EXPECT_NE(height(model).second.find("units of 0.3048 m"), std::string::npos);
  }
  model.unit = "US survey foot";
  EXPECT_NEAR(height(model).first, 300.0 * 1200.0 / 3937.0, 1e-4);
  model.unit = "metre";
  EXPECT_EQ(height(model).first, 300.0);
  model.unit = "furlong";
  const auto unknown = writeSheet(dir / "u.tif", model);
  expectError<InputError>([&] { readHeights(unknown); }, {"u.tif", "'furlong'", "gdal_edit.py"});
  // By the vertical system: UTM with NAVD88 heights in feet.
  model.unit.clear();
  model.crs = "EPSG:32618+6360";
  EXPECT_NEAR(height(model).first, 300.0 * 1200.0 / 3937.0, 1e-4);
  // Nothing said beside feet in the plane.
  model.crs = "EPSG:2263";
  EXPECT_NEAR(height(model).first, 300.0 * 1200.0 / 3937.0, 1e-4);
  EXPECT_NE(height(model).second.find("does not say the unit of its heights"), std::string::npos);
}

TEST(RasterBands, TransparencyFollowsTheBandsOwnRange) {
  const TempDir dir;
  for (const double opaque : {1.0, 255.0, 65535.0}) {
    Sheet sheet;
    sheet.bands = 4;
    sheet.type = GDT_UInt16;
    sheet.alpha = true;
    sheet.value = [opaque](int band, int col, int) {
      return band < 3 ? 100.0 + band : col < 2 ? 0.0 : opaque;
    };
    const RasterImage image = readRaster(writeSheet(dir / "o.tif", sheet));
    EXPECT_EQ(image.transparent, 12U) << opaque;
    EXPECT_EQ(image.valid(0, 1), 0);
    EXPECT_EQ(image.valid(0, 2), 1);
  }
}

TEST(RasterBands, WhatTransparencyTakesAwayIsTold) {
  const TempDir dir;
  Sheet sheet;
  sheet.bands = 4;
  sheet.alpha = true;
  sheet.value = [](int band, int col, int) { return band < 3 ? 100.0 : col < 2 ? 0.0 : 255.0; };
  const Cloud cloud =
      importOrthoDsm(writeSheet(dir / "o.tif", sheet), writeSheet(dir / "d.tif", surfaceModel()));
  EXPECT_EQ(cloud.size(), 36U);
  EXPECT_NE(textOf(cloud.warnings).find("12 of its 48 pixels are transparent"), std::string::npos)
      << textOf(cloud.warnings);
}

TEST(RasterBands, AFourthBandOfDataTakesNothingAway) {
  const TempDir dir;
  Sheet sheet;
  sheet.bands = 4;
  sheet.alpha = true;
  // Near infrared, which GDAL calls transparency where nobody said what it is.
  sheet.value = [](int band, int col, int row) { return band < 3 ? 100.0 : 30.0 * col + row; };
  const RasterImage image = readRaster(writeSheet(dir / "o.tif", sheet));
  EXPECT_EQ(image.transparent, 0U);
  EXPECT_EQ(image.valid(0, 0), 1);
  EXPECT_NE(textOf(image.warnings).find("takes nothing away"), std::string::npos);
  // By its name.
  sheet.names = {"Red", "Green", "Blue", "NIR"};
  sheet.value = [](int band, int col, int) { return band < 3 ? 100.0 : col < 2 ? 0.0 : 255.0; };
  const RasterImage named = readRaster(writeSheet(dir / "n.tif", sheet));
  EXPECT_EQ(named.valid(0, 0), 1);
  EXPECT_EQ(textOf(named.warnings), "");
}

TEST(RasterBands, AreTakenByName) {
  const TempDir dir;
  Sheet sheet;
  sheet.bands = 5;
  sheet.value = [](int band, int, int) { return 10.0 * (band + 1); };
  sheet.names = {"Blue", "Green (560 nm)", "Red", "Red edge", "NIR"};
  EXPECT_EQ(readRaster(writeSheet(dir / "o.tif", sheet)).colour(0, 0), (Rgb{30, 20, 10}));
  RasterOptions options;
  options.bands = BandOrder::kRgb;
  EXPECT_EQ(readRaster(dir / "o.tif", options).colour(0, 0), (Rgb{10, 20, 30}));
  sheet.bands = 4;
  sheet.names = {"Green", "Red", "Red edge", "NIR"};
  const auto no_blue = writeSheet(dir / "g.tif", sheet);
  expectError<InputError>([&] { readRaster(no_blue); },
                          {"g.tif", "Green, Red, Red edge, NIR", "blue"});
  sheet.bands = 6;
  sheet.names.clear();
  sheet.undeclared = true;
  const auto unnamed = writeSheet(dir / "u.tif", sheet);
  expectError<InputError>([&] { readRaster(unnamed); }, {"u.tif", "which of its 6 bands"});
}

TEST(RasterBands, APictureIsNoSurfaceModel) {
  const TempDir dir;
  const auto refused = [&](const Sheet& sheet, std::initializer_list<const char*> parts) {
    const auto path = writeSheet(dir / "d.tif", sheet);
    expectError<InputError>([&] { readHeights(path); }, parts);
  };
  refused({}, {"d.tif", "3 bands", "picture"});
  Sheet hillshade;
  hillshade.bands = 1;
  hillshade.value = [](int, int col, int row) { return 30.0 * col + row; };
  refused(hillshade, {"d.tif", "hillshade", "0 to 215"});
  hillshade.type = GDT_Float32;
  refused(hillshade, {"hillshade"});
  // Level ground at whole metres is none.
  Sheet level = surfaceModel();
  level.value = [](int, int, int) { return 12.0; };
  EXPECT_EQ(readHeights(writeSheet(dir / "l.tif", level)).height(0, 0), 12.0F);
}

TEST(RasterBands, HolesDoNotReachIntoTheirNeighbours) {
  const TempDir dir;
  Sheet model = surfaceModel();
  model.cols = 16;
  model.rows = 12;
  model.place = {500000.0, 0.25, 0.0, 5000000.0, 0.0, -0.25};
  // Nearer to the field than what is not believed for its distance alone.
  model.value = [](int, int col, int row) { return col == 8 ? 210.0 : 300.0 + 0.001 * row; };
  const Cloud cloud =
      importOrthoDsm(writeSheet(dir / "o.tif", {}), writeSheet(dir / "d.tif", model));
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_NEAR(cloud.filePoint(i).z(), 300.0, 0.02);
  EXPECT_NE(textOf(cloud.warnings).find("12 heights were left out"), std::string::npos)
      << textOf(cloud.warnings);
}

TEST(RasterBands, AFileThatIsNoRasterIsNamed) {
  const TempDir dir;
  const auto pointer =
      dir.write("o.tif", "version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 12\n");
  expectError<InputError>([&] { readRaster(pointer); }, {"o.tif", "Git LFS", "git lfs pull"});
  const auto page = dir.write("p.tif", "<!DOCTYPE html><html></html>");
  expectError<InputError>([&] { readHeights(page); }, {"p.tif", "web page"});
}

}  // namespace
}  // namespace agricolmap::io
