// What is known about rasters without opening one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/io/raster/raster_place.hpp"

namespace agricolmap::io {

void listOptions(OptionTable& table, RasterOptions& options) {
  table
      .choice("bands", options.bands, {"auto", "rgb", "rbg", "grb", "gbr", "brg", "bgr"},
              "colours of the picture's first three bands; auto: as the file declares")
      .basic();
  table
      .flag("black_is_nodata", options.black_is_nodata,
            "treat black as no data where the picture declares neither nodata nor alpha")
      .basic();
}

void removeFarHeights(Raster<float>& heights, double max_height) {
  constexpr std::size_t kSampleSize = 1U << 20;
  const std::size_t step = std::max<std::size_t>(1, heights.size() / kSampleSize);
  std::vector<float> sample;
  for (std::size_t i = 0; i < heights.size(); i += step) {
    if (!std::isnan(heights[i])) sample.push_back(heights[i]);
  }
  if (sample.empty()) return;
  const float middle = median(sample);
  const auto limit = static_cast<float>(max_height);
  for (float& height : heights) {
    if (std::abs(height - middle) > limit) height = std::numeric_limits<float>::quiet_NaN();
  }
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

}  // namespace agricolmap::io
