#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <stop_token>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/geo_writer.hpp"
#include "agricolmap/io/raster/mosaic_writer.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/io/raster/raster_test_support.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::TempDir;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Heights that rise to the north and east, with a corner of nothing in the south-west.
Raster<float> slope(int rows, int cols) {
  Raster<float> heights(rows, cols);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      heights(r, c) =
          r < 3 && c < 5 ? kNone : 0.25F * static_cast<float>(r) + 0.5F * static_cast<float>(c);
    }
  }
  return heights;
}

GeoLayer layerOn(int rows, int cols) {
  GeoLayer layer;
  layer.frame = {{0.25, 0.5}, 0.05, rows, cols};
  layer.origin = {500000.0, 5000000.0, 300.0};
  layer.crs = "EPSG:32632";
  return layer;
}

TEST(GeoLayers, ComeBackAsTheyWere) {
  const TempDir dir;
  const Raster<float> plane = slope(40, 60);
  Raster<float> height = plane;
  height(20, 30) = kNone;
  GeoLayer layer = layerOn(40, 60);
  layer.bands = {{&plane, "plane", "m"}, {&height, "height", "m"}};
  layer.nodata = kNone;
  layer.metadata = {{"AGRICOLMAP_LAYER", "error"}};
  writeLayer(dir / "error.tif", layer);
  const Layer<float> read = readLayer<float>(dir / "error.tif");
  EXPECT_NEAR((read.shape.frame.corner - layer.frame.corner).norm(), 0.0, 1e-8);
  EXPECT_EQ(read.shape.origin, Eigen::Vector3d(500000.0, 5000000.0, 0.0));
  EXPECT_NEAR(read.shape.frame.cell, 0.05, 1e-12);
  EXPECT_NE(read.shape.crs.find("UTM zone 32N"), std::string::npos);
  EXPECT_EQ(read.shape.bands, (std::vector<std::string>{"plane", "height"}));
  EXPECT_EQ(read.shape.units, (std::vector<std::string>{"m", "m"}));
  EXPECT_EQ(read.shape.metadata.at("AGRICOLMAP_LAYER"), "error");
  EXPECT_EQ(read.shape.metadata.at("AREA_OR_POINT"), "Area");
  ASSERT_EQ(read.bands.size(), 2U);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    EXPECT_EQ(std::isnan(read.bands[0][i]), std::isnan(plane[i]));
    EXPECT_EQ(read.valid[i] != 0, !std::isnan(plane[i]));
    if (read.valid[i] != 0) {
      EXPECT_EQ(read.bands[0][i], plane[i]);
    }
  }
  EXPECT_TRUE(std::isnan(read.bands[1](20, 30)));
  EXPECT_FALSE(std::filesystem::exists(dir / "error.tif.aux.xml"));
}

TEST(GeoLayers, AreNorthUpInTheFile) {
  const TempDir dir;
  const Raster<float> heights = slope(40, 60);
  GeoLayer layer = layerOn(40, 60);
  layer.bands = {{&heights, "surface", "m"}};
  layer.nodata = kNone;
  layer.add = layer.origin.z();
  writeLayer(dir / "surface.tif", layer);
  const RasterHeights picture = readHeights(dir / "surface.tif");
  EXPECT_TRUE(std::isnan(picture.height(39, 0)));
  EXPECT_FLOAT_EQ(picture.height(0, 7), 300.0F + heights(39, 7));
  const Eigen::Vector2d north_west = *picture.place.world_from_pixel * Eigen::Vector2d::Zero();
  EXPECT_NEAR((north_west - Eigen::Vector2d(500000.25, 5000002.5)).norm(), 0.0, 1e-6);
}

