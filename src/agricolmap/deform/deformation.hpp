// How a strip is bent: a displacement, on top of the affine, as a function of place.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "agricolmap/deform/path.hpp"
#include "agricolmap/deform/spline.hpp"

namespace agricolmap::deform {

/// A place where the odometry slipped: all that lies behind it is displaced against all before.
struct Slip {
  double along = 0.0;                                ///< path length [m]
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< fixed levelled frame [m]
  double deviation = 0.0;                            ///< of the offset, per axis [m]
  double place_deviation = 0.0;                      ///< of `along` [m]
};

/// A point of the moving map at (s along the path, t aside of it) is displaced by
///   d(s) − t · (n · d'(s)) · τ + Σ offsets of the slips before s,
/// d a spline in the fixed levelled frame, τ and n the directions of the path and to its left
/// there: where the robot's heading was wrong, the path runs aside, and what lies beside it turns.
class Deformation {
 public:
  /// `turn`: directions of the moving levelled frame → those of the fixed one (columns of unit
  /// length).
  Deformation(Path path, const Eigen::Matrix2d& turn, const SplineBasis& basis);

  /// Displacement of a point of the moving levelled frame, fixed levelled frame [m].
  Eigen::Vector3d at(const Eigen::Vector2d& moving) const;
  /// Covariance of its horizontal part, of the fit alone [m²].
  Eigen::Matrix2d covarianceAt(const Eigen::Vector2d& moving) const;
  /// On the path itself: displacement and its derivative along the path.
  Eigen::Vector3d onPath(double along) const;
  Eigen::Vector2d tangent(double along) const { return turn_ * path_.tangent(along); }

  const Path& path() const { return path_; }
  const Eigen::Matrix2d& turn() const { return turn_; }
  const SplineBasis& basis() const { return basis_; }

  /// Coefficients of d, one row each: x, y, z [m].
  Eigen::MatrixX3d coefficients;
  std::vector<Slip> slips;  ///< in order along the path
  /// Of the horizontal coefficients and the slips' offsets: x and y of the first, … [m²].
  Eigen::MatrixXd covariance;
  double height_deviation = 0.0;  ///< of the displacement's height against the whole's [m]

 private:
  Path path_;
  Eigen::Matrix2d turn_;
  SplineBasis basis_;
};

/// How far the parts before and behind a slip were pushed into one another along the path: for so
/// long both lie there in the file [m].
double overlapAt(const Deformation& deformation, const Slip& slip);

/// Root mean square over the strip of what points on the wrong side of a slip are off by [m]. Where
/// the parts were pushed into one another, as far as they overlap, half of what lies there is.
double slipRms(const Deformation& deformation);

}  // namespace agricolmap::deform
