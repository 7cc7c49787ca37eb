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

Cloud toCloud(const RasterImage& ortho, const Raster<float>& heights, int step) {
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
  const Eigen::Affine2d& world_from_pixel = *ortho.place.world_from_pixel;
  const Eigen::Vector2d corner = world_from_pixel * Eigen::Vector2d(0.5, 0.5);
  const float z = *std::find_if(heights.begin(), heights.end(),
                                [](float height) { return !std::isnan(height); });
  cloud.origin = {std::round(corner.x()), std::round(corner.y()),
                  std::round(static_cast<double>(z))};
  cloud.xyz.resize(first[rows]);
  cloud.rgb.resize(first[rows]);
  parallelFor(rows, [&](std::size_t row) {
    std::size_t next = first[row];
    for (int col = 0; col < heights.cols(); ++col) {
      const int r = static_cast<int>(row);
      const float height = heights(r, col);
      if (std::isnan(height)) continue;
      const Eigen::Vector2d at =
          world_from_pixel * Eigen::Vector2d(col * step + 0.5, r * step + 0.5);
      cloud.xyz[next] =
          (Eigen::Vector3d(at.x(), at.y(), static_cast<double>(height)) - cloud.origin)
              .cast<float>();
      cloud.rgb[next] = ortho.colour(r * step, col * step);
      ++next;
    }
  });
  return cloud;
}

}  // namespace

Cloud importOrthoDsm(const std::filesystem::path& ortho, const std::filesystem::path& dsm,
                     const ImportOptions& options) {
  checkOptions(options);
  const RasterImage image = readRaster(ortho, options.raster);
  const RasterHeights model = readHeights(dsm);
  checkMetres(image.name, image.place);
  checkMetres(model.name, model.place);
  const auto warning = checkSameCrs(image.name, image.place, model.name, model.place);
  Raster<float> heights = sampleAll(image, model, options.step);
  removeFarHeights(heights, options.max_height);
  Cloud cloud = toCloud(image, heights, options.step);
  if (cloud.empty()) {
    throw InputError(
        fmt::format("no pixel of {} ({}) has a height in {} ({}); do the two show the same field?",
                    image.name, extentOf(image.place, image.colour.rows(), image.colour.cols()),
                    model.name, extentOf(model.place, model.height.rows(), model.height.cols())));
  }
  if (warning) cloud.warnings.push_back(*warning);
  return cloud;
}

}  // namespace agricolmap::io