TEST(GeoLayers, CodesDatesAndColoursKeepTheirTypes) {
  const TempDir dir;
  Raster<std::uint16_t> source(9, 11, 1);
  source(8, 2) = 40000;
  Raster<std::int32_t> date(9, 11, 0);
  date(1, 3) = 20260713;
  Raster<Rgb> colour(9, 11, {10, 20, 30});
  colour(0, 1) = {1, 2, 3};
  Raster<std::uint8_t> mask(9, 11, 1);
  mask(0, 0) = 0;
  const auto write = [&](const char* name, const GeoValues& values) {
    GeoLayer layer = layerOn(9, 11);
    layer.bands = {{values, "it", ""}};
    layer.overviews = Overviews::kNearest;
    if (std::holds_alternative<const Raster<Rgb>*>(values)) {
      layer.mask = &mask;
    } else {
      layer.nodata = 0.0;
    }
    writeLayer(dir / name, layer);
  };
  write("source.tif", &source);
  write("date.tif", &date);
  write("colour.tif", &colour);
  write("mask.tif", &mask);
  EXPECT_TRUE(std::ranges::equal(readLayer<std::uint16_t>(dir / "source.tif").bands[0], source));
  const Layer<std::int32_t> dates = readLayer<std::int32_t>(dir / "date.tif");
  EXPECT_TRUE(std::ranges::equal(dates.bands[0], date));
  EXPECT_EQ(std::ranges::count(dates.valid, 1), 1);
  const Layer<Rgb> colours = readLayer<Rgb>(dir / "colour.tif");
  EXPECT_TRUE(std::ranges::equal(colours.bands[0], colour));
  EXPECT_TRUE(std::ranges::equal(colours.valid, mask));
  EXPECT_TRUE(std::ranges::equal(readLayer<std::uint8_t>(dir / "mask.tif").bands[0], mask));
  expectError<InputError>([&] { readLayer<std::uint16_t>(dir / "date.tif"); },
                          {"date.tif", "Int32", "UInt16"});
  expectError<InputError>([&] { readLayer<Rgb>(dir / "date.tif"); }, {"1 bands", "three"});
}

TEST(GeoLayers, GiveAPartOfTheirCells) {
  const TempDir dir;
  const Raster<float> heights = slope(1200, 700);
  GeoLayer layer = layerOn(1200, 700);
  layer.bands = {{&heights, "surface", "m"}};
  layer.nodata = kNone;
  writeLayer(dir / "l.tif", layer);
  const Layer<float> part = readLayer<float>(dir / "l.tif", CellWindow{100, 20, 800, 600});
  EXPECT_EQ(part.bands[0](0, 0), heights(100, 20));
  EXPECT_EQ(part.bands[0](799, 599), heights(899, 619));
  const Eigen::Vector2d corner = part.shape.origin.head<2>() + part.shape.frame.corner;
  EXPECT_NEAR((corner - Eigen::Vector2d(500001.25, 5000005.5)).norm(), 0.0, 1e-6);
  expectError<InputError>(
      [&] {
        readLayer<float>(dir / "l.tif", CellWindow{0, 0, 1201, 1});
      },
      {"l.tif", "1 x 1201", "700 x 1200"});
}

TEST(GeoLayers, AreCloudOptimisedWithOverviewsOfTheirKind) {
  const TempDir dir;
  Raster<std::uint16_t> source(1100, 1100);
  for (int r = 0; r < 1100; ++r) {
    for (int c = 0; c < 1100; ++c) source(r, c) = (r + c) % 2 == 0 ? 2 : 7;
  }
  GeoLayer layer = layerOn(1100, 1100);
  layer.bands = {{&source, "source", ""}};
  layer.overviews = Overviews::kNearest;
  writeLayer(dir / "source.tif", layer);
  const GDALDatasetUniquePtr dataset(GDALDataset::Open((dir / "source.tif").c_str()));
  ASSERT_TRUE(dataset);
  const char* const layout = dataset->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE");
  EXPECT_STREQ(layout, "COG");
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  ASSERT_EQ(band.GetOverviewCount(), 2);
  GDALRasterBand& overview = *band.GetOverview(0);
  std::vector<std::uint16_t> line(static_cast<std::size_t>(overview.GetXSize()));
  ASSERT_EQ(overview.RasterIO(GF_Read, 0, 3, overview.GetXSize(), 1, line.data(),
                              overview.GetXSize(), 1, GDT_UInt16, 0, 0, nullptr),
            CE_None);
  EXPECT_TRUE(std::ranges::all_of(line, [](auto code) { return code == 2 || code == 7; }));
}

