#include "agricolmap/4_associate/correlate/correlation_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/4_associate/correlate/block_search.hpp"
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
  table.integer("peaks", options.peaks, 1, 10000, "",
                "places in the map at which the finer headings and scales around a coarse one are "
                "looked at");
  table.number("min_inside", options.min_inside, 0.05, 1.0, "",
               "least share of the blocks that must lie in the fixed map");
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

    const BlockSearch search(moving_signal, filter, space, strip, blocks, options_.peaks,
                             options_.min_inside);
    std::vector<std::vector<Candidate>> found(coarse.size());
    parallelFor(coarse.size(), [&](std::size_t i) {
      if (!members[i].empty()) found[i] = search.run(coarse[i], members[i]);
    });

    std::vector<Candidate> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::vector<Candidate> kept =
        distinctCandidates(std::move(all), options_.climbs, options_.separation, strip, space);
    const Polisher polisher(moving_signal, filter, space, strip_metric);
    parallelFor(kept.size(), [&](std::size_t i) { kept[i] = polisher.improve(kept[i]); });
    kept =
        distinctCandidates(std::move(kept), options_.candidates, options_.separation, strip, space);
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
