// The method as a whole. Sections are those of the paper; what has none is ours.
#include "agricolmap/pipeline/registration.hpp"

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/pipeline/along_path.hpp"
#include "agricolmap/pipeline/any_scale.hpp"
#include "agricolmap/pipeline/attempts.hpp"
#include "agricolmap/pipeline/compose.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/pipeline/place.hpp"
#include "agricolmap/pipeline/usable.hpp"
#include "agricolmap/verdict/remedies.hpp"

namespace agricolmap::pipeline {

refine::PairSignals signalsOf(const correlation::MapSignals& fixed,
                              const correlation::MapSignals& moving,
                              const RegistrationOptions& options, Monitor& monitor) {
  return monitor.run(Stage::kSignals, [&] {
    return refine::PairSignals(fixed, moving, options.hidden, options.filter);
  });
}

Outcome settle(const PairMaps& maps, const refine::PairSignals& signals, Located located,
               std::optional<std::vector<refine::RefinedPose>> rivals,
               const RegistrationOptions& options, Monitor& monitor) {
  Outcome outcome;
  Refined refined = monitor.run(Stage::kRefine, [&] {
    return refinePlacements(signals, located.placements, maps.space.scale_axes, options);
  });
  refined.decoys = located.decoys;
  outcome.trace = {.attempts = 1,
                   .located = std::move(located),
                   .held = refined.held,
                   .cpd = refined.cpd,
                   .straightened = {},
                   .pieces = {}};
  if (!refined.best) {
    outcome.verdict = verdict::rejectBecause(refined.failure);
    outcome.verdict.remedies = verdict::remediesForNothing(maps.space);
    return outcome;
  }
  if (rivals) refined.rivals = *std::move(rivals);
  Measured measured = measureStraightened(signals, maps.space, refined, options, monitor);
  outcome.trace.straightened = measured.straightened;
  followBends(signals, maps.space, maps.path, refined, options, monitor, measured.placed);
  outcome.rivals = std::move(refined.rivals);
  outcome.verdict = judgePlaced(measured.placed, outcome.rivals, maps, options);
  outcome.placed = std::move(measured.placed);
  return outcome;
}

Outcome place(const PairMaps& maps, const correlation::MapSignals& fixed, std::size_t most,
              const RegistrationOptions& options, const Locator& locator, Monitor& monitor) {
  const correlation::MapSignals moving(maps.moving, options.signal);
  const refine::PairSignals signals = signalsOf(fixed, moving, options, monitor);
  const locate::RowWaves waves =
      monitor.run(Stage::kSignals, [&] { return locate::rowWaves(fixed, moving); });
  Outcome best;
  std::optional<locate::SearchReport> last;
  for (std::size_t attempt = 0; attempt < most; ++attempt) {
    const auto search = locate::optionsOfAttempt(options.search, attempt, last);
    if (!search) break;
    Located located = locate(maps, signals, waves, *search, options, locator, monitor);
    last = located.search;
    Outcome next = settle(maps, signals, std::move(located), {}, options, monitor);
    if (attempt == 0 || supersedes(next, best, options.verdict.rival)) best = std::move(next);
    best.trace.attempts = attempt + 1;
    // Other ways to locate have no finer search, and of a strip in parts it would find no more.
    const bool apart = best.placed && best.placed->evidence.parts.apart();
    if (best.verdict.status == verdict::Status::kAccepted || apart || !last) break;
  }
  return best;
}

Registration registerClouds(const FixedCloud& fixed, const Cloud& moving,
                            const Eigen::Affine3d& guess, const RegistrationOptions& chosen,
                            Monitor& monitor, const Locator& locator,
                            const std::vector<Eigen::Vector3d>& path) {
  const StopScope scope(monitor.stop());
  const RegistrationOptions options = resolved(chosen);
  requireUsable(fixed.facts(), factsOf(moving), options, locator != nullptr);
  PairMaps maps = mapPair(fixed, moving, guess, options, monitor);
  if (options.prior.scale_unknown && !path.empty()) {
    monitor.warn(
        "the path makes no difference: at an unknown scale the strip is placed as a whole");
  }
  auto [outcome, scale] =
      options.prior.scale_unknown
          ? placeAtAnyScale(fixed, moving, guess, options, locator, monitor, maps)
          : std::pair(placeAlongPath(moving, path, options, locator, monitor, maps), 1.0);
  // At an unknown scale there was no moving map before.
  warnOfFlat(maps.fixed, maps.moving, options.signal, monitor);
  // Only now: a search that found the place need not look for another one.
  if (options.require_heights) verdict::requireHeights(outcome.verdict);
  return monitor.run(Stage::kCompose, [&] {
    return compose(fixed.facts(), moving, std::move(maps), std::move(outcome), scale, options);
  });
}

Registration registerClouds(const PointStream& fixed, const Cloud& moving,
                            const Eigen::Affine3d& guess, const RegistrationOptions& options,
                            Monitor& monitor, const Locator& locator,
                            const std::vector<Eigen::Vector3d>& path) {
  return registerClouds(FixedCloud(fixed), moving, guess, options, monitor, locator, path);
}

Registration registerClouds(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                            const RegistrationOptions& options, Monitor& monitor,
                            const Locator& locator, const std::vector<Eigen::Vector3d>& path) {
  return registerClouds(CloudStream(fixed), moving, guess, options, monitor, locator, path);
}

}  // namespace agricolmap::pipeline
