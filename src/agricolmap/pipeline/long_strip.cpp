#include "agricolmap/pipeline/long_strip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/map/blocks.hpp"
#include "agricolmap/pieces/driven_path.hpp"

namespace agricolmap::pipeline {
namespace {

/// Ends that were not found are worth a word from this share of the path on.
constexpr double kLostShare = 0.1;
/// The robot comes by again: nearer than this it sees the same ground twice [m].
constexpr double kTwiceWithin = 2.5;
constexpr double kTwiceShare = 0.3;
/// A strip reaches so far from its path [m].
constexpr double kSide = 4.0;
/// Rivals of a long strip are looked for so far from it at most [m].
constexpr double kMostAside = 10.0;
/// What the place of a piece is off by at least: neighbours share half of what they see [m].
constexpr double kPieceDeviation = 0.005;
/// Fewer pieces tell no bend in height.
constexpr std::size_t kLeastLifted = 4;

/// Leaves the cells from `from` to `to` along the path [m]; returns their bounds.
map::Box2 keepPiece(const deform::Path& path, double from, double to, map::GridMap& map) {
  map::Box2 box;
  map.filled = 0;
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      float& weight = map.weight(r, c);
      if (weight <= 0.0F) continue;
      const double along = path.place(map.frame.centre(r, c)).along;
      if (along < from || along > to) {
        weight = 0.0F;
      } else {
        ++map.filled;
        box.extend(map.frame.centre(r, c));
      }
    }
  }
  return box;
}

/// Bounds of the path from `from` to `to` and what is so near to it [m].
map::Box2 boundsOf(const deform::Path& path, double from, double to, double near) {
  map::Box2 box;
  for (double along = from; along < to; along += 0.5) box.extend(path.point(along));
  box.extend(path.point(to));
  const Eigen::Vector2d rim = Eigen::Vector2d::Constant(near);
  return {(box.min() - rim).eval(), (box.max() + rim).eval()};
}

double halfWidthOf(const deform::Path& path, const map::SignalMap& signals) {
  double largest = 0.0;
  for (int r = 0; r < signals.frame.rows; r += 4) {
    for (int c = 0; c < signals.frame.cols; c += 4) {
      if (signals.weight(r, c) <= 0.0F) continue;
      largest = std::max(largest, std::abs(path.place(signals.frame.centre(r, c)).aside));
    }
  }
  return largest;
}

/// Of neighbours in order, half of each and a quarter of either side.
std::vector<double> smoothed(const std::vector<double>& values) {
  std::vector<double> result = values;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    result[i] = 0.5 * values[i] + 0.25 * (values[i - 1] + values[i + 1]);
  }
  return result;
}

/// What the heights of each piece that was found are short of, beside the straight line through
/// those of all. Dead reckoning pitches, too.
void liftPieces(const refine::PairSignals& signals, const deform::Path& path,
                const RegistrationOptions& options, std::vector<pieces::PiecePose>& chain) {
  std::vector<refine::VerticalResult> heights(chain.size());
  // Pieces in scales of their own could not be compared.
  refine::VerticalOptions vertical = options.vertical;
  vertical.scale = refine::VerticalScaleKind::kAssumed;
  parallelFor(chain.size(), [&](std::size_t i) {
    const pieces::PiecePose& piece = chain[i];
    if (!piece.held) return;
    map::GridMap moving =
        map::croppedMap(signals.moving().grid(), boundsOf(path, piece.from, piece.to, kSide));
    keepPiece(path, piece.from, piece.to, moving);
    map::Box2 under;
    for (const Eigen::Vector2d& corner :
         cornersOf({moving.frame.centre(-0.5, -0.5),
                    moving.frame.centre(moving.frame.rows - 0.5, moving.frame.cols - 0.5)})) {
      under.extend(piece.pose * corner);
    }
    heights[i] = refine::fitVertical(map::croppedMap(signals.fixed().grid(), under), moving,
                                     piece.pose, vertical);
  });
  std::vector<std::size_t> known;
  std::vector<double> lifts;
  double sum = 0.0, sum_s = 0.0, sum_ss = 0.0, sum_h = 0.0, sum_sh = 0.0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const refine::VerticalResult& found = heights[i];
    if (!chain[i].held || found.status != refine::VerticalStatus::kOk) continue;
    const double s = chain[i].middle();
    const double h = found.offset + found.slope.dot(chain[i].pose * path.point(s) - found.about);
    known.push_back(i);
    lifts.push_back(h);
    sum += 1.0, sum_s += s, sum_ss += s * s, sum_h += h, sum_sh += s * h;
  }
  if (known.size() < kLeastLifted) return;
  const double rise = (sum * sum_sh - sum_s * sum_h) / (sum * sum_ss - sum_s * sum_s);
  for (std::size_t k = 0; k < known.size(); ++k) {
    lifts[k] -= sum_h / sum + rise * (chain[known[k]].middle() - sum_s / sum);
  }
  lifts = smoothed(lifts);
  for (std::size_t k = 0; k < known.size(); ++k) chain[known[k]].lift = lifts[k];
}

}  // namespace

