#include "agricolmap/4_associate/correlate/correlation_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "agricolmap/4_associate/correlate/blocks.hpp"
#include "agricolmap/4_associate/correlate/hypotheses.hpp"
#include "agricolmap/4_associate/correlate/polish.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap {

void describe(OptionTable& table, CorrelationOptions& options) {
  table.number("cell", options.cell, 0.01, 10.0, "m",
               "cell of the search, rounded to whole grid cells");
  table.number("tolerance", options.tolerance, 0.05, 5.0, "cells",
               "RMS displacement between neighbouring hypotheses of heading and scales");
  table.number("block", options.block, 0.2, 100.0, "m",
               "side of the blocks that the moving map is cut into");
  table.integer("max_blocks", options.max_blocks, 1, 1000, "",
                "at most this many blocks, the most textured ones, take part");
  table.integer("climbs", options.climbs, 1, 10000, "",
                "placements of the lattice from which the score is climbed");
  table.integer("candidates", options.candidates, 1, 1000, "",
                "placements that are handed on to be refined and compared");
  table.number("separation", options.separation, 0.0, 100.0, "m",
               "placements whose corners differ by less are one");
  table.group("signal", options.signal);
  table.group("filter", options.filter);
}

namespace {

bool better(const Candidate& a, const Candidate& b) { return a.score > b.score; }

/// Shifts that the initial guess allows, in cells of the search.
struct ShiftWindow {
  int radius;
  double radius2;
  explicit ShiftWindow(double cells)
      : radius(static_cast<int>(std::ceil(cells))), radius2(cells * cells + 1e-9) {}
  /// Half-width of the disc at row offset `dr`.
  int reach(int dr) const {
    return static_cast<int>(std::sqrt(std::max(0.0, radius2 - static_cast<double>(dr) * dr)));
  }
};

/// Work space and inputs of one task: everything about one coarse hypothesis.
class CoarseTask {
 public:
  CoarseTask(const SignalMap& moving, const MatchedFilter& filter, const SearchSpace& space,
             const StripFrame& strip, const std::vector<Block>& blocks, const ShiftWindow& window)
      : moving_(moving),
        filter_(filter),
        space_(space),
        strip_(strip),
        blocks_(blocks),
        window_(window) {}

  /// Best placement of each fine hypothesis, given block scores under `coarse`.
  std::vector<Candidate> run(const Hypothesis& coarse, const std::vector<Hypothesis>& fine) const {
    std::vector<ComplexRaster> surfaces;
    const double deviation = correlateBlocks(coarse, surfaces);
    std::vector<Candidate> best;
    if (deviation <= 0.0) return best;
    std::vector<float> sum;
    for (const Hypothesis& hypothesis : fine) {
      bestShift(hypothesis, surfaces, deviation, sum, best);
    }
    return best;
  }

 private:
  /// One surface per block; returns the deviation of their sum over the map.
  double correlateBlocks(const Hypothesis& coarse, std::vector<ComplexRaster>& surfaces) const {
    const Eigen::Matrix2d linear = linearOf(coarse, space_.scale_axes);
    ComplexRaster scratch(filter_.fft().size());
    double variance = 0.0;
    for (const Block& block : blocks_) {
      const Template piece =
          makeTemplate(moving_, block.centre, linear, boundsOf(block, strip_), filter_.frame().cell,
                       filter_.options().height_weight,
                       [&](const Eigen::Vector2d& p) { return block.contains(strip_.local(p)); });
      ComplexRaster surface(filter_.fft().size());
      filter_.correlate(piece, surface, scratch);
      double sum2 = 0.0;
      for (const float v : surface.re) sum2 += static_cast<double>(v) * static_cast<double>(v);
      variance += sum2 / static_cast<double>(surface.size());
      surfaces.push_back(std::move(surface));
    }
    return std::sqrt(variance);
  }

