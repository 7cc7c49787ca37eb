#include "agricolmap/simulate/ortho/ortho_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/io/raster/raster_test_support.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/simulate/field/noise.hpp"
#include "agricolmap/simulate/ortho/row_heading.hpp"

namespace agricolmap::simulate {
namespace {

using test::expectError;
using test::Sheet;
using test::TempDir;
using test::writeSheet;

/// 1.2 m × 0.9 m of 2 cm pixels, each coloured by its column and row.
Sheet mosaic() {
  Sheet sheet;
  sheet.cols = 60;
  sheet.rows = 45;
  sheet.place = {500000.0, 0.02, 0.0, 5000000.0, 0.0, -0.02};
  sheet.value = [](int band, int col, int row) {
    return band == 0 ? 100.0 + col : (band == 1 ? 100.0 + row : 50.0);
  };
  return sheet;
}

/// 300 + 0.5·east + 0.25·north of the mosaic's top left, seen by a raster of 10 cm.
Sheet model() {
  Sheet sheet;
  sheet.bands = 1;
  sheet.type = GDT_Float32;
  sheet.cols = 30;
  sheet.rows = 30;
  sheet.place = {499999.0, 0.1, 0.0, 5000001.0, 0.0, -0.1};
  sheet.value = [](int, int col, int row) {
    return 300.0 + 0.5 * (-1.0 + 0.1 * (col + 0.5)) + 0.25 * (1.0 - 0.1 * (row + 0.5));
  };
  return sheet;
}

TEST(ReadOrtho, TurnsTheFileUpsideDownAndKeepsItsPlace) {
  const TempDir dir;
  const OrthoField field = readOrtho({writeSheet(dir / "o.tif", mosaic()), {}, {}});
  EXPECT_DOUBLE_EQ(field.gsd, 0.02);
  ASSERT_TRUE(field.corner.has_value());
  EXPECT_NEAR(field.corner->x(), 500000.0, 1e-6);
  EXPECT_NEAR(field.corner->y(), 5000000.0 - 0.9, 1e-6);
  ASSERT_EQ(field.colour.rows(), 45);
  ASSERT_EQ(field.colour.cols(), 60);
  EXPECT_EQ(field.colour(0, 0), (Rgb{100, 144, 50}));
  EXPECT_EQ(field.colour(44, 59), (Rgb{159, 100, 50}));
  EXPECT_TRUE(field.height.empty());
  EXPECT_EQ(std::count(field.valid.begin(), field.valid.end(), 1), 45 * 60);
}

TEST(ReadOrtho, TakesAWindowInItsPlace) {
  const TempDir dir;
  const OrthoField field =
      readOrtho({writeSheet(dir / "o.tif", mosaic()), {}, {}}, {}, io::PixelWindow{10, 5, 20, 30});
  EXPECT_NEAR(field.corner->x(), 500000.2, 1e-6);
  EXPECT_NEAR(field.corner->y(), 5000000.0 - 0.7, 1e-6);
  ASSERT_EQ(field.colour.rows(), 30);
  ASSERT_EQ(field.colour.cols(), 20);
  EXPECT_EQ(field.colour(0, 0), (Rgb{110, 134, 50}));
  EXPECT_EQ(field.colour(29, 19), (Rgb{129, 105, 50}));
  expectError<InputError>(
      [&] {
        readOrtho({dir / "o.tif", {}, {}}, {}, io::PixelWindow{50, 5, 20, 30});
      },
      {"o.tif", "window", "60 x 45"});
}

TEST(ReadOrtho, InterpolatesHeightsOfAnotherRaster) {
  const TempDir dir;
  const OrthoField field =
      readOrtho({writeSheet(dir / "o.tif", mosaic()), writeSheet(dir / "d.tif", model()),
                 writeSheet(dir / "t.tif", model())});
  for (const auto& [row, col] : {std::pair{0, 0}, {22, 31}, {44, 59}}) {
    const double east = 0.02 * (col + 0.5);
    const double north = -0.9 + 0.02 * (row + 0.5);
    EXPECT_NEAR(field.height(row, col), 300.0 + 0.5 * east + 0.25 * north, 1e-4);
    EXPECT_EQ(field.ground(row, col), field.height(row, col));
  }
  EXPECT_EQ(std::count(field.valid.begin(), field.valid.end(), 0), 0);
}

TEST(ReadOrtho, HasNoDataWhereTheModelHasNone) {
  const TempDir dir;
  Sheet half = model();
  half.cols = 16;  // up to 0.6 m east
  const auto plane = half.value;
  half.value = [plane](int band, int col, int row) {
    return row == 12 ? -9999.0 : plane(band, col, row);  // not declared
  };
  const OrthoField field =
      readOrtho({writeSheet(dir / "o.tif", mosaic()), writeSheet(dir / "d.tif", half), {}});
  EXPECT_EQ(field.valid(20, 28), 1);
  EXPECT_EQ(field.valid(20, 32), 0);
  // North of the top by −0.25 m: in the line without data. South-first rows, so row 45 − 12.5.
  EXPECT_EQ(field.valid(32, 10), 0);
  for (const float height : field.height) {
    ASSERT_GT(height, 299.0F);
    ASSERT_LT(height, 301.0F);
  }
}

TEST(ReadOrtho, MakesPixelsSquare) {
  const TempDir dir;
  Sheet wide = mosaic();
  wide.place[1] = 0.04;
  const OrthoField field = readOrtho({writeSheet(dir / "o.tif", wide), {}, {}});
  EXPECT_DOUBLE_EQ(field.gsd, 0.02);
  EXPECT_EQ(field.colour.cols(), 120);
  EXPECT_EQ(field.colour(0, 60).r, 130);
}

TEST(ReadOrtho, NeedsAPixelSizeExactlyWhereThereIsNoGeoreference) {
  const TempDir dir;
  Sheet bare = mosaic();
  bare.georeferenced = false;
  bare.epsg = 0;
  const auto path = writeSheet(dir / "bare.tif", bare);
  expectError<InputError>([&] { readOrtho({path, {}, {}}); }, {"bare.tif", "size of its pixels"});
  OrthoFileOptions options;
  options.gsd = 0.015;
  const OrthoField field = readOrtho({path, {}, {}}, options);
  EXPECT_EQ(field.gsd, 0.015);
  EXPECT_FALSE(field.corner.has_value());
  EXPECT_EQ(field.colour(0, 0), (Rgb{100, 144, 50}));
  expectError<InputError>(
      [&] {
        readOrtho({path, writeSheet(dir / "d.tif", model()), {}}, options);
      },
      {"bare.tif", "georeference", "d.tif"});
  expectError<InputError>(
      [&] {
        readOrtho({writeSheet(dir / "o.tif", mosaic()), {}, {}}, options);
      },
      {"o.tif", "0.02", "0.015", "leave it out"});
}

TEST(ReadOrtho, RefusesWhatItCannotPlace) {
  const TempDir dir;
  const auto ortho = writeSheet(dir / "o.tif", mosaic());
  Sheet sheet = mosaic();
  sheet.place[2] = 0.001;
  expectError<InputError>(
      [&] {
        readOrtho({writeSheet(dir / "turned.tif", sheet), {}, {}});
      },
      {"turned.tif", "north up", "gdalwarp"});
  sheet = mosaic();
  sheet.place = {9.0, 1e-7, 0.0, 48.0, 0.0, -1e-7};
  sheet.epsg = 4326;
  expectError<InputError>(
      [&] {
        readOrtho({writeSheet(dir / "degrees.tif", sheet), {}, {}});
      },
      {"degrees.tif", "gdalwarp"});
  sheet = mosaic();
  sheet.place = {500000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0};
  expectError<InputError>(
      [&] {
        readOrtho({writeSheet(dir / "space.tif", sheet), {}, {}});
      },
      {"space.tif", "no plants"});
  sheet = model();
  sheet.place[0] += 1000.0;
  expectError<InputError>(
      [&] {
        readOrtho({ortho, writeSheet(dir / "beside.tif", sheet), {}});
      },
      {"o.tif", "beside.tif", "same field", "500999.0"});
  sheet = model();
  sheet.epsg = 32633;
  expectError<InputError>(
      [&] {
        readOrtho({ortho, writeSheet(dir / "zone.tif", sheet), {}});
      },
      {"zone.tif", "coordinate systems"});
  expectError<UsageError>(
      [&] {
        readOrtho({ortho, {}, dir / "t.tif"});
      },
      {"t.tif", "surface model"});
  expectError<InputError>([&] { readOrtho({dir / "none.tif", {}, {}}); }, {"none.tif"});
}

TEST(ChooseWindow, TakesAllOfASmallMosaicAndDataOfALargeOne) {
  const TempDir dir;
  Sheet sheet = mosaic();
  sheet.cols = 400;
  sheet.rows = 300;
  sheet.nodata = 0.0;
  // Data in the south-east quarter.
  sheet.value = [](int, int col, int row) { return col >= 200 && row >= 150 ? 90.0 : 0.0; };
  const auto path = writeSheet(dir / "o.tif", sheet);
  const io::PixelWindow all = chooseWindow(path, {}, 20.0, 20.0, 1);
  EXPECT_EQ(all.cols, 400);
  EXPECT_EQ(all.rows, 300);
  bool differs = false;
  const io::PixelWindow first = chooseWindow(path, {}, 2.0, 1.0, 1);
  for (std::uint64_t seed = 1; seed < 10; ++seed) {
    const io::PixelWindow window = chooseWindow(path, {}, 2.0, 1.0, seed);
    EXPECT_EQ(window.cols, 100);
    EXPECT_EQ(window.rows, 50);
    EXPECT_GE(window.col, 196);
    EXPECT_GE(window.row, 148);
    EXPECT_LE(window.col + window.cols, 400);
    EXPECT_LE(window.row + window.rows, 300);
    differs = differs || window.col != first.col;
  }
  EXPECT_TRUE(differs);
  // Where the plants are.
  sheet.value = [](int band, int col, int) { return col < 30 && band == 1 ? 140.0 : 90.0; };
  const auto green = writeSheet(dir / "g.tif", sheet);
  for (std::uint64_t seed = 1; seed < 10; ++seed) {
    EXPECT_EQ(chooseWindow(green, {}, 2.0, 1.0, seed).col, 0);
  }
  // Larger than the part with data: the fullest.
  const io::PixelWindow wide = chooseWindow(path, {}, 6.0, 4.0, 1);
  EXPECT_EQ(wide.cols, 300);
  EXPECT_EQ(wide.col, 100);
  EXPECT_EQ(wide.row, 100);
}

/// Rows every 45 cm at a heading, with gaps and noise.
OrthoField rowField(double heading, float gaps) {
  OrthoField field;
  field.name = "rows";
  field.gsd = 0.02;
  field.colour = Raster<Rgb>(400, 600);
  for (int r = 0; r < 400; ++r) {
    for (int c = 0; c < 600; ++c) {
      const double along = field.gsd * (c * std::cos(heading) + r * std::sin(heading));
      const double across = field.gsd * (-c * std::sin(heading) + r * std::cos(heading));
      const double row = std::floor(across / 0.45);
      const bool plant = across - 0.45 * row < 0.15 && noiseAt(5, along / 0.15, 7.0 * row) > gaps;
      const auto noise = static_cast<std::uint8_t>(40.0F * hashUniform(9, r, c));
      field.colour(r, c) = plant ? Rgb{60, static_cast<std::uint8_t>(100 + noise), 50}
                                 : Rgb{120, static_cast<std::uint8_t>(90 + noise), 85};
    }
  }
  return field;
}

TEST(FindRowHeading, FindsRowsAtAnyHeading) {
  for (const double heading : {-89.0, -47.3, -2.0, 0.0, 13.0, 45.0, 88.5}) {
    const double found = degrees(findRowHeading(rowField(radians(heading), 0.0F)));
    EXPECT_NEAR(std::remainder(found - heading, 180.0), 0.0, 0.3) << heading;
  }
  OrthoField field = rowField(radians(30.0), -0.5F);
  field.valid = Raster<std::uint8_t>(400, 600, 1);
  for (int r = 0; r < 400; ++r) {
    for (int c = 0; c < 250; ++c) {
      field.valid(r, c) = 0;
      field.colour(r, c) = Rgb{};
    }
  }
  EXPECT_NEAR(degrees(findRowHeading(field)), 30.0, 0.4);
}

TEST(FindRowHeading, SaysWhenNoRowsStandOut) {
  OrthoField field = rowField(0.0, 2.0F);  // soil only
  expectError<InputError>([&] { findRowHeading(field); }, {"rows", "counter-clockwise"});
  field.colour = Raster<Rgb>(400, 600, Rgb{90, 90, 90});
  expectError<InputError>([&] { findRowHeading(field); }, {"rows", "counter-clockwise"});
  field.colour = Raster<Rgb>(1, 2);
  expectError<InputError>([&] { findRowHeading(field); }, {"rows", "counter-clockwise"});
}

}  // namespace
}  // namespace agricolmap::simulate
