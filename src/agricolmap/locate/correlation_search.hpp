// A global search for the moving map: every heading and pair of scales that the initial guess
// leaves open, each over all shifts at once. The strip is cut into blocks: a block tolerates coarse
// steps of heading and scale, so the expensive correlations are few; the fine hypotheses are looked
// at where the blocks together promise much.
#pragma once

#include <optional>
#include <vector>

#include "agricolmap/core/placement.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/correlation/map_signals.hpp"
#include "agricolmap/locate/row_waves.hpp"

namespace agricolmap::locate {

struct CorrelationOptions {
  double cell = 0.12;      ///< cell of the search, rounded to whole grid cells [m]
  double tolerance = 0.5;  ///< RMS displacement that hypotheses may leave [cells]
  double block = 2.2;      ///< side of the blocks the moving map is cut into [m]
  /// Only headings and scales that lay the strongest waves of one map (rows, plants along them) on
  /// those of the other.
  bool rows_on_rows = true;
  int max_blocks = 10;       ///< of the most textured ones
  double max_work = 150.0;   ///< limit of cells times correlations [10⁶], else coarser cells
  double max_length = 12.0;  ///< longer strips are sought by their most textured stretch [m]
  int peaks = 16;            ///< places looked at more closely, per coarse hypothesis
  double min_inside = 0.3;   ///< least share of the blocks inside the fixed map
  int climbs = 64;           ///< placements of the lattice from which the score is climbed
  int candidates = 8;        ///< placements handed on
  double separation = 0.3;   ///< placements whose corners differ by less are one [m]
  correlation::MatchedFilterOptions filter;  ///< not listed: the registration has one
  /// Only this share of the coarse headings and scales, spread evenly, is looked at, and no fewer
  /// than a dozen. Not listed: 1 but for decoys.
  double share = 1.0;
};
void listOptions(OptionTable& table, CorrelationOptions& options);

/// What a search was, for the report.
struct SearchReport {
  std::size_t hypotheses = 0;    ///< headings and scales that were looked at
  std::size_t correlations = 0;  ///< of a block with the whole fixed map
  std::size_t blocks = 0;        ///< of the moving map, that took part
  bool rows_on_rows = false;     ///< only headings and scales that lay rows on rows were tried
  double cell = 0.0;             ///< [m]
  double work = 0.0;             ///< cells of the fixed map times correlations [10⁶]
  bool too_much_work = false;    ///< more than the limit, even at the coarsest cells there may be
};

struct SearchResult {
  std::vector<Placement> placements;  ///< best first, of no matches; empty when nothing was found
  SearchReport report;
};

/// The strongest waves (rows, plants along them) of both maps.
struct RowWaves {
  std::vector<Wave> fixed;
  std::vector<Wave> moving;
};
RowWaves rowWaves(const correlation::MapSignals& fixed, const correlation::MapSignals& moving);

/// `waves`: of the maps. Deterministic, whatever the number of threads.
SearchResult searchByCorrelation(const correlation::MapSignals& fixed,
                                 const correlation::MapSignals& moving, const RowWaves& waves,
                                 const SearchSpace& space, const CorrelationOptions& options);

/// Reflections (see SearchSpace::mirror) that make decoys of the moving map: across its rows, or
/// across the strip where it shows none, and along them. A decoy has the pair's own rows, plants,
/// colours and growth, and no right place: it tells how high a wrong one scores. One of them is
/// enough where `space` allows any heading: the other is the same turned end for end.
std::vector<Eigen::Matrix2d> decoyMirrors(const correlation::MapSignals& moving,
                                          const RowWaves& waves, const SearchSpace& space);

/// The options of the `attempt`-th search, from 0: a search that was not accepted is followed by
/// finer and freer ones. Nothing when there is none left, or when it would find nothing new after
/// one that was like `before`, where there was one.
std::optional<CorrelationOptions> optionsOfAttempt(const CorrelationOptions& options,
                                                   std::size_t attempt,
                                                   const std::optional<SearchReport>& before);
inline constexpr std::size_t kMostAttempts = 3;

}  // namespace agricolmap::locate
