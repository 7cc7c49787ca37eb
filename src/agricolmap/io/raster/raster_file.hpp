// Reading pictures and georeferenced rasters through GDAL: orthomosaics, surface models, PNG.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/options.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::io {

/// Which colour each of the file's first three bands is.
enum class BandOrder {
  kAuto,  ///< as the file declares; red, green, blue where it does not
  kRgb,
  kRbg,
  kGrb,
  kGbr,
  kBrg,
  kBgr,
};

struct RasterOptions {
  BandOrder bands = BandOrder::kAuto;
  bool black_is_nodata = true;
};
void listOptions(OptionTable& table, RasterOptions& options);

/// A rectangle of a file's pixels, counted from its first column and row: its top left.
struct PixelWindow {
  int col = 0;
  int row = 0;
  int cols = 0;
  int rows = 0;
};

/// What of a raster to read.
struct RasterPart {
  std::optional<PixelWindow> window;  ///< nothing: all of it
  int step = 1;                       ///< one pixel for each `step` × `step`; whole blocks only
};

/// Where a raster lies.
struct RasterPlace {
  /// Continuous (col, row) → projected (x, y) [m]; pixel (c, r) has its centre at (c+½, r+½).
  /// Nothing where the file has no georeference.
  std::optional<Eigen::Affine2d> world_from_pixel;
  std::string crs;  ///< as WKT; empty where the file has none
};

/// A colour picture. Unlike grid maps, row 0 is the file's first: its top, north in most.
struct RasterImage {
  std::string name;             ///< file it came from
  Raster<Rgb> colour;           ///< means nothing where not valid
  Raster<std::uint8_t> valid;   ///< 1 where the picture has data
  std::size_t transparent = 0;  ///< pixels that transparency or the file's mask takes away
  RasterPlace place;
  std::vector<std::string> warnings;
};

/// A surface or terrain model, rows as in the file.
struct RasterHeights {
  std::string name;
  Raster<float> height;  ///< [m], whatever the file's unit; NaN where there is none
  RasterPlace place;
  std::vector<std::string> warnings;
};

/// Whether a file begins as TIFF, PNG, JPEG or GDAL's VRT do; false when it cannot be read.
bool looksLikeRaster(const std::filesystem::path& path);

/// Size and place of a raster, without reading its pixels.
struct RasterShape {
  std::string name;
  int cols = 0;
  int rows = 0;
  RasterPlace place;
};

/// Keeps GDAL from printing in all threads of the process, those that it starts itself included.
/// For programs: a library leaves the process alone.
void silenceGdal();

/// Throws InputError when the file is no raster.
RasterShape readRasterShape(const std::filesystem::path& path);

/// Reads a colour raster, or a part of one: place and pixels are then the part's. No data is where
/// alpha is below half of its largest value, the file's mask says so, all three bands have their
/// nodata value, a value is not finite or, where the file declares none of these and
/// `black_is_nodata` is on, black. Values of more than 8 bits are scaled by one factor for all
/// bands, so that the 99.5th percentile becomes 255, unless none exceeds 255 (integers). Throws
/// InputError when the file is no raster, has no colours, does not contain the window, or nothing
/// is valid.
RasterImage readRaster(const std::filesystem::path& path, const RasterOptions& options = {},
                       const RasterPart& part = {});

/// Reads the first band, or a part of it, as heights, which its unit, scale and offset bring to
/// metres. Throws InputError, also where the values are a picture's.
RasterHeights readHeights(const std::filesystem::path& path, const RasterPart& part = {});

/// Replaces heights farther than `max_height` from the median by NaN, and those at one value far
/// below all others: nodata that is not declared. How many these were.
std::size_t removeFarHeights(Raster<float>& heights, double max_height);

}  // namespace agricolmap::io
