#include "experiments/methods/features/features.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/map/box_mean.hpp"

namespace agricolmap::experiments {

ExgImage exgImage(const map::GridMap& map) {
  const int rows = map.frame.rows;
  const int cols = map.frame.cols;
  ExgImage image{cv::Mat::zeros(rows, cols, CV_8U), cv::Mat::zeros(rows, cols, CV_8U)};
  Raster<float> value(rows, cols);
  Raster<float> weight(rows, cols);
  std::vector<float> seen;
  seen.reserve(map.filled);
  for (std::size_t i = 0; i < map.weight.size(); ++i) {
    if (!map.valid(i)) continue;
    image.known.data[i] = 1;
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
    const Raster<float> mean = map::BoxMean(weight, radius).of(value);
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
    image.grey.data[i] =
        static_cast<std::uint8_t>(std::lround(255.0F * std::clamp((at - low) / span, 0.0F, 1.0F)));
  }
  return image;
}

}  // namespace agricolmap::experiments
