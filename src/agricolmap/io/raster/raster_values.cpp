// What is known about rasters without opening one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <ios>
#include <limits>
#include <string_view>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/io/cloud/hole_height.hpp"
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

bool looksLikeRaster(const std::filesystem::path& path) {
  using std::string_view_literals::operator""sv;
  constexpr std::array kBegins{"II*\0"sv,   "MM\0*"sv,        "II+\0"sv,      "MM\0+"sv,
                               "\x89PNG"sv, "\xFF\xD8\xFF"sv, "<VRTDataset"sv};
  std::array<char, 16> bytes{};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), bytes.size());
  const std::string_view begin(bytes.data(), bytes.size());
  return std::any_of(kBegins.begin(), kBegins.end(),
                     [&](std::string_view with) { return begin.starts_with(with); });
}

std::size_t removeFarHeights(Raster<float>& heights, double max_height) {
  constexpr std::size_t kSampleSize = 1U << 20;
  const std::size_t step = std::max<std::size_t>(1, heights.size() / kSampleSize);
  std::vector<float> sample;
  LowestHeights lowest;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (std::isnan(heights[i])) continue;
    if (i % step == 0) sample.push_back(heights[i]);
    lowest.take(static_cast<double>(heights[i]));
  }
  if (sample.empty()) return 0;
  const auto hole = holeHeight(lowest, {sample.begin(), sample.end()});
  const float middle = median(sample);
  const auto limit = static_cast<float>(max_height);
  std::size_t removed = 0;
  for (float& height : heights) {
    const bool in_hole = hole && static_cast<double>(height) == *hole;
    if (!(std::abs(height - middle) > limit) && !in_hole) continue;
    height = std::numeric_limits<float>::quiet_NaN();
    ++removed;
  }
  return removed;
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
