#include "experiments/methods/features/features.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::experiments {

ExgImage exgImage(const map::GridMap& map) {
  const int rows = map.frame.rows;
  const int cols = map.frame.cols;
  ExgImage image{Raster<std::uint8_t>(rows, cols), Raster<std::uint8_t>(rows, cols)};
  Raster<float> value(rows, cols);
  Raster<float> weight(rows, cols);
  std::vector<float> seen;
  seen.reserve(map.filled);
  for (std::size_t i = 0; i < map.weight.size(); ++i) {
    if (!map.valid(i)) continue;
    image.known[i] = 1;
    value[i] = map.exg[i];
    weight[i] = 1.0F;
    seen.push_back(map.exg[i]);
  }
  if (seen.empty()) return image;
  std::sort(seen.begin(), seen.end());
  const float low = seen[seen.size() / 100];
  const float high = seen[seen.size() - 1 - seen.size() / 100];
  const float middle = seen[seen.size() / 2];
  // From near cells where there are any, else from further ones.
  for (int radius = 2; radius <= 64; radius *= 2) {
    const Raster<float> mean = map::weightedBoxMean(value, weight, radius);
    Raster<float> grown = weight;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      if (weight[i] > 0.0F || mean[i] == 0.0F) continue;
      value[i] = mean[i];
      grown[i] = 1.0F;
    }
    weight = grown;
  }
  const float span = std::max(high - low, 1e-6F);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const float at = weight[i] > 0.0F ? value[i] : middle;
    image.grey[i] =
        static_cast<std::uint8_t>(std::lround(255.0F * std::clamp((at - low) / span, 0.0F, 1.0F)));
  }
  return image;
}

Features onKnownGround(const Features& features, const ExgImage& image) {
  Features kept;
  kept.bytes = features.bytes;
  std::vector<Eigen::Index> columns;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int col = static_cast<int>(std::lround(features.cells[i].x()));
    const int row = static_cast<int>(std::lround(features.cells[i].y()));
    if (!image.known.contains(row, col) || image.known(row, col) == 0) continue;
    kept.cells.push_back(features.cells[i]);
    columns.push_back(static_cast<Eigen::Index>(i));
    if (features.bytes > 0) {
      const auto first = features.bits.begin() + static_cast<std::ptrdiff_t>(i * features.bytes);
      kept.bits.insert(kept.bits.end(), first, first + static_cast<std::ptrdiff_t>(features.bytes));
    }
  }
  if (features.bytes == 0) {
    kept.real.resize(features.real.rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      kept.real.col(static_cast<Eigen::Index>(k)) = features.real.col(columns[k]);
    }
  }
  return kept;
}

}  // namespace agricolmap::experiments
