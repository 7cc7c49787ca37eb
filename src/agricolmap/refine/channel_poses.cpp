#include "agricolmap/refine/channel_poses.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::refine {
namespace {

/// What a channel tells of the pose where signal and noise correlate so.
double weightOf(double correlation) {
  const double square = std::min(0.99, std::max(0.0, correlation) * std::max(0.0, correlation));
  return square / (1.0 - square);
}

}  // namespace

std::optional<double> disagreementOfChannels(const map::SignalMap& fixed,
                                             const map::SignalMap& moving,
                                             const Eigen::Affine2d& pose,
                                             const DenseRefineOptions& options) {
  constexpr ChannelSet kBright = channelSet(map::kLuminanceChannel);
  const DenseRefineResult plants =
      refineDense(fixed, moving, pose, options, kAllChannels & ~kBright);
  const DenseRefineResult bright = refineDense(fixed, moving, pose, options, kBright);
  if (plants.status != RefineStatus::kConverged || bright.status != RefineStatus::kConverged) {
    return std::nullopt;
  }
  double sum2 = 0.0, count = 0.0;
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      if (moving.weight(r, c) <= 0.0F) continue;
      const Eigen::Vector2d p = moving.frame.centre(r, c);
      sum2 += (plants.fixed_from_moving * p - bright.fixed_from_moving * p).squaredNorm();
      count += 1.0;
    }
  }
  const double of_plants = weightOf(plants.correlation), of_bright = weightOf(bright.correlation);
  const double both = of_plants + of_bright;
  if (both <= 0.0 || count == 0.0) return std::nullopt;
  return std::sqrt(of_plants * of_bright * sum2 / count) / both;
}

}  // namespace agricolmap::refine
