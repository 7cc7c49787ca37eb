#include "agricolmap/io/raster_import.hpp"

#include <fmt/format.h>
#include <ogr_spatialref.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap {

void describe(OptionTable& table, ImportOptions& options) {
  describe(table, options.raster);
  table.integer("step", options.step, 1, 1000, "px", "keep every n-th pixel of every n-th row");
  table.number("max_height", options.max_height, 0.1, 10000.0, "m",
               "drop heights farther than this from the median: nodata that is not declared");
}

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kLeastWeight = 0.5F;
constexpr double kMetreTolerance = 1e-6;
constexpr std::size_t kSampleSize = 1U << 20;

OGRSpatialReference horizontalCrs(const RasterPlace& place, const std::string& name) {
  OGRSpatialReference crs;
  if (crs.importFromWkt(place.crs.c_str()) != OGRERR_NONE) {
    throw InputError(fmt::format("{}: its coordinate system cannot be understood", name));
  }
  if (crs.IsCompound() != 0) crs.StripVertical();
  return crs;
}

void checkMetres(const RasterPlace& place, const std::string& name) {
  if (!place.world_from_pixel) {
    throw InputError(fmt::format(
        "{}: is not georeferenced; give it its place with gdal_translate -a_ullr and -a_srs",
        name));
  }
  if (std::abs(place.world_from_pixel->linear().determinant()) <= 0.0) {
    throw InputError(fmt::format("{}: its georeference is degenerate", name));
  }
  if (place.crs.empty()) return;
  const OGRSpatialReference crs = horizontalCrs(place, name);
  if (crs.IsGeographic() != 0 || crs.IsGeocentric() != 0) {
    throw InputError(fmt::format(
        "{}: its coordinates are degrees, not metres; reproject it: gdalwarp -t_srs EPSG:326<zone> "
        "(UTM north; 327<zone> south)",
        name));
  }
  const char* unit = nullptr;
  const double metres = crs.GetLinearUnits(&unit);
  if (std::abs(metres - 1.0) > kMetreTolerance) {
    throw InputError(
        fmt::format("{}: its coordinates are in units of {} m ({}); reproject it to metres with "
                    "gdalwarp -t_srs",
                    name, metres, unit == nullptr ? "unnamed" : unit));
  }
}

void checkPlaces(const RasterImage& ortho, const RasterHeights& dsm) {
  checkMetres(ortho.place, ortho.name);
  checkMetres(dsm.place, dsm.name);
  if (ortho.place.crs.empty() || dsm.place.crs.empty()) {
    spdlog::warn(
        "{}: coordinate system not given; taken as metres in the same one for both rasters",
        ortho.place.crs.empty() ? ortho.name : dsm.name);
    return;
  }
  const OGRSpatialReference one = horizontalCrs(ortho.place, ortho.name);
  const OGRSpatialReference other = horizontalCrs(dsm.place, dsm.name);
  const char* const lenient[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT",
                                 nullptr};
  if (one.IsSame(&other, lenient) == 0) {
    throw InputError(fmt::format(
        "{} ({}) and {} ({}) have different coordinate systems; reproject one with gdalwarp -t_srs",
        ortho.name, one.GetName(), dsm.name, other.GetName()));
  }
}

/// Bilinear between the centres of pixels; NaN where less than half the weight has data.
float sampleHeight(const Raster<float>& height, const Eigen::Vector2d& pixel) {
  const double u = pixel.x() - 0.5;
  const double v = pixel.y() - 0.5;
  if (!(u >= -0.5 && v >= -0.5 && u <= height.cols() - 0.5 && v <= height.rows() - 0.5)) {
    return kNone;
  }
  const int col = static_cast<int>(std::floor(u));
  const int row = static_cast<int>(std::floor(v));
  const auto fu = static_cast<float>(u - col);
  const auto fv = static_cast<float>(v - row);
  float weights = 0.0F;
  float sum = 0.0F;
  for (int i = 0; i < 4; ++i) {
    const int dc = i & 1;
    const int dr = i >> 1;
    const float z = height(std::clamp(row + dr, 0, height.rows() - 1),
                           std::clamp(col + dc, 0, height.cols() - 1));
    if (std::isnan(z)) continue;
    const float weight = (dc == 0 ? 1.0F - fu : fu) * (dr == 0 ? 1.0F - fv : fv);
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

std::string extentOf(const RasterPlace& place, int rows, int cols) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(cols, 0),
                             Eigen::Vector2d(0, rows), Eigen::Vector2d(cols, rows)}) {
    box.extend(*place.world_from_pixel * corner);
  }
  return fmt::format("{:.1f}..{:.1f}, {:.1f}..{:.1f}", box.min().x(), box.max().x(), box.min().y(),
                     box.max().y());
}

/// Removes heights far from the median.
void removeOutliers(Raster<float>& heights, double max_height) {
  const std::size_t step = std::max<std::size_t>(1, heights.size() / kSampleSize);
  std::vector<float> sample;
  for (std::size_t i = 0; i < heights.size(); i += step) {
    if (!std::isnan(heights[i])) sample.push_back(heights[i]);
  }
  if (sample.empty()) return;
  const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  const float median = *middle;
  const auto limit = static_cast<float>(max_height);
  for (float& height : heights) {
    if (std::abs(height - median) > limit) height = kNone;
  }
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
  checkPlaces(image, model);
  Raster<float> heights = sampleAll(image, model, options.step);
  removeOutliers(heights, options.max_height);
  Cloud cloud = toCloud(image, heights, options.step);
  if (cloud.empty()) {
    throw InputError(
        fmt::format("no pixel of {} ({}) has a height in {} ({}); do the two show the same field?",
                    image.name, extentOf(image.place, image.colour.rows(), image.colour.cols()),
                    model.name, extentOf(model.place, model.height.rows(), model.height.cols())));
  }
  if (cloud.dropped_points > 0) {
    spdlog::info("{}: {} of {} pixels have no height in {}", image.name, cloud.dropped_points,
                 cloud.dropped_points + cloud.size(), model.name);
  }
  return cloud;
}

}  // namespace agricolmap