TEST(GeoLayers, RefuseWhatDoesNotFit) {
  const TempDir dir;
  const Raster<float> heights(4, 5);
  const Raster<std::uint8_t> bytes(4, 5);
  GeoLayer layer = layerOn(4, 5);
  const auto refuses = [&](const GeoLayer& bad, std::initializer_list<const char*> parts) {
    expectError<UsageError>([&] { writeLayer(dir / "l.tif", bad); }, parts);
  };
  refuses(layer, {"l.tif", "needs a band"});
  layer.bands = {{&heights, "a", ""}, {&bytes, "b", ""}};
  refuses(layer, {"several types"});
  layer.bands = {{&heights, "a", ""}};
  GeoLayer other = layer;
  other.frame.rows = 3;
  refuses(other, {"5 x 4", "5 x 3"});
  other = layer;
  other.crs = "nowhere";
  refuses(other, {"coordinate system"});
  other.crs.clear();
  other.bands = {{&bytes, "b", ""}};
  other.add = 1.0;
  refuses(other, {"only floats"});
  expectError<OutputError>([&] { writeLayer(dir / "none/l.tif", layer); }, {"none/l.tif"});
  test::Sheet turned = test::surfaceModel();
  turned.place = {0.0, 0.5, 0.1, 0.0, 0.1, -0.5};
  expectError<InputError>([&] { readLayerShape(writeSheet(dir / "turned.tif", turned)); },
                          {"turned.tif", "north up", "gdalwarp"});
  turned.georeferenced = false;
  turned.epsg = 0;
  expectError<InputError>([&] { readLayerShape(writeSheet(dir / "bare.tif", turned)); },
                          {"bare.tif"});
}

TEST(GeoLayers, StopsWhenAsked) {
  const TempDir dir;
  const Raster<float> heights = slope(1200, 1200);
  GeoLayer layer = layerOn(1200, 1200);
  layer.bands = {{&heights, "a", ""}};
  std::stop_source stop;
  stop.request_stop();
  const StopScope scope(stop.get_token());
  EXPECT_THROW(writeLayer(dir / "l.tif", layer), Interrupted);
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

/// Writes under a limit on the size of files, in a process that ends: 0 when that was a success, 3
/// when it was an error after which nothing is left, 1 otherwise.
[[noreturn]] void writeUnderLimit(const std::filesystem::path& dir, const GeoLayer& layer,
                                  rlim_t limit) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit bound{limit, limit};
  if (::setrlimit(RLIMIT_FSIZE, &bound) != 0) std::_Exit(1);
  try {
    writeLayer(dir / "l.tif", layer);
  } catch (const OutputError& error) {
    const bool named = std::string(error.what()).find("File too large") != std::string::npos;
    std::_Exit(named && std::filesystem::is_empty(dir) ? 3 : 1);
  } catch (...) {
    std::_Exit(1);
  }
  std::_Exit(0);
}

TEST(GeoLayers, NoFullDiskGoesUnnoticed) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TempDir dir;
  Raster<float> heights = slope(700, 600);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] += std::sin(static_cast<float>(i));
  GeoLayer layer = layerOn(700, 600);
  layer.bands = {{&heights, "a", ""}};
  layer.nodata = kNone;
  writeLayer(dir / "l.tif", layer);
  const auto whole = static_cast<rlim_t>(std::filesystem::file_size(dir / "l.tif"));
  std::filesystem::remove(dir / "l.tif");
  for (const rlim_t limit :
       {rlim_t{0}, rlim_t{100}, whole / 8, whole / 2, whole - 70000, whole - 4096, whole - 1}) {
    EXPECT_EXIT(writeUnderLimit(dir.path(), layer, limit), testing::ExitedWithCode(3), "")
        << limit << " of " << whole;
  }
  EXPECT_EXIT(writeUnderLimit(dir.path(), layer, 2 * whole), testing::ExitedWithCode(0), "");
}

