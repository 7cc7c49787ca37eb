// Stage deform: what the paper's assumption 4 allows for. A strip that drift has bent, or of which
// a part has slipped, is followed by a smooth displacement along its path, on top of the affine.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/deform/deformation.hpp"
#include "agricolmap/deform/slips.hpp"
#include "agricolmap/refine/pair_signals.hpp"
#include "agricolmap/refine/vertical.hpp"

namespace agricolmap::deform {

struct BendOptions {
  double node = 1.25;           ///< distance of the spline's nodes [m]
  double min_gain = 2.5;        ///< by which left-out blocks must confirm it [standard errors]
  double min_evidence = 100.0;  ///< or by which log-likelihood ratio
  double min_rise = 0.008;  ///< height drift that is followed: less may be the drone map's own [m]
};
void listOptions(OptionTable& table, BendOptions& options);

struct Bend {
  Deformation deformation;
  /// The best affine of the bent strip, levelled moving → levelled fixed frame: the deformation has
  /// no shift, turn or stretch of its own on top of it.
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  double gain = 0.0;      ///< by which blocks that were left out confirm it [standard errors]
  double evidence = 0.0;  ///< and as a log-likelihood ratio
  double rms = 0.0;       ///< of the displacement in the plane, over the seen cells [m]
  double most = 0.0;      ///< the largest one on the path [m]
};

/// Nothing where the blocks do not confirm it, or no map tells. `pose` and `heights`: of the
/// registration without it; `path`: along which the strip bends, levelled moving frame; `pieces`:
/// where pieces along it lie beside `pose`, if any do.
std::optional<Bend> followBend(const refine::PairSignals& signals, const Eigen::Affine2d& pose,
                               const refine::VerticalResult& heights, const Path& path,
                               const std::vector<PieceOffset>& pieces, const BendOptions& options);

/// The spline, nodes `node` [m] apart, of what takes points of the path elsewhere: `laid`, moving
/// levelled frame → itself, to come before `pose`. `deviation`: of the places that it goes through,
/// per axis [m].
Bend bendThrough(const Path& path, const Eigen::Affine2d& pose, double node, double deviation,
                 const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& laid);

/// What the longest stretch between slips is moved by, as the nearest affine over its seen cells:
/// moving levelled frame → itself, to come before `pose`. A guess holds of a part of the strip
/// rather than of `pose`, which slips turn and stretch. No slips: nothing, the identity.
Eigen::Affine2d moveOfLongestStretch(const map::SignalMap& moving, const Bend& bend);

/// How far it bends and where it slipped, in plain words.
std::string describe(const Bend& bend);

/// The moving map as it would be if the strip were not bent: `pose` alone lays it then.
map::GridMap straightened(const map::GridMap& moving, const Bend& bend);

/// Where the deformation puts a point of the moving levelled frame, before the affine [m].
Eigen::Vector3d unbent(const Eigen::Vector3d& moving, const Deformation& deformation,
                       const Eigen::Affine2d& pose);

}  // namespace agricolmap::deform
