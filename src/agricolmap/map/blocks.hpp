// Cutting the moving map into blocks along its own axes.
#pragma once

#include <array>
#include <vector>

#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::map {

/// The moving map's extent in a frame turned to its principal axes (strips lie in any direction).
struct StripFrame {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();       ///< middle of the extent [m]
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();     ///< columns: along, across
  Eigen::Vector2d half_extent = Eigen::Vector2d::Zero();  ///< [m], along ≥ across

  /// Coordinates along and across of a point [m].
  Eigen::Vector2d local(const Eigen::Vector2d& point) const {
    return axes.transpose() * (point - centre);
  }
  Eigen::Vector2d world(const Eigen::Vector2d& local_point) const {
    return centre + axes * local_point;
  }
  /// In the levelled frame [m]: both low, far along, far across, both high.
  std::array<Eigen::Vector2d, 4> corners() const {
    const Eigen::Vector2d& half = half_extent;
    return {world({-half.x(), -half.y()}), world({half.x(), -half.y()}),
            world({-half.x(), half.y()}), world({half.x(), half.y()})};
  }
};

/// Principal frame of the seen cells; the extents leave out the outermost 0.5 % each side.
StripFrame stripFrame(const SignalMap& map);

/// A rectangle of the strip frame.
struct Block {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();  ///< strip-frame coordinates [m]
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< levelled frame [m]
  double energy = 0.0;                               ///< sum of squared signal over its seen cells

  bool contains(const Eigen::Vector2d& local) const {
    return (local.array() >= low.array()).all() && (local.array() < high.array()).all();
  }
};

/// About square blocks of side near `side`, in order along the strip.
std::vector<Block> cutBlocks(const SignalMap& map, const StripFrame& strip, double side);

/// Axis-aligned bounds of a block in the levelled frame.
Eigen::AlignedBox2d boundsOf(const Block& block, const StripFrame& strip);

/// Part of a strip: blocks that lie one behind the other.
struct Stretch {
  std::vector<Block> blocks;
  Eigen::Vector2d half_extent = Eigen::Vector2d::Zero();  ///< along and across the strip [m]
};

/// The stretch of at most `length` [m] along the strip whose blocks hold the most, of one block
/// where these are longer; all of them, if the strip is not longer.
Stretch texturedStretch(const std::vector<Block>& blocks, const StripFrame& strip, double length);

}  // namespace agricolmap::map
