// From placements to one pose, as the options say: by the dense refinement, or as in the paper.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/placement.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/refine/multi_start.hpp"

namespace agricolmap::pipeline {

/// What Coherent Point Drift had and did, for the report.
struct CpdReport {
  std::size_t fixed_points = 0;  ///< of vegetation
  std::size_t moving_points = 0;
  std::size_t iterations = 0;
  double matched_share = 0.0;
};

/// The winner, or why there is none.
struct Refined {
  std::optional<refine::RefinedPose> best;
  /// Other places that held when refined to the ranking level, most significant first.
  std::vector<refine::RefinedPose> rivals;
  std::vector<double> decoys;  ///< see Located
  std::size_t held = 0;        ///< placements that did, whether distinct or not
  std::optional<CpdReport> cpd;
  std::string failure;  ///< in plain words when there is no winner
};

/// Refines densely, all placements through the coarse levels and the most significant one to the
/// finest; or, as in the paper (Sec. IV), the placement with most votes by CPD on the vegetation
/// points. Placements with matches start from the affine of these (Eq. 3).
Refined refinePlacements(const refine::PairSignals& signals,
                         const std::vector<Placement>& placements,
                         const Eigen::Matrix2d& scale_axes, const RegistrationOptions& options);

}  // namespace agricolmap::pipeline
