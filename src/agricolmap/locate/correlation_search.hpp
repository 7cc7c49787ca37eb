// A global search for the moving map: every heading and pair of scales that the initial guess
// leaves open, each over all shifts at once. Follows recipe E of the research notes, with the
// strip cut into blocks: a block tolerates coarse steps of heading and scale, so the expensive
// correlations are few; the fine hypotheses are looked at where the blocks together promise much.
#pragma once

#include "agricolmap/correlation/matched_filter.hpp"
#include "agricolmap/locate/association.hpp"
#include "agricolmap/locate/row_waves.hpp"

namespace agricolmap::locate {

struct CorrelationOptions {
  double cell = 0.12;      ///< cell of the search, rounded to whole grid cells [m]
  double tolerance = 0.5;  ///< RMS displacement that hypotheses may leave [cells]
  double block = 2.2;      ///< side of the blocks the moving map is cut into [m]
  /// Only headings and scales that lay the strongest waves of one map (rows, plants along them) on
  /// those of the other.
  bool rows_on_rows = true;
  int max_blocks = 10;        ///< of the most textured ones
  double max_work = 150.0;    ///< limit of cells times correlations [10⁶], else coarser cells
  double max_length = 12.0;   ///< longer strips are sought by their most textured stretch [m]
  int peaks = 16;             ///< places looked at more closely, per coarse hypothesis
  double min_inside = 0.3;    ///< least share of the blocks inside the fixed map
  int climbs = 64;            ///< placements of the lattice from which the score is climbed
  int candidates = 8;         ///< placements handed on
  double separation = 0.3;    ///< placements whose corners differ by less are one [m]
  map::SignalOptions signal;  ///< not listed: the whole chain has one
  correlation::MatchedFilterOptions filter;  ///< not listed: the evidence's, too
};
void listOptions(OptionTable& table, CorrelationOptions& options);

class CorrelationSearch : public Association {
 public:
  explicit CorrelationSearch(const CorrelationOptions& options);
  AssociationResult associate(const map::GridMap& fixed, const map::GridMap& moving,
                              const SearchSpace& space, StageTimes& times) const override;

 private:
  struct Setup;
  struct RowWaves {
    std::vector<Wave> moving;
    std::vector<Wave> fixed;
  };
  Setup setUp(const map::GridMap& fixed, const map::GridMap& moving, const SearchSpace& space,
              const RowWaves& waves, double cell) const;
  AssociationResult search(const map::GridMap& fixed, const map::GridMap& moving,
                           const SearchSpace& space) const;

  CorrelationOptions options_;
};

}  // namespace agricolmap::locate