  /// Adds the blocks' surfaces, each shifted to where the hypothesis puts its block, and keeps the
  /// best shift of the window.
  void bestShift(const Hypothesis& hypothesis, const std::vector<ComplexRaster>& surfaces,
                 double deviation, std::vector<float>& sum, std::vector<Candidate>& best) const {
    const Eigen::Matrix2d linear = linearOf(hypothesis, space_.scale_axes);
    const double cell = filter_.frame().cell;
    const int stride = filter_.fft().cols();
    // Blocks whose middle would lie outside the map add nothing. Correlation is circular: without
    // this a small map's true place appears a second time, one period of the transform away.
    const int cols = filter_.frame().cols;
    const int rows = filter_.frame().rows;
    std::vector<std::pair<int, int>> anchor(blocks_.size());
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Eigen::Vector2d at =
          filter_.frame().cellOf(space_.centre + linear * (blocks_[b].centre - space_.centre));
      anchor[b] = {static_cast<int>(std::lround(at.y())), static_cast<int>(std::lround(at.x()))};
    }
    Candidate top;
    top.score = -std::numeric_limits<double>::infinity();
    for (int dr = -window_.radius; dr <= window_.radius; ++dr) {
      const int reach = window_.reach(dr);
      sum.assign(static_cast<std::size_t>(2 * reach + 1), 0.0F);
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const int row = anchor[b].first + dr;
        if (row < 0 || row >= rows) continue;
        const int first = anchor[b].second - reach;
        const int from = std::clamp(-first, 0, 2 * reach + 1);
        const int to = std::clamp(cols - first, from, 2 * reach + 1);
        const float* source =
            surfaces[b].re.data() + static_cast<std::ptrdiff_t>(row) * stride + first;
        for (int i = from; i < to; ++i) sum[static_cast<std::size_t>(i)] += source[i];
      }
      const auto peak = std::max_element(sum.begin(), sum.end());
      const double score = static_cast<double>(*peak) / deviation;
      if (score > top.score) {
        const auto dc = static_cast<double>(peak - sum.begin()) - reach;
        top = {hypothesis, cell * Eigen::Vector2d(dc, dr), score};
      }
    }
    best.push_back(top);
  }

  const SignalMap& moving_;
  const MatchedFilter& filter_;
  const SearchSpace& space_;
  const StripFrame& strip_;
  const std::vector<Block>& blocks_;
  const ShiftWindow& window_;
};

/// Index of the coarse hypothesis that moves a block's points most nearly as `fine` does.
std::size_t nearestCoarse(const Hypothesis& fine, const std::vector<Hypothesis>& coarse,
                          const Eigen::Matrix3d& block_metric) {
  std::size_t best = 0;
  double best_distance = std::numeric_limits<double>::max();
  const Eigen::Vector3d at = fine.vector();
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    const Eigen::Vector3d d = coarse[i].vector() - at;
    const double distance = d.dot(block_metric * d);
    if (distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  return best;
}

/// Largest displacement between two candidates over the strip's corners [m].
double cornerDistance(const Candidate& a, const Candidate& b, const StripFrame& strip,
                      const SearchSpace& space) {
  const Eigen::Affine2d pose_a = poseOf(a, space);
  const Eigen::Affine2d pose_b = poseOf(b, space);
  double worst = 0.0;
  for (const double u : {-1.0, 1.0}) {
    for (const double v : {-1.0, 1.0}) {
      const Eigen::Vector2d corner =
          strip.world({u * strip.half_extent.x(), v * strip.half_extent.y()});
      worst = std::max(worst, (pose_a * corner - pose_b * corner).norm());
    }
  }
  return worst;
}

/// The best candidates of which no two are nearer than `separation`, best first.
std::vector<Candidate> distinct(std::vector<Candidate> all, int most, double separation,
                                const StripFrame& strip, const SearchSpace& space) {
  std::stable_sort(all.begin(), all.end(), better);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : all) {
    if (static_cast<int>(kept.size()) >= most) break;
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Candidate& k) {
      return cornerDistance(k, candidate, strip, space) < separation;
    });
    if (is_new) kept.push_back(candidate);
  }
  return kept;
}

