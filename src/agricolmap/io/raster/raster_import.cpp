#include "agricolmap/io/raster/raster_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/raster_place.hpp"

namespace agricolmap::io {

void listOptions(OptionTable& table, ImportOptions& options) {
  listOptions(table, options.raster);
  table.integer("step", options.step, 1, 1000, "px", "keep every n-th pixel of every n-th row")
      .basic();
  table
      .number("max_height", options.max_height, 0.1, 10000.0, "m",
              "drop heights farther than this from the median: nodata that is not declared")
      .basic();
}

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kLeastWeight = 0.5F;

/// Bilinear between the centres of pixels; NaN where less than half the weight has data.
float sampleHeight(const Raster<float>& height, const Eigen::Vector2d& pixel) {
  const double u = pixel.x() - 0.5;
  const double v = pixel.y() - 0.5;
  if (!(u >= -0.5 && v >= -0.5 && u <= height.cols() - 0.5 && v <= height.rows() - 0.5)) {
    return kNone;
  }
  const auto cells = cellsClamped<float>(height.rows(), height.cols(), u, v);
  const std::array<float, 4> shares = cells.shares();
  float weights = 0.0F;
  float sum = 0.0F;
  for (int i = 0; i < 4; ++i) {
    const float z = height(cells.row + (i >> 1) * cells.up, cells.col + (i & 1) * cells.right);
    if (std::isnan(z)) continue;
    const float weight = shares[static_cast<std::size_t>(i)];
    weights += weight;
    sum += weight * z;
  }
  return weights >= kLeastWeight ? sum / weights : kNone;
}

/// Heights at the kept pixels of the picture; NaN where there is no colour or no height.
Raster<float> sampleAll(const RasterImage& ortho, const RasterHeights& dsm, int step) {
  const Eigen::Affine2d dsm_from_ortho =
      dsm.place.world_from_pixel->inverse() * *ortho.place.world_from_pixel;
  Raster<float> heights((ortho.colour.rows() + step - 1) / step,
                        (ortho.colour.cols() + step - 1) / step, kNone);
  parallelFor(static_cast<std::size_t>(heights.rows()), [&](std::size_t i) {
    const int row = static_cast<int>(i);
    for (int col = 0; col < heights.cols(); ++col) {
      if (ortho.valid(row * step, col * step) == 0) continue;
      heights(row, col) = sampleHeight(
          dsm.height, dsm_from_ortho * Eigen::Vector2d(col * step + 0.5, row * step + 0.5));
    }
  });
  return heights;
}

/// Heights of a map without a surface model.
Raster<float> flatHeights(const RasterImage& ortho, int step) {
  Raster<float> heights((ortho.colour.rows() + step - 1) / step,
                        (ortho.colour.cols() + step - 1) / step, kNone);
  for (int row = 0; row < heights.rows(); ++row) {
    for (int col = 0; col < heights.cols(); ++col) {
      if (ortho.valid(row * step, col * step) != 0) heights(row, col) = 0.0F;
    }
  }
  return heights;
}

/// The points of one row, in the cloud's coordinates.
struct RowPoints {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  std::vector<Rgb> rgb;
};

RowPoints rowPoints(const RasterImage& ortho, const Raster<float>& heights, int step, int row,
                    const CoordinateMap* map) {
  RowPoints points;
  for (int col = 0; col < heights.cols(); ++col) {
    const float height = heights(row, col);
    if (std::isnan(height)) continue;
    const Eigen::Vector2d at =
        *ortho.place.world_from_pixel * Eigen::Vector2d(col * step + 0.5, row * step + 0.5);
    points.x.push_back(at.x());
    points.y.push_back(at.y());
    points.z.push_back(static_cast<double>(height));
    points.rgb.push_back(ortho.colour(row * step, col * step));
  }
  if (map != nullptr) {
    map->apply(points.x.data(), points.y.data(), points.z.data(), points.x.size());
  }
  const auto lost = [](double x) { return !std::isfinite(x); };
  if (std::any_of(points.x.begin(), points.x.end(), lost)) {
    throw InputError(fmt::format(
        "{}: some of its pixels have no place in the coordinate system of the other map",
        ortho.name));
  }
  return points;
}

Cloud toCloud(const RasterImage& ortho, const Raster<float>& heights, int step,
              const CoordinateMap* map) {
  const auto rows = static_cast<std::size_t>(heights.rows());
  std::vector<std::size_t> first(rows + 1, 0);
  std::vector<std::size_t> coloured(rows, 0);
  parallelFor(rows, [&](std::size_t row) {
    for (int col = 0; col < heights.cols(); ++col) {
      const int r = static_cast<int>(row);
      if (!std::isnan(heights(r, col))) ++first[row + 1];
      if (ortho.valid(r * step, col * step) != 0) ++coloured[row];
    }
  });
  std::size_t pixels = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    first[row + 1] += first[row];
    pixels += coloured[row];
  }
  Cloud cloud;
  cloud.name = ortho.name;
  cloud.dropped_points = pixels - first[rows];
  if (first[rows] == 0) return cloud;
  const auto begin = std::find_if(first.begin(), first.end(), [](auto n) { return n > 0; });
  const RowPoints any =
      rowPoints(ortho, heights, step, static_cast<int>(begin - first.begin()) - 1, map);
  cloud.origin = {std::round(any.x[0]), std::round(any.y[0]), std::round(any.z[0])};
  cloud.xyz.resize(first[rows]);
  cloud.rgb.resize(first[rows]);
  parallelFor(rows, [&](std::size_t row) {
    const RowPoints points = rowPoints(ortho, heights, step, static_cast<int>(row), map);
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      cloud.xyz[first[row] + i] =
          (Eigen::Vector3d(points.x[i], points.y[i], points.z[i]) - cloud.origin).cast<float>();
      cloud.rgb[first[row] + i] = points.rgb[i];
    }
  });
  return cloud;
}

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Heights at the kept pixels, by the surface model.
Raster<float> modelHeights(const RasterImage& image, const std::filesystem::path& dsm,
                           const ImportOptions& options, std::vector<std::string>& warnings) {
  RasterHeights model = readHeights(dsm);
  checkGeoreference(model.name, model.place);
  if (const auto warning = checkSameCrs(image.name, image.place, model.name, model.place)) {
    warnings.push_back(*warning);
  }
  append(warnings, model.warnings);
  // Before anything is interpolated: a hole would reach into the pixels beside it.
  const std::size_t removed = removeFarHeights(model.height, options.max_height);
  if (removed > 0) {
    warnings.push_back(
        fmt::format("{}: {} heights were left out: farther than {} m from their median, or all at "
                    "one value far "
                    "below the others",
                    model.name, removed, options.max_height));
  }
  Raster<float> heights = sampleAll(image, model, options.step);
  if (std::all_of(heights.begin(), heights.end(), [](float z) { return std::isnan(z); })) {
    throw InputError(
        fmt::format("no pixel of {} ({}) has a height in {} ({}); do the two show the same field?",
                    image.name, extentOf(image.place, image.colour.rows(), image.colour.cols()),
                    model.name, extentOf(model.place, model.height.rows(), model.height.cols())));
  }
  return heights;
}

}  // namespace

