// The way that the robot drove, as a line over the ground: what a deformation is a function of.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/map/blocks.hpp"

namespace agricolmap::deform {

/// Where a point lies by a path.
struct PathPlace {
  double along = 0.0;  ///< path length of its foot; below 0 or beyond the length before and behind
                       ///< the path, which goes straight on there [m]
  double aside = 0.0;  ///< how far to the left of the path [m]
  Eigen::Vector2d tangent = Eigen::Vector2d::UnitX();  ///< of the path there, unit length
};

/// A polyline with its arc length, in the levelled frame of the moving map.
class Path {
 public:
  /// Corners in the order of driving; those that repeat the one before are left out. Throws
  /// UsageError when fewer than two are left.
  explicit Path(const std::vector<Eigen::Vector2d>& corners);

  double length() const { return ends_.back(); }  ///< [m]
  bool straight() const { return corners_.size() == 2; }
  const std::vector<Eigen::Vector2d>& corners() const { return corners_; }
  const std::vector<double>& ends() const { return ends_; }  ///< path length at each corner [m]
  /// By the nearest piece of the path; of equally near ones the first.
  PathPlace place(const Eigen::Vector2d& point) const;
  /// The point at `along`, `aside` to the left of it.
  Eigen::Vector2d point(double along, double aside = 0.0) const;
  Eigen::Vector2d tangent(double along) const { return directions_[pieceAt(along)]; }

 private:
  std::size_t pieceAt(double along) const;

  std::vector<Eigen::Vector2d> corners_;
  std::vector<Eigen::Vector2d> directions_;  ///< of the piece behind each corner but the last
  std::vector<double> ends_;                 ///< see ends()
};

/// From `from` to `to` along the path, which goes straight on before 0 and behind its length [m].
/// Throws UsageError when nothing is left.
Path stretchOf(const Path& path, double from, double to);

/// Of a strip whose path nothing tells: straight through its middle, from end to end.
Path straightPath(const map::StripFrame& strip);

}  // namespace agricolmap::deform
