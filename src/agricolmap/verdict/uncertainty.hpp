// How accurate a registration is, if it is right: the covariance of its horizontal parameters from
// how much the blocks of the strip disagree with it and with one another.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/map/signal_map.hpp"
#include "agricolmap/verdict/evidence.hpp"

namespace agricolmap::verdict {

/// All from calibration.
struct UncertaintyOptions {
  double inflation = 1.0;  ///< factor on deviations that the blocks' disagreement gives
  /// Displacement that is left when the blocks agree to a hair, because all are wrong alike: a
  /// camera low above the ground and one high above see a leaf in different places [m].
  double floor = 0.003;
  /// And by so much of the plants' height, for wind leans all of them one way [m/m].
  double lean = 0.02;
  double height_inflation = 1.2;  ///< factor on the deviation of the ground's heights
  double height_floor = 0.01;     ///< deviation of the height that is left without any [m]
};
void listOptions(OptionTable& table, UncertaintyOptions& options);

/// Errors of a pose move a point at q (fixed levelled frame, from `centre`) by
///   (δx, δy) + δψ·(−q_y, q_x) + δa·u(u·q) + δb·v(v·q)
/// with u, v the directions of the moving file's axes in the fixed frame.
struct PoseUncertainty {
  /// Of (δx, δy [m], heading δψ [rad], relative scales δa, δb).
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();    ///< fixed levelled frame [m]
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();  ///< columns: u, v
  double height_deviation = 0.0;                       ///< of the height, apart from the rest [m]
  /// Expected horizontal RMS error over the strip, that beyond the fixed map included [m].
  double expected_rms = 0.0;
  /// Share of that which all blocks may have in common, because what the maps show of plants and of
  /// soil contradict one another, and for wind leans all plants one way [m].
  double systematic_rms = 0.0;
  double scatter_rms = 0.0;  ///< what the blocks differ by after the best affine [m]
  /// What neighbours among them share of that, at most: drift, a bend, which no affine undoes. The
  /// rest each block has of its own: leaves, shadows, noise [m].
  double local_rms = 0.0;

  /// With the height among the shifts: of (δx, δy, δz [m], δψ [rad], δa, δb), along the axes of a
  /// frame against which the levelled one is turned by `turn` [rad].
  Eigen::Matrix<double, 6, 6> covarianceWithHeight(double turn = 0.0) const;
  /// Derivative of a point's displacement to the five parameters.
  Eigen::Matrix<double, 2, 5> jacobian(const Eigen::Vector2d& fixed) const;
  /// Covariance of a point's horizontal position [m²].
  Eigen::Matrix2d at(const Eigen::Vector2d& fixed) const {
    const Eigen::Matrix<double, 2, 5> j = jacobian(fixed);
    return j * covariance * j.transpose();
  }
};

/// What a bend of this root mean square [m] may be wrong by [m]. One that lays the blocks straight,
/// by little; one that leaves them nearly as far apart as they were follows what plants did between
/// the views as well as the path, and is as doubtful as it is large.
double doubtOfBend(double rms, const PoseUncertainty& bent, const PoseUncertainty& straight);

/// Covariance of a place of a strip whose bend is followed [m²]: what the fit of the bend says of
/// it, and what all blocks may have in common.
Eigen::Matrix2d placeCovariance(const PoseUncertainty& pose, const Eigen::Matrix2d& of_fit);

/// Nothing when too few blocks can be compared. `fixed`, `moving`: of the same cell size, fine
/// enough for centimetres. `systematic`: error that all blocks may have in common,
/// `height_deviation`: what is stated of the height [m].
std::optional<PoseUncertainty> estimateUncertainty(
    const map::SignalMap& fixed, const map::SignalMap& moving, const Eigen::Affine2d& pose,
    const Evidence& evidence, const SearchSpace& space, double systematic, double height_deviation,
    const UncertaintyOptions& options);

}  // namespace agricolmap::verdict
