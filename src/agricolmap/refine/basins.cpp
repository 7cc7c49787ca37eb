#include "agricolmap/refine/basins.hpp"

#include <array>
#include <cmath>

namespace agricolmap::refine {
namespace {

// A basin's bottom is reached to some thousandths of the correlation.
constexpr double kGain = 0.002;
// The correlation counts shared cells only: it must not be bought by leaving the map.
constexpr double kLeastOverlap = 0.98;

/// The seen cells as a rectangle of the same spread: its axes, long one first, and half sides. Not
/// map::StripFrame, whose rectangle holds nearly all cells: of an L or a bow that is much larger.
struct Footprint {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();
  Eigen::Array2d half = Eigen::Array2d::Zero();  ///< [m]
};

Footprint footprintOf(const map::SignalMap& map) {
  Footprint print;
  double count = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  const Eigen::Vector2d reference = map.frame.corner;
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      if (map.weight(r, c) <= 0.0F) continue;
      const Eigen::Vector2d at = map.frame.centre(r, c) - reference;
      count += 1.0;
      sum += at;
      products += at * at.transpose();
    }
  }
  if (count == 0.0) return print;
  const Eigen::Vector2d mean = sum / count;
  const Eigen::Matrix2d spread = products / count - mean * mean.transpose();
  print.middle = reference + mean;
  const double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
  print.axes << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  // The deviation of a uniform distribution is its half width over √3.
  const Eigen::Matrix2d along = print.axes.transpose() * spread * print.axes;
  print.half = (3.0 * along.diagonal().array().max(0.0)).sqrt();
  return print;
}

/// Moved along an axis, or stretched, turned and sheared so that the edges move by as much.
constexpr int kHops = 12;
Eigen::Affine2d hop(const Footprint& print, int number, double length) {
  const double step = number % 2 == 0 ? -length : length;
  const int kind = number / 2;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  Eigen::Matrix2d change = Eigen::Matrix2d::Zero();
  if (kind < 2) {
    shift = step * print.axes.col(kind);
  } else {
    const int col = (kind - 2) % 2;
    change((kind - 2) / 2, col) = step / std::max(print.half[col], length);
  }
  const Eigen::Matrix2d linear =
      Eigen::Matrix2d::Identity() + print.axes * change * print.axes.transpose();
  Eigen::Affine2d moved = Eigen::Affine2d::Identity();
  moved.linear() = linear;
  moved.translation() = print.middle - linear * print.middle + shift;
  return moved;
}

}  // namespace

DenseRefineResult refineAcrossBasins(const map::SignalMap& fixed, const map::SignalMap& moving,
                                     const Eigen::Affine2d& start,
                                     const DenseRefineOptions& options) {
  DenseRefineResult best = refineDense(fixed, moving, start, options);
  if (best.status != RefineStatus::kConverged) return best;
  const Footprint print = footprintOf(moving);
  const double length = options.hop * moving.frame.cell;
  for (int round = 0; round < options.hops; ++round) {
    std::array<Eigen::Affine2d, kHops> starts;
    for (int i = 0; i < kHops; ++i) {
      starts[static_cast<std::size_t>(i)] = best.fixed_from_moving * hop(print, i, length);
    }
    const double before = best.correlation;
    const double least_overlap = kLeastOverlap * best.overlap;
    for (const DenseRefineResult& one : refineEach(fixed, moving, starts, options)) {
      if (one.status != RefineStatus::kConverged || one.overlap < least_overlap) continue;
      if (one.correlation > best.correlation) best = one;
    }
    if (best.correlation < before + kGain) break;
  }
  return best;
}

}  // namespace agricolmap::refine
