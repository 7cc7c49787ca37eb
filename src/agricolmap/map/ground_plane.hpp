// Planes through the low points of a cloud's cells: the ground where most cells show it, or the
// plane under a canopy that hides it from many.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace agricolmap::map {

using LevelPoints = std::vector<Eigen::Vector3d>;

/// One low point per cell of the horizontal lattice of side `cell` [m], cells in order of their
/// key: the point at `percentile` of the heights of cells with three points or more.
LevelPoints lowPoints(const LevelPoints& points, double cell, double percentile);

/// z − centre.z = a·(x − centre.x) + b·(y − centre.y) + c.
struct GroundPlane {
  Eigen::Vector3d slope_and_height = Eigen::Vector3d::Zero();  ///< a, b, c [1, 1, m]
  double deviation = 0.0;                                      ///< 1.48 MAD of all points [m]

  /// Height of `point` over the plane [m].
  double over(const Eigen::Vector3d& point, const Eigen::Vector3d& centre) const {
    const Eigen::Vector3d d = point - centre;
    return d.z() - slope_and_height.dot(Eigen::Vector3d(d.x(), d.y(), 1.0));
  }
  Eigen::Vector3d normal() const;
};

/// The plane that most points lie about, by iteratively reweighted least squares with Tukey's
/// weight. A faint pull of the slopes towards zero keeps a single row of cells from tilting freely
/// about itself.
GroundPlane fitPlane(const LevelPoints& points, const Eigen::Vector3d& centre, double cell);

/// The plane with many points close to it and few below it, which is what ground looks like where
/// a canopy hides it in most cells. `support` says how many: the points within centimetres of it
/// less those that lie clearly below. The plane's deviation is that of the points close to it, or
/// that of all below it where that is larger: no canopy is there, so they are relief.
struct SupportedPlane {
  GroundPlane plane;
  double support = 0.0;
  double share = 0.0;  ///< of the points that are close to it
};
SupportedPlane findPlaneUnder(const LevelPoints& points, const Eigen::Vector3d& centre,
                              double cell);

}  // namespace agricolmap::map