Cloud importOrtho(const std::filesystem::path& ortho,
                  const std::optional<std::filesystem::path>& dsm, const ImportOptions& options,
                  const CoordinateMap* map) {
  checkOptions(options);
  const RasterImage image = readRaster(ortho, options.raster);
  checkGeoreference(image.name, image.place);
  std::vector<std::string> warnings = image.warnings;
  if (image.transparent > 0) {
    warnings.push_back(fmt::format("{}: {} of its {} pixels are transparent, and left out",
                                   image.name, image.transparent, image.valid.size()));
  }
  if (!dsm) {
    warnings.push_back(fmt::format(
        "{}: without a surface model it is laid flat, and heights mean nothing; give ORTHO,DSM",
        image.name));
  }
  const Raster<float> heights =
      dsm ? modelHeights(image, *dsm, options, warnings) : flatHeights(image, options.step);
  Cloud cloud = toCloud(image, heights, options.step, map);
  append(cloud.warnings, warnings);
  cloud.fields = dsm ? "red, green, blue, height" : "red, green, blue";
  return cloud;
}

Cloud importOrthoDsm(const std::filesystem::path& ortho,
                     const std::optional<std::filesystem::path>& dsm,
                     const ImportOptions& options) {
  checkOptions(options);
  const RasterShape shape = readRasterShape(ortho);
  checkMetres(shape.name, shape.place);
  if (dsm) {
    const RasterShape model = readRasterShape(*dsm);
    checkMetres(model.name, model.place);
  }
  Cloud cloud = importOrtho(ortho, dsm, options);
  if (const auto crs = crsFromWkt(shape.place.crs)) cloud.crs = *crs;
  cloud.crs.vertical_unit = 1.0;
  return cloud;
}

}  // namespace agricolmap::io