Placement placementOf(const Candidate& candidate, const StripFrame& strip,
                      const SearchSpace& space) {
  Placement placement;
  placement.score = candidate.score;
  const Eigen::Affine2d pose = poseOf(candidate, space);
  for (const double u : {-1.0, 0.0, 1.0}) {
    for (const double v : {-1.0, 0.0, 1.0}) {
      const Eigen::Vector2d point =
          strip.world({u * strip.half_extent.x(), v * strip.half_extent.y()});
      placement.matches.push_back({point, pose * point});
    }
  }
  return placement;
}

std::vector<Block> texturedBlocks(std::vector<Block> blocks, int most) {
  const auto count = std::min(blocks.size(), static_cast<std::size_t>(most));
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const Block& a, const Block& b) { return a.energy > b.energy; });
  blocks.resize(count);
  return blocks;
}

}  // namespace

CorrelationSearch::CorrelationSearch(const CorrelationOptions& options) : options_(options) {
  checkOptions(options);
}

AssociationResult CorrelationSearch::associate(const GridMap& fixed, const GridMap& moving,
                                               const SearchSpace& space, StageTimes& times) const {
  return times.run("search", [&] {
    const int factor = std::max(1, static_cast<int>(std::lround(options_.cell / fixed.frame.cell)));
    const SignalMap fixed_signal = makeSignalMap(fixed, factor, options_.signal);
    const SignalMap moving_signal = makeSignalMap(moving, factor, options_.signal);
    const double cell = fixed_signal.frame.cell;
    const StripFrame strip = stripFrame(moving_signal);
    const std::vector<Block> blocks =
        texturedBlocks(cutBlocks(moving_signal, strip, options_.block), options_.max_blocks);
    const MatchedFilter filter(fixed_signal, options_.filter);

    const Eigen::Vector2d block_half = 0.5 * (blocks.front().high - blocks.front().low);
    const Eigen::Matrix3d block_metric =
        displacementMetric(strip.axes, block_half, space.scale_axes);
    const Eigen::Matrix3d strip_metric =
        displacementMetric(strip.axes, strip.half_extent, space.scale_axes);
    const double radius = options_.tolerance * cell;
    const auto coarse = coverSpace(space.uncertainty, block_metric, radius);
    const auto fine = coverSpace(space.uncertainty, strip_metric, radius);
    std::vector<std::vector<Hypothesis>> members(coarse.size());
    for (const Hypothesis& h : fine) members[nearestCoarse(h, coarse, block_metric)].push_back(h);

    const ShiftWindow window(space.uncertainty.translation / cell);
    const CoarseTask task(moving_signal, filter, space, strip, blocks, window);
    std::vector<std::vector<Candidate>> found(coarse.size());
    parallelFor(coarse.size(), [&](std::size_t i) {
      if (!members[i].empty()) found[i] = task.run(coarse[i], members[i]);
    });

    std::vector<Candidate> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::vector<Candidate> kept =
        distinct(std::move(all), options_.climbs, options_.separation, strip, space);
    const Polisher polisher(moving_signal, filter, space, strip_metric);
    parallelFor(kept.size(), [&](std::size_t i) { kept[i] = polisher.improve(kept[i]); });
    kept = distinct(std::move(kept), options_.candidates, options_.separation, strip, space);
    AssociationResult result;
    for (const Candidate& candidate : kept) {
      result.placements.push_back(placementOf(candidate, strip, space));
    }
    result.counts = {{"hypotheses", static_cast<double>(fine.size())},
                     {"correlations", static_cast<double>(coarse.size() * blocks.size())},
                     {"blocks", static_cast<double>(blocks.size())},
                     {"placements", static_cast<double>(kept.size())}};
    return result;
  });
}

}  // namespace agricolmap