std::optional<deform::Path> pathOf(const Cloud& moving, const std::vector<Eigen::Vector3d>& places,
                                   const PairMaps& maps, const RegistrationOptions& options,
                                   Monitor& monitor) {
  const bool is_long = maps.moving_box.sizes().norm() > options.pieces.from;
  if (!placesByPieces(options)) {
    if (!places.empty()) monitor.warn("the path makes no difference to any but the default chain");
    return std::nullopt;
  }
  if (places.empty() && !is_long) return std::nullopt;
  const map::SignalMap signals =
      map::makeSignalMap(maps.moving, refine::kRankingFactor, options.signal);
  if (places.empty()) {
    pieces::ShapePath shape = pieces::pathOfShape(signals);
    if (!shape.path) monitor.warn(shape.why_not);
    return shape.path;
  }
  std::vector<Eigen::Vector2d> levelled;
  for (const Eigen::Vector3d& place : places) {
    levelled.push_back((maps.frames.levelled_from_moving * (place - moving.origin)).head<2>());
  }
  deform::Path path = pieces::pathThrough(levelled, signals, moving.name + ", path");
  const double twice = pieces::drivenTwice(path, kTwiceWithin);
  if (twice > kTwiceShare) {
    monitor.warn(fmt::format(
        "the robot comes by again beside {:.0f} % of its path: passes are followed one after the "
        "other, and what both saw counts for the nearer one",
        100.0 * twice));
  }
  return path;
}

PriorUncertainty withDrift(PriorUncertainty prior, double drift) {
  prior.heading_deg = std::min(180.0, prior.heading_deg + degrees(drift));
  prior.scale = 1.0 - (1.0 - prior.scale) * (1.0 - drift);
  return prior;
}

std::optional<PairMaps> mapsOfPiece(const PairMaps& whole, const deform::Path& path, double along,
                                    const RegistrationOptions& options) {
  const double half = 0.5 * std::min(options.search.max_length, path.length());
  const double near = 0.5 * whole.moving_box.sizes().norm();
  PairMaps piece;
  piece.frames = whole.frames;
  piece.fixed_box = whole.fixed_box;
  piece.grid = whole.grid;
  piece.moving = map::croppedMap(whole.moving,
                                 boundsOf(path, along - half, along + half, std::min(near, kSide)));
  piece.moving_box = keepPiece(path, along - half, along + half, piece.moving);
  if (piece.moving_box.isEmpty()) return std::nullopt;
  piece.moving = map::croppedMap(piece.moving, piece.moving_box);
  piece.space = whole.space;
  piece.space.centre = path.point(along);
  // What a wrong heading and scale about the whole's middle moves the piece by.
  PriorUncertainty& uncertainty = piece.space.uncertainty;
  uncertainty = withDrift(uncertainty, options.pieces.drift);
  const double arm = (piece.space.centre - whole.space.centre).norm();
  const double swing =
      std::hypot(std::exp(logScaleLimit(uncertainty)) - 1.0, radians(uncertainty.heading_deg));
  if (!uncertainty.anywhere()) uncertainty.translation += arm * swing;
  const map::Box2 window =
      reachableWindow(piece.moving_box, piece.space, 2.0 * options.signal.high_pass);
  piece.fixed = uncertainty.anywhere() ? whole.fixed : map::croppedMap(whole.fixed, window);
  const bool seen = std::any_of(piece.fixed.weight.begin(), piece.fixed.weight.end(),
                                [](float weight) { return weight > 0.0F; });
  if (!seen) return std::nullopt;
  return piece;
}

map::GridMap fixedAlong(const PairMaps& maps, const deform::Path& path, double along,
                        const Eigen::Affine2d& pose, const RegistrationOptions& options) {
  map::Box2 box;
  double farthest = 0.0;
  for (double at = 0.0; at <= path.length(); at += 1.0) {
    box.extend(pose * path.point(at));
    farthest = std::max(farthest, std::abs(at - along));
  }
  // Other places are looked for as far away as the guess may be wrong.
  const double aside = std::min(options.prior.translation, kMostAside) + options.pieces.slip +
                       options.pieces.drift * farthest + kSide;
  const Eigen::Vector2d rim = Eigen::Vector2d::Constant(aside);
  return map::croppedMap(maps.fixed, {(box.min() - rim).eval(), (box.max() + rim).eval()});
}

