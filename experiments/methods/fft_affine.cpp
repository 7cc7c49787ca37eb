// FFT correlation over heading and scales, then dense Gauss-Newton: the simplest thing that works.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "agricolmap/core/keep_distinct.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/locate/hypotheses.hpp"
#include "agricolmap/refine/dense_refine.hpp"
#include "experiments/methods/peer_maps.hpp"
#include "experiments/methods/peers.hpp"
#include "experiments/methods/plain_correlation.hpp"

namespace agricolmap::experiments {
namespace {

// All values are our choice.
constexpr int kFactor = 6;            // cells of the correlation in grid cells: 12 cm
constexpr double kStep = 1.5;         // by which a step of heading or scale moves the ends [cells]
constexpr std::size_t kMost = 30;     // best hypotheses that are refined
constexpr double kApart = 0.3;        // by which two of them lay a corner apart at least [m]
constexpr double kLeastEnergy = 0.5;  // of the fixed map under the strip, in its mean: no rim
/// Cells of the refinement in grid cells: 12 and 6 cm for all candidates, 4 and 2 cm for the best.
constexpr std::array<int, 2> kCoarse = {6, 3};
constexpr std::array<int, 2> kFine = {2, 1};

/// Half of what the seen cells extend to from `centre` along each column of `axes` [m].
Eigen::Vector2d halfExtent(const map::SignalMap& map, const Eigen::Matrix2d& axes,
                           const Eigen::Vector2d& centre) {
  Eigen::Vector2d half = Eigen::Vector2d::Constant(map.frame.cell);
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      if (map.weight(r, c) <= 0.0F) continue;
      const Eigen::Vector2d arm = axes.transpose() * (map.frame.centre(r, c) - centre);
      half = half.cwiseMax(arm.cwiseAbs());
    }
  }
  return half;
}

/// −limit…limit in equal steps of at most `step`.
std::vector<double> stepsOver(double limit, double step) {
  const int count = static_cast<int>(std::ceil(limit / step - 1e-9));
  std::vector<double> values;
  for (int k = -count; k <= count; ++k) {
    values.push_back(count > 0 ? limit * k / count : 0.0);
  }
  return values;
}

/// A piece of nothing, as large as the moving map under a linear map; anchored at `centre`.
PlainCorrelation::Piece blankPiece(const GridFrame& frame, const Eigen::Vector2d& centre,
                                   const Eigen::Matrix2d& linear) {
  map::Box2 box;
  for (const double row : {-0.5, frame.rows - 0.5}) {
    for (const double col : {-0.5, frame.cols - 0.5}) {
      box.extend((linear * (frame.centre(row, col) - centre) / frame.cell).eval());
    }
  }
  PlainCorrelation::Piece piece;
  piece.first_row = static_cast<int>(std::floor(box.min().y()));
  piece.first_col = static_cast<int>(std::floor(box.min().x()));
  const int rows = static_cast<int>(std::ceil(box.max().y())) - piece.first_row + 1;
  const int cols = static_cast<int>(std::ceil(box.max().x())) - piece.first_col + 1;
  piece.value = Raster<float>(rows, cols);
  piece.seen = Raster<float>(rows, cols);
  return piece;
}

/// The moving map under a linear map, at its own cell size; anchored at `centre`.
PlainCorrelation::Piece pieceOf(const map::SignalMap& moving, const Eigen::Vector2d& centre,
                                const Eigen::Matrix2d& linear) {
  PlainCorrelation::Piece piece = blankPiece(moving.frame, centre, linear);
  const Eigen::Matrix2d back = linear.inverse() * moving.frame.cell;
  for (int r = 0; r < piece.value.rows(); ++r) {
    for (int c = 0; c < piece.value.cols(); ++c) {
      const Eigen::Vector2d offset(piece.first_col + c, piece.first_row + r);
      const map::SignalSample sample = map::sampleSignal(moving, centre + back * offset);
      if (sample.weight <= 0.0F) continue;
      piece.value(r, c) = sample.value[0];
      piece.seen(r, c) = 1.0F;
    }
  }
  return piece;
}

struct Candidate {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  double score = 0.0;
};

map::Box2 boxOf(const GridFrame& frame) {
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  return {frame.corner, (frame.corner + size).eval()};
}

std::vector<locate::Hypothesis> hypothesesOver(const PeerMaps& maps, const map::SignalMap& moving) {
  const PriorUncertainty& prior = maps.space.uncertainty;
  const Eigen::Vector2d half = halfExtent(moving, maps.space.scale_axes, maps.space.centre);
  const double shift = kStep * moving.frame.cell;
  const double heading = prior.heading_deg * std::numbers::pi / 180.0;
  const double scale = logScaleLimit(prior);
  std::vector<locate::Hypothesis> all;
  for (const double yaw : stepsOver(heading, shift / half.norm())) {
    for (const double x : stepsOver(scale, shift / half.x())) {
      for (const double y : stepsOver(scale, shift / half.y())) {
        all.push_back({yaw, {std::exp(x), std::exp(y)}});
      }
    }
  }
  return all;
}

