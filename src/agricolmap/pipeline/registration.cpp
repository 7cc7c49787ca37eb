// The method as a whole. Sections are those of the paper; what has none is ours.
#include "agricolmap/pipeline/registration.hpp"

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/pipeline/attempts.hpp"
#include "agricolmap/pipeline/compose.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/pipeline/long_strip.hpp"
#include "agricolmap/pipeline/unknown_scale.hpp"
#include "agricolmap/pipeline/usable.hpp"
#include "agricolmap/verdict/remedies.hpp"

namespace agricolmap::pipeline {
namespace {

/// Of rival places of a long strip's piece, so many are followed.
constexpr std::size_t kMostFollowed = 3;

refine::PairSignals signalsOf(const correlation::MapSignals& fixed,
                              const correlation::MapSignals& moving,
                              const RegistrationOptions& options, Monitor& monitor) {
  return monitor.run(Stage::kSignals, [&] {
    return refine::PairSignals(fixed, moving, options.hidden, options.filter);
  });
}

/// From placements to an answer: refine (Eq. 3 and Sec. IV, or densely), heights, verdict.
/// `rivals`: other places that are known already; nothing: those that hold when refined.
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
  followBends(signals, maps.space, refined, options, monitor, measured.placed);
  outcome.rivals = std::move(refined.rivals);
  outcome.verdict = judgePlaced(measured.placed, outcome.rivals, maps.space, options);
  outcome.placed = std::move(measured.placed);
  return outcome;
}

/// Locates and settles, and searches anew, more finely and freely, what is not accepted.
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

/// The piece of a long strip that is found first, and by what.
struct Anchor {
  double along = 0.0;  ///< its middle, on the path [m]
  Outcome outcome;
};

/// One telling piece after the other as if it were all there is, until one is accepted; of several
/// that were not, the best. Nothing when the guess lays all of them beside the fixed map.
std::optional<Anchor> placeAnchor(const PairMaps& maps, const deform::Path& path,
                                  const map::SignalMap& moving, const RegistrationOptions& options,
                                  Monitor& monitor) {
  std::optional<Anchor> best;
  // A piece is short: what bends it is not worth the time here.
  RegistrationOptions stiff = options;
  stiff.deform = DeformKind::kNone;
  for (const double along : anchorsOf(path, moving, options)) {
    const std::optional<PairMaps> piece = mapsOfPiece(maps, path, along, options);
    if (!piece) continue;
    const correlation::MapSignals fixed(piece->fixed, options.signal);
    Outcome next = place(*piece, fixed, locate::kMostAttempts, stiff, {}, monitor);
    if (!best || better(next, best->outcome)) best = Anchor{along, std::move(next)};
    if (best->outcome.verdict.status == verdict::Status::kAccepted) break;
  }
  return best;
}

/// A long strip: by one of its pieces, from there to both its ends, and then, laid straight by all
/// of them, as a whole. Nothing when no piece leads anywhere.
std::optional<Outcome> placeByPieces(const Cloud& moving, const deform::Path& path,
                                     const RegistrationOptions& options, Monitor& monitor,
                                     PairMaps& maps) {
  const correlation::MapSignals crooked(maps.moving, options.signal);
  std::optional<Anchor> anchor =
      placeAnchor(maps, path, crooked.at(refine::kRankingFactor), options, monitor);
  if (!anchor || !anchor->outcome.placed) return std::nullopt;
  std::vector<Eigen::Affine2d> poses = {anchor->outcome.placed->pose};
  for (const refine::RefinedPose& rival : anchor->outcome.rivals) poses.push_back(rival.pose);
  poses.resize(std::min(poses.size(), kMostFollowed));
  maps.fixed = fixedAlong(maps, path, anchor->along, poses.front(), options);
  const correlation::MapSignals fixed(maps.fixed, options.signal);
  const refine::PairSignals signals = signalsOf(fixed, crooked, options, monitor);
  std::vector<FollowedPieces> followed = monitor.run(
      Stage::kLocate, [&] { return followFrom(poses, signals, path, anchor->along, options); });
  if (followed.empty()) return std::nullopt;
  const FollowedPieces& best = followed.front();
  // What is not to be followed is not laid straight either.
  const bool bends = options.deform == DeformKind::kPath;
  const map::GridMap straight_map =
      bends ? straightMap(moving, best.joined->bend, maps, monitor) : maps.moving;
  const correlation::MapSignals straight(straight_map, options.signal);
  const refine::PairSignals laid = signalsOf(fixed, straight, options, monitor);
  Located located;
  located.search = anchor->outcome.trace.located.search;
  located.placements = {{best.joined->pose, best.significance, {}}};
  std::vector<refine::RefinedPose> rivals;
  for (std::size_t i = 1; i < followed.size(); ++i) {
    rivals.push_back({followed[i].joined->pose, followed[i].significance, 0.0, i, 0});
  }
  // Every piece was found by itself: there is no other basin to look into.
  RegistrationOptions sure = options;
  sure.dense.hops = 0;
  Outcome outcome = settle(maps, laid, std::move(located), std::move(rivals), sure, monitor);
  outcome.trace.attempts = anchor->outcome.trace.attempts;
  outcome.trace.pieces = best.chain;
  if (bends && outcome.placed) {
    followPieces(best, path, straight_map, options, *outcome.placed);
    outcome.verdict.reasons.push_back(describe(best));
  }
  if (const auto lost = lostEnd(best, path, fixed.at(refine::kRankingFactor))) {
    outcome.verdict = verdict::rejectBecause(lost->words);
  }
  return outcome;
}

/// By pieces where the strip is long and its path is known, else as a whole.
Outcome placeAlongPath(const Cloud& moving, const std::vector<Eigen::Vector3d>& places,
                       const RegistrationOptions& options, const Locator& locator, Monitor& monitor,
                       PairMaps& maps) {
  if (!locator) {
    const auto path = monitor.run(Stage::kSignals,
                                  [&] { return pathOf(moving, places, maps, options, monitor); });
    if (path) {
      auto outcome = placeByPieces(moving, *path, options, monitor, maps);
      if (outcome) return *std::move(outcome);
    }
  }
  return place(maps, correlation::MapSignals(maps.fixed, options.signal), locate::kMostAttempts,
               options, locator, monitor);
}

/// At a scale that is not known: one search at each factor that the moving file may be off by, then
/// anew from what the best of them found, with heights at the right scale and cells of the right
/// size. `maps` are left as at that scale, which is returned, too.
std::pair<Outcome, double> placeAtAnyScale(const Cloud& fixed, const Cloud& moving,
                                           const Eigen::Affine3d& guess,
                                           const RegistrationOptions& options,
                                           const Locator& locator, Monitor& monitor,
                                           PairMaps& maps) {
  const correlation::MapSignals fixed_signals(maps.fixed, options.signal);
  const auto mapAt = [&](double factor) {
    mapMoving(fixed, moving, scaledGuess(fixed, moving, guess, options.prior, factor), options,
              monitor, maps);
  };
  std::optional<ScaleTrial> best;
  for (const double factor : scaleFactors(maps.moving_box, maps.fixed_box, options.prior)) {
    mapAt(factor);
    Outcome next = place(maps, fixed_signals, 1, options, locator, monitor);
    if (best && !better(next, best->outcome)) continue;
    best = ScaleTrial{factor, maps.frames, std::move(next)};
    if (best->outcome.verdict.status == verdict::Status::kAccepted) break;
  }
  if (!best) throw fitsAtNoScale(fixed, moving);
  if (!best->outcome.placed) return {std::move(best->outcome), 1.0};
  const double scale = scaleOf(*best, maps.space.scale_axes);
  mapAt(scale);
  ScaleTrial found = carriedOver(*std::move(best), maps.frames);
  const correlation::MapSignals moving_signals(maps.moving, options.signal);
  const refine::PairSignals signals = signalsOf(fixed_signals, moving_signals, options, monitor);
  return {settle(maps, signals, std::move(found.outcome.trace.located),
                 std::move(found.outcome.rivals), options, monitor),
          scale};
}

}  // namespace

Registration registerClouds(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                            const RegistrationOptions& chosen, Monitor& monitor,
                            const Locator& locator, const std::vector<Eigen::Vector3d>& path) {
  const StopScope scope(monitor.stop());
  const RegistrationOptions options = resolved(chosen);
  requireUsable(fixed, moving, options, locator != nullptr);
  PairMaps maps = mapPair(fixed, moving, guess, options, monitor);
  warnOfFlat(maps.fixed, maps.moving, options.signal, monitor);
  auto [outcome, scale] =
      options.prior.scale_unknown
          ? placeAtAnyScale(fixed, moving, guess, options, locator, monitor, maps)
          : std::pair(placeAlongPath(moving, path, options, locator, monitor, maps), 1.0);
  // Only now: a search that found the place need not look for another one.
  if (options.require_heights) verdict::requireHeights(outcome.verdict);
  return monitor.run(Stage::kCompose, [&] {
    return compose(fixed, moving, std::move(maps), std::move(outcome), scale, options);
  });
}

}  // namespace agricolmap::pipeline