std::vector<FollowedPieces> followFrom(const std::vector<Eigen::Affine2d>& poses,
                                       const refine::PairSignals& signals, const deform::Path& path,
                                       double along, const RegistrationOptions& options) {
  const double half_width = 0.5 * halfWidthOf(path, signals.score().moving());
  std::vector<FollowedPieces> all;
  for (const Eigen::Affine2d& pose : poses) {
    FollowedPieces followed;
    followed.chain = pieces::followPath(signals, path, along, pose, options.pieces, options.dense);
    followed.significance = pieces::significanceOf(followed.chain);
    followed.joined = pieces::joined(followed.chain, path, half_width);
    const auto held = static_cast<std::size_t>(
        std::count_if(followed.chain.begin(), followed.chain.end(),
                      [](const pieces::PiecePose& piece) { return piece.held; }));
    if (followed.joined && 2 * held > followed.chain.size()) all.push_back(std::move(followed));
  }
  std::stable_sort(all.begin(), all.end(), [](const FollowedPieces& a, const FollowedPieces& b) {
    return a.significance > b.significance;
  });
  if (!all.empty()) {
    liftPieces(signals, path, options, all.front().chain);
    all.front().joined = pieces::joined(all.front().chain, path, half_width);
  }
  return all;
}

void followPieces(const FollowedPieces& followed, const deform::Path& path,
                  const map::GridMap& straight, const RegistrationOptions& options,
                  Placed& placed) {
  // The stated error of places along the strip needs that of the whole.
  if (!placed.uncertainty) return;
  const deform::Bend* more = placed.followed ? &placed.followed->bend : nullptr;
  const double deviation = std::max(kPieceDeviation, pieces::deviationOf(followed.chain, path));
  deform::Bend bend = deform::bendThrough(
      path, placed.pose, options.bend.node, deviation, [&](const Eigen::Vector3d& point) {
        const Eigen::Vector3d laid = followed.joined->bend.bent(point);
        return more != nullptr ? deform::unbent(laid, more->deformation, more->pose) : laid;
      });
  if (more != nullptr) {
    bend.gain = more->gain;
    bend.evidence = more->evidence;
  }
  if (more == nullptr) {
    placed.followed = Followed{std::move(bend), straight};
  } else {
    placed.followed->bend = std::move(bend);
  }
}

std::string describe(const FollowedPieces& followed) {
  const auto held = std::count_if(followed.chain.begin(), followed.chain.end(),
                                  [](const pieces::PiecePose& piece) { return piece.held; });
  return fmt::format(
      "{} of {} pieces of the path were found one after the other; together they bend the strip by "
      "up to {:.2f} m",
      held, followed.chain.size(), followed.joined->largest);
}

std::optional<LostEnd> lostEnd(const FollowedPieces& followed, const deform::Path& path,
                               const map::SignalMap& fixed) {
  const std::vector<pieces::PiecePose>& chain = followed.chain;
  const auto shown = [&](const pieces::PiecePose& piece) {
    const Eigen::Vector2d place = piece.pose * path.point(piece.middle());
    return map::sampleSignal(fixed, place).weight > 0.0F;
  };
  const auto held = [](const pieces::PiecePose& piece) { return piece.held; };
  const auto first = std::find_if(chain.begin(), chain.end(), held);
  const auto last = std::find_if(chain.rbegin(), chain.rend(), held).base();
  // From the middle of the last piece that was found to the end of what the map shows.
  double front = 0.0, back = 0.0;
  for (auto piece = chain.begin(); piece != first; ++piece) {
    if (shown(*piece)) front = std::max(front, first->from - piece->from);
  }
  for (auto piece = last; piece != chain.end(); ++piece) {
    if (shown(*piece)) back = std::max(back, piece->to - std::prev(last)->to);
  }
  const double longer = std::max(front, back);
  if (longer < kLostShare * path.length()) return std::nullopt;
  return LostEnd{fmt::format("the {} {:.1f} m of the path could not be found where dead reckoning "
                             "puts them: register the strip in parts",
                             front > back ? "first" : "last", longer),
                 longer};
}

}  // namespace agricolmap::pipeline
