#include "agricolmap/refine/fit.hpp"

#include <cmath>

namespace agricolmap::refine {

Fit fitOf(const map::SignalMap& fixed, const map::SignalMap& moving, const Eigen::Affine2d& pose) {
  double seen = 0.0, shared = 0.0, product = 0.0, fixed2 = 0.0, moving2 = 0.0;
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      const std::size_t i = moving.weight.index(r, c);
      if (moving.weight[i] <= 0.0F) continue;
      seen += 1.0;
      const map::SignalSample look = map::sampleSignal(fixed, pose * moving.frame.centre(r, c));
      if (look.weight <= 0.0F) continue;
      shared += 1.0;
      for (int k = 0; k < map::kSignalChannels; ++k) {
        const auto f = static_cast<double>(look.value[k]);
        const auto m = static_cast<double>(moving.channel[k][i]);
        product += f * m;
        fixed2 += f * f;
        moving2 += m * m;
      }
    }
  }
  Fit fit;
  if (seen > 0.0) fit.overlap = shared / seen;
  if (fixed2 > 0.0 && moving2 > 0.0) fit.correlation = product / std::sqrt(fixed2 * moving2);
  return fit;
}

}  // namespace agricolmap::refine