std::vector<Candidate> distinct(std::vector<Candidate> found, const GridFrame& frame) {
  std::erase_if(found, [](const Candidate& one) { return !(one.score > 0.0); });
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  const auto corners = cornersOf(boxOf(frame));
  return keepDistinct(
      std::move(found),
      [&](const Candidate& better, const Candidate& one) {
        return poseDistance(corners, better.pose, one.pose) < kApart;
      },
      kMost);
}

/// Best placements, best first.
std::vector<Candidate> search(const PeerMaps& maps) {
  const map::SignalMap fixed = map::makeSignalMap(maps.fixed, kFactor, {});
  const map::SignalMap moving = map::makeSignalMap(maps.moving, kFactor, {});
  const std::vector<locate::Hypothesis> all = hypothesesOver(maps, moving);
  int most_rows = 1;
  int most_cols = 1;
  const Eigen::Vector2d& centre = maps.space.centre;
  for (const locate::Hypothesis& one : all) {
    const PlainCorrelation::Piece piece =
        blankPiece(moving.frame, centre, one.linear(maps.space.scale_axes));
    most_rows = std::max(most_rows, piece.value.rows());
    most_cols = std::max(most_cols, piece.value.cols());
  }
  const PlainCorrelation correlation(fixed, most_rows, most_cols, kLeastEnergy);
  std::vector<Candidate> found(all.size());
  parallelFor(all.size(), [&](std::size_t i) {
    Candidate& candidate = found[i];
    candidate.pose.linear() = all[i].linear(maps.space.scale_axes);
    const PlainCorrelation::Peak peak =
        correlation.best(pieceOf(moving, centre, candidate.pose.linear()), centre,
                         maps.space.uncertainty.translation + moving.frame.cell);
    candidate.pose.translation() = peak.anchor - candidate.pose.linear() * centre;
    candidate.score = peak.score;
  });
  return distinct(std::move(found), moving.frame);
}

std::optional<Eigen::Affine2d> refined(const PeerMaps& maps,
                                       const std::vector<Candidate>& candidates) {
  const refine::DenseRefineOptions dense;
  std::vector<std::optional<refine::DenseRefineResult>> results(candidates.size());
  std::vector<map::SignalMap> fixed;
  std::vector<map::SignalMap> moving;
  for (const int factor : kCoarse) {
    fixed.push_back(map::makeSignalMap(maps.fixed, factor, {}));
    moving.push_back(map::makeSignalMap(maps.moving, factor, {}));
  }
  parallelFor(candidates.size(), [&](std::size_t i) {
    Eigen::Affine2d pose = candidates[i].pose;
    for (std::size_t level = 0; level < fixed.size(); ++level) {
      results[i] = refine::refineDense(fixed[level], moving[level], pose, dense);
      if (results[i]->status != refine::RefineStatus::kConverged) {
        results[i].reset();
        return;
      }
      pose = results[i]->fixed_from_moving;
    }
  });
  const refine::DenseRefineResult* best = nullptr;
  for (const auto& one : results) {
    if (one && (best == nullptr || one->correlation > best->correlation)) best = &*one;
  }
  if (best == nullptr) return std::nullopt;
  Eigen::Affine2d pose = best->fixed_from_moving;
  for (const int factor : kFine) {
    const refine::DenseRefineResult finer =
        refine::refineDense(map::makeSignalMap(maps.fixed, factor, {}),
                            map::makeSignalMap(maps.moving, factor, {}), pose, dense);
    if (finer.status != refine::RefineStatus::kConverged) break;
    pose = finer.fixed_from_moving;
  }
  return pose;
}

}  // namespace

void fftAffine(const MethodInput& input, MethodOutcome& outcome) {
  const PeerMaps maps = makePeerMaps(input, outcome.times);
  const std::vector<Candidate> candidates =
      outcome.times.run("correlate", [&] { return search(maps); });
  const std::optional<Eigen::Affine2d> pose =
      outcome.times.run("refine", [&] { return refined(maps, candidates); });
  if (!pose) {
    outcome.why = candidates.empty() ? "the maps correlate nowhere within the prior's limits"
                                     : "no placement holds when refined";
    return;
  }
  outcome.accepted = true;
  setPlanePose(maps, input, *pose, outcome);
}

}  // namespace agricolmap::experiments
