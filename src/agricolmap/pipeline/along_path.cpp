#include "agricolmap/pipeline/along_path.hpp"

#include <algorithm>
#include <optional>

#include "agricolmap/pieces/anchors.hpp"
#include "agricolmap/pipeline/attempts.hpp"
#include "agricolmap/pipeline/long_strip.hpp"
#include "agricolmap/pipeline/place.hpp"

namespace agricolmap::pipeline {
namespace {

/// Of rival places of a long strip's piece, so many are followed.
constexpr std::size_t kMostFollowed = 3;

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
  const std::vector<double> anchors =
      pieces::anchorsOf(path, moving, options.search.max_length, !options.prior.anywhere());
  for (const double along : anchors) {
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
  maps.space.uncertainty = withDrift(maps.space.uncertainty, options.pieces.drift);
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

}  // namespace

Outcome placeAlongPath(const Cloud& moving, const std::vector<Eigen::Vector3d>& places,
                       const RegistrationOptions& options, const Locator& locator, Monitor& monitor,
                       PairMaps& maps) {
  if (!locator) {
    maps.path = monitor.run(Stage::kSignals,
                            [&] { return pathOf(moving, places, maps, options, monitor); });
    // What is searched as a whole is told by its shape to be a strip only where it is much longer.
    const double whole = places.empty() ? options.pieces.from : options.search.max_length;
    if (maps.path && maps.path->length() > whole) {
      auto outcome = placeByPieces(moving, *maps.path, options, monitor, maps);
      if (outcome) return *std::move(outcome);
    }
  }
  return place(maps, correlation::MapSignals(maps.fixed, options.signal), locate::kMostAttempts,
               options, locator, monitor);
}

}  // namespace agricolmap::pipeline
