#include "agricolmap/pipeline/located.hpp"

#include <algorithm>

#include "agricolmap/pipeline/usable.hpp"
#include "agricolmap/refine/multi_start.hpp"

namespace agricolmap::pipeline {
namespace {

/// Of a decoy's search only how high the best place scores is of use, and the highest of a few
/// hundred thousand scores is not much lower than that of ten times as many.
constexpr double kDecoyShare = 0.125;
constexpr int kDecoyClimbs = 24;
constexpr int kDecoyCandidates = 6;
/// Decoys are looked for this far about the guess at least [m]: among few places the highest score
/// is a matter of luck.
constexpr double kDecoyReach = 2.0;
/// A place of this score needs no decoys, which reach about five and hardly ever eight.
constexpr double kClearScore = 14.0;

/// How well mirrored copies of the moving map fit where they fit best.
std::vector<double> fitOfDecoys(const PairMaps& maps, const refine::PairSignals& signals,
                                const locate::CorrelationOptions& chosen,
                                const locate::RowWaves& waves, const RegistrationOptions& options) {
  locate::CorrelationOptions search;
  if (options.association == AssociationKind::kCorrelation) search = chosen;
  search.filter = options.filter;
  const refine::DenseRefineOptions dense = denseInForce(options);
  search.share = kDecoyShare;
  search.climbs = kDecoyClimbs;
  search.candidates = kDecoyCandidates;
  std::vector<double> significances;
  for (const Eigen::Matrix2d& mirror : locate::decoyMirrors(signals.moving(), waves, maps.space)) {
    SearchSpace space = maps.space;
    space.mirror = mirror;
    space.uncertainty.translation = std::max(space.uncertainty.translation, kDecoyReach);
    const locate::SearchResult found =
        locate::searchByCorrelation(signals.fixed(), signals.moving(), waves, space, search);
    std::vector<Eigen::Affine2d> starts;
    for (const Placement& placement : found.placements) starts.push_back(placement.pose);
    const refine::RankedPoses ranked =
        refine::refineStarts(signals, starts, options.evidence.exclusion, dense);
    double highest = ranked.distinct.empty() ? 0.0 : ranked.distinct.front().significance;
    for (const Eigen::Affine2d& start : starts) {
      highest = std::max(highest, signals.score().significance(start));
    }
    significances.push_back(highest);
  }
  return significances;
}

Located locatePlaces(const PairMaps& maps, const refine::PairSignals& signals,
                     const locate::RowWaves& waves, const locate::CorrelationOptions& search,
                     const RegistrationOptions& options, const Locator& locator, Monitor& monitor) {
  if (locator) return locator(maps.fixed, maps.moving, maps.space, monitor);
  if (options.association == AssociationKind::kFlow) {
    paper::FlowResult found =
        paper::associateByFlow(maps.fixed, maps.moving, maps.space, options.flow, monitor);
    return {std::move(found.placements),
            std::move(found.matches),
            std::move(found.rematches),
            {},
            found.report,
            {}};
  }
  locate::SearchResult found =
      locate::searchByCorrelation(signals.fixed(), signals.moving(), waves, maps.space, search);
  if (found.report.too_much_work) monitor.warn(workExceeded(found.report, search));
  return {std::move(found.placements), {}, {}, found.report, {}, {}};
}

}  // namespace

Located locate(const PairMaps& maps, const refine::PairSignals& signals,
               const locate::RowWaves& waves, const locate::CorrelationOptions& search,
               const RegistrationOptions& options, const Locator& locator, Monitor& monitor) {
  return monitor.run(Stage::kLocate, [&] {
    Located located = locatePlaces(maps, signals, waves, search, options, locator, monitor);
    const bool clear = located.search && !located.placements.empty() &&
                       located.placements.front().score >= kClearScore;
    if (!located.placements.empty() && !clear) {
      located.decoys = fitOfDecoys(maps, signals, search, waves, options);
    }
    return located;
  });
}

}  // namespace agricolmap::pipeline
