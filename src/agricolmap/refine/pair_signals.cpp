#include "agricolmap/refine/pair_signals.hpp"

namespace agricolmap::refine {

PairSignals::PairSignals(const correlation::MapSignals& fixed,
                         const correlation::MapSignals& moving,
                         const map::HiddenGroundOptions& hidden,
                         const correlation::MatchedFilterOptions& filter)
    : fixed_(fixed),
      moving_(moving),
      filled_(map::withHiddenGround(moving.grid(), hidden)),
      filled_signals_(filled_, moving.options()),
      score_(fixed.at(kRankingFactor), moving.at(kRankingFactor),
             fixed.filter(kRankingFactor, filter)) {}

map::GridMap PairSignals::fixedUnder(const Eigen::Affine2d& pose, double rim) const {
  const GridFrame& frame = moving_.grid().frame;
  map::Box2 window;
  for (const double row : {-0.5, frame.rows - 0.5}) {
    for (const double col : {-0.5, frame.cols - 0.5}) window.extend(pose * frame.centre(row, col));
  }
  window.extend((window.min() - Eigen::Vector2d::Constant(rim)).eval());
  window.extend((window.max() + Eigen::Vector2d::Constant(rim)).eval());
  return map::croppedMap(fixed_.grid(), window);
}

map::SignalMap PairSignals::fixedSignals(const Eigen::Affine2d& pose, int factor) const {
  // Room for the high-pass, and for what a level may move the pose by.
  const double rim = 1.5 * fixed_.options().high_pass + 8.0 * factor * moving_.grid().frame.cell;
  return map::makeSignalMap(fixedUnder(pose, rim), factor, fixed_.options());
}

}  // namespace agricolmap::refine
