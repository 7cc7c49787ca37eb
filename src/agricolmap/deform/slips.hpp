// Where the odometry of a strip slipped.
#pragma once

#include <optional>
#include <vector>

#include "agricolmap/deform/bend_fit.hpp"

namespace agricolmap::deform {

/// How far a piece of the strip lies beside where the pose puts it: what a fit starts from.
struct PieceOffset {
  double along = 0.0;                                ///< middle of the piece, path length [m]
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< fixed levelled frame [m]
};

/// Between which neighbouring pieces, in order along the path, the offset jumps by more than drift
/// does: path lengths half way between them.
std::vector<double> jumpsBetween(const std::vector<PieceOffset>& pieces);

/// Coefficients of a model that run through the pieces, as stiff as `stiffness` says.
Eigen::VectorXd throughPieces(const BendModel& model, const std::vector<PieceOffset>& pieces,
                              double stiffness);

/// The slip that would explain most of what a fit leaves, if it explains more than chance does.
std::optional<double> furtherSlip(const StripBins& bins, const BendModel& model,
                                  const BendFit& fit);

/// Where each slip lies best, all else as it is: path lengths.
std::vector<double> placedSlips(const StripBins& bins, const BendModel& model,
                                const Eigen::VectorXd& coefficients, const refine::Noise& noise);

}  // namespace agricolmap::deform
