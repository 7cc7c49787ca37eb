// How a strip is bent in the plane: spline and slips by Gauss–Newton on the maps, as stiff as
// blocks that were left out of the fit would have it, and only if these confirm it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/deform/bend_model.hpp"

namespace agricolmap::deform {

struct BendFit {
  Eigen::VectorXd coefficients;  ///< see BendModel
  Eigen::MatrixXd covariance;    ///< of these
  double stiffness = 0.0;        ///< factor on BendModel::bending, in units of the data's noise
  double noise = 1.0;            ///< how much more blocks differ than their cells' noise says: χ²
  /// Robust cost that left-out blocks are spared by the bend, over its standard error.
  double gain = 0.0;
  /// The same as a log-likelihood ratio, by how much more blocks differ than their cells' noise
  /// says.
  double evidence = 0.0;
  refine::Noise residual;  ///< gains and deviations at the end
};

/// One level: from `start` with a given stiffness; changes `noise` to what is left.
Eigen::VectorXd bendTo(const StripBins& bins, const BendModel& model, Eigen::VectorXd start,
                       double stiffness, refine::Noise& noise);

/// The finest level: stiffness, noise, confirmation.
BendFit fitBend(const StripBins& bins, const BendModel& model, const Eigen::VectorXd& start);

}  // namespace agricolmap::deform
