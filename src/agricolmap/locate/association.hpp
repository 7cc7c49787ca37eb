// Stage 4: data association, one interface with several implementations: the paper's flow and vote
// (`flow_association.hpp`) and a global search by correlation (`correlate/`).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/core/options.hpp"
#include "agricolmap/core/stopwatch.hpp"

namespace agricolmap::locate {

/// A translation error of this size [m] means: anywhere in the fixed map.
inline constexpr double kAnywhere = 1e6;

/// How wrong the initial guess may be (defaults: the paper's, Sec. V-A). Limits, not deviations.
struct PriorUncertainty {
  /// No guess at all: any position and heading; scales within the default.
  static PriorUncertainty none();
  bool anywhere() const { return translation >= kAnywhere; }

  double translation = 5.0;    ///< horizontal, at the moving map's centre [m]
  double heading_deg = 11.5;   ///< [°]
  double scale = 0.30;         ///< of each horizontal axis, relative (0.30: 0.7–1.3)
  bool scale_unknown = false;  ///< and of all three axes together, by a factor from 0.1 to 10
};
void describe(OptionTable& table, PriorUncertainty& options);

/// Half-width of the interval of log-scales: a file whose axis is off by a factor of 1 ± scale
/// needs a correction between 1/(1 + scale) and 1/(1 − scale); ±log 1/(1 − scale) covers both
/// readings.
double logScaleLimit(const PriorUncertainty& uncertainty);

/// What an association knows beside the two maps. The moving map is gridded with the initial guess
/// applied: where the guess is right, the flow is zero.
struct SearchSpace {
  PriorUncertainty uncertainty;
  /// Directions of the moving file's x and y axes in the levelled frame (columns, unit length):
  /// directional scale errors act along them.
  Eigen::Matrix2d scale_axes = Eigen::Matrix2d::Identity();
  /// Point of the moving map that `translation` is about [m].
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
};

/// A point of the moving map and where it lies in the fixed map, levelled frames [m].
struct Match {
  Eigen::Vector2d moving;
  Eigen::Vector2d fixed;
};

/// One hypothesis of where the moving map lies.
struct Placement {
  std::vector<Match> matches;  ///< coherent pairs: what the affine is estimated from
  double score = 0.0;          ///< of its own association; larger is better, comparable within one
};

struct AssociationResult {
  std::vector<Placement> placements;  ///< best first; empty when nothing coherent was found
  std::vector<Match> all_matches;     ///< before the vote, for pictures; may be empty
  /// Before the vote, of a second matching from what the first found; empty when there was none.
  std::vector<Match> all_rematches;
  /// Counts for the report, e.g. {"seeds", 6012}, {"matches", 3450}, {"inliers", 3001}.
  std::vector<std::pair<std::string, double>> counts;
};

class Association {
 public:
  virtual ~Association() = default;
  /// Deterministic for a given seed of its options, whatever the number of threads.
  virtual AssociationResult associate(const map::GridMap& fixed, const map::GridMap& moving,
                                      const SearchSpace& space, StageTimes& times) const = 0;
};

}  // namespace agricolmap::locate