// A field of 4 × 6 cells, and on it a piece of fine cells, one of which is empty.
TEST(Mosaic, LaysFinePiecesOnTheWhole) {
  const TempDir dir;
  Raster<float> coarse(4, 6, 1.0F);
  coarse(0, 0) = kNone;
  GeoLayer whole = layerOn(4, 6);
  whole.bands = {{&coarse, "height", "m"}};
  whole.nodata = kNone;
  writeLayer(dir / "whole.tif", whole);
  Raster<float> other(4, 2, 7.0F), fine(4, 2, 2.0F);
  fine(3, 1) = kNone;
  GeoLayer piece = whole;
  piece.frame = {whole.frame.corner + Eigen::Vector2d(2 * 0.05, 1 * 0.05), 0.025, 4, 2};
  piece.bands = {{&other, "other", ""}, {&fine, "height", "m"}};
  writeLayer(dir / "piece.tif", piece);
  Mosaic mosaic;
  mosaic.frame = {whole.frame.corner, 0.025, 8, 12};
  mosaic.origin = whole.origin;
  mosaic.crs = whole.crs;
  mosaic.name = "height";
  mosaic.unit = "m";
  mosaic.pieces = {{.file = "whole.tif", .rows = 8, .cols = 12, .cells = 2},
                   {.file = "piece.tif", .band = 2, .row = 2, .col = 4, .rows = 4, .cols = 2}};
  writeMosaic(dir / "height.vrt", mosaic);
  const Layer<float> read = readLayer<float>(dir / "height.vrt");
  EXPECT_NEAR((read.shape.frame.corner - mosaic.frame.corner).norm(), 0.0, 1e-8);
  EXPECT_NEAR(read.shape.frame.cell, 0.025, 1e-12);
  EXPECT_NE(read.shape.crs.find("UTM zone 32N"), std::string::npos);
  for (int r = 0; r < 8; ++r) {
    for (int c = 0; c < 12; ++c) {
      const bool on_piece = r >= 2 && r < 6 && c >= 4 && c < 6 && !(r == 5 && c == 5);
      if (r < 2 && c < 2) {
        EXPECT_TRUE(std::isnan(read.bands[0](r, c)));
      } else {
        EXPECT_EQ(read.bands[0](r, c), on_piece ? 2.0F : 1.0F) << r << ' ' << c;
      }
    }
  }
}

TEST(Mosaic, OfColoursShowsWhatTheirMasksShow) {
  const TempDir dir;
  const Raster<Rgb> green(2, 2, Rgb{10, 200, 30}), red(2, 2, Rgb{200, 10, 20});
  Raster<std::uint8_t> all(2, 2, 255), half(2, 2, 255);
  all(1, 1) = 0;
  half(0, 0) = half(1, 1) = 0;
  GeoLayer layer = layerOn(2, 2);
  layer.bands = {{&green, "", ""}};
  layer.mask = &all;
  writeLayer(dir / "green.tif", layer);
  layer.bands = {{&red, "", ""}};
  layer.mask = &half;
  writeLayer(dir / "red.tif", layer);
  Mosaic mosaic;
  mosaic.frame = layer.frame;
  mosaic.colour = true;
  mosaic.pieces = {{.file = "green.tif", .rows = 2, .cols = 2},
                   {.file = "red.tif", .rows = 2, .cols = 2}};
  writeMosaic(dir / "colour.vrt", mosaic);
  const Layer<Rgb> read = readLayer<Rgb>(dir / "colour.vrt");
  EXPECT_EQ(read.bands[0](0, 0), (Rgb{10, 200, 30}));
  EXPECT_EQ(read.bands[0](0, 1), (Rgb{200, 10, 20}));
  EXPECT_EQ(read.bands[0](1, 0), (Rgb{200, 10, 20}));
  EXPECT_EQ(read.valid(0, 0), 1);
  EXPECT_EQ(read.valid(1, 1), 0);
}

}  // namespace
}  // namespace agricolmap::io
