#include "agricolmap/locate/correlation_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/locate/block_search.hpp"
#include "agricolmap/locate/hypotheses.hpp"
#include "agricolmap/locate/polish.hpp"
#include "agricolmap/locate/row_waves.hpp"

namespace agricolmap::locate {

void listOptions(OptionTable& table, CorrelationOptions& options) {
  table
      .number("cell", options.cell, 0.01, 10.0, "m",
              "cell of the search, rounded to whole grid cells")
      .basic();
  table.number("tolerance", options.tolerance, 0.05, 5.0, "cells",
               "RMS displacement between neighbouring hypotheses of heading and scales");
  table.number("block", options.block, 0.2, 100.0, "m",
               "side of the blocks that the moving map is cut into");
  table.integer("max_blocks", options.max_blocks, 1, 1000, "",
                "at most this many blocks, the most textured ones, take part");
  table
      .number("max_length", options.max_length, 1.0, 1000.0, "m",
              "strips longer than this are sought by their most textured stretch of this length")
      .basic();
  table
      .flag("rows_on_rows", options.rows_on_rows,
            "only headings and scales that lay the rows of one map on those of the other; all, "
            "when that finds nothing convincing")
      .basic();
  table
      .number("max_work", options.max_work, 1.0, 1e9, "1e6 cells",
              "limit of the fixed map's cells times correlations; beyond it the cells are made "
              "coarser, up to 0.25 m")
      .basic();
  table.integer("peaks", options.peaks, 1, 10000, "",
                "places in the map at which the finer headings and scales around a coarse one are "
                "looked at");
  table.number("min_inside", options.min_inside, 0.05, 1.0, "",
               "least share of the blocks that must lie in the fixed map");
  table.integer("climbs", options.climbs, 1, 10000, "",
                "placements of the lattice from which the score is climbed");
  table
      .integer("candidates", options.candidates, 1, 1000, "",
               "placements that are handed on to be refined and compared")
      .basic();
  table.number("separation", options.separation, 0.0, 100.0, "m",
               "placements whose corners differ by less are one");
}

namespace {

/// The strongest waves of each map that are laid on one another.
constexpr int kWaves = 2;
/// A strip of four rows tells their distance to a tenth.
constexpr WaveTolerance kWaveTolerance = {.along = 0.12, .across = 0.08};
/// Power over the mean below which a peak of the spectrum may be chance: thousands of frequencies
/// have their highest at 9 or 10.
constexpr double kMinWave = 12.0;
/// Cells grow by this until the work is within its limit.
constexpr double kCoarser = 1.2;
/// And no further than this [m]: then plants are no longer seen.
constexpr double kCoarsestCell = 0.25;

/// Headings and scales that are tried at least.
constexpr std::size_t kLeastThinned = 12;

/// What is tried: coarse hypotheses, each with the finer ones that are nearest to it.
struct Plan {
  std::vector<Hypothesis> coarse;
  std::vector<std::vector<Hypothesis>> members;
  std::size_t fine = 0;
};

Plan planOver(const std::vector<Hypothesis>& coarse, const std::vector<Hypothesis>& fine,
              const Eigen::Matrix3d& block_metric) {
  const NearestHypothesis nearest_coarse(coarse, block_metric);
  std::vector<std::size_t> nearest(fine.size());
  parallelFor(
      fine.size(), [&](std::size_t i) { nearest[i] = nearest_coarse.of(fine[i]); }, 256);
  std::vector<std::vector<Hypothesis>> members(coarse.size());
  for (std::size_t i = 0; i < fine.size(); ++i) members[nearest[i]].push_back(fine[i]);
  Plan plan;
  plan.fine = fine.size();
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    if (members[i].empty()) continue;
    plan.coarse.push_back(coarse[i]);
    plan.members.push_back(std::move(members[i]));
  }
  return plan;
}

std::vector<map::Block> texturedBlocks(std::vector<map::Block> blocks, int most) {
  const auto count = std::min(blocks.size(), static_cast<std::size_t>(most));
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const map::Block& a, const map::Block& b) { return a.energy > b.energy; });
  blocks.resize(count);
  return blocks;
}

/// Every so many of the coarse hypotheses, as `CorrelationOptions::share` says.
Plan thinned(Plan plan, double share) {
  const auto stride = std::max<std::size_t>(
      1, std::min(static_cast<std::size_t>(1.0 / share), plan.coarse.size() / kLeastThinned));
  if (stride == 1) return plan;
  Plan some;
  for (std::size_t i = stride / 2; i < plan.coarse.size(); i += stride) {
    some.coarse.push_back(plan.coarse[i]);
    some.fine += plan.members[i].size();
    some.members.push_back(std::move(plan.members[i]));
  }
  return some;
}

/// The maps and the plan at one cell size.
struct Setup {
  int factor = 1;
  map::StripFrame strip;
  std::vector<map::Block> blocks;
  Eigen::Matrix3d strip_metric;
  Plan plan;
  bool by_rows = false;  ///< only rows on rows

  /// Cells of the fixed map times correlations.
  double work(const map::SignalMap& fixed) const {
    return static_cast<double>(fixed.weight.size()) *
           static_cast<double>(plan.coarse.size() * blocks.size());
  }
};

Setup setUp(const map::SignalMap& moving, double cell, int factor, const SearchSpace& space,
            const RowWaves& waves, const CorrelationOptions& options) {
  Setup setup;
  setup.factor = factor;
  setup.strip = map::stripFrame(moving);
  const map::StripFrame& strip = setup.strip;
  const map::Stretch stretch =
      map::texturedStretch(map::cutBlocks(moving, strip, options.block), strip, options.max_length);
  setup.blocks = texturedBlocks(stretch.blocks, options.max_blocks);
  const map::Block& block = setup.blocks.front();
  const Eigen::Matrix2d axes = space.mirror * strip.axes;
  const Eigen::Matrix3d block_metric =
      displacementMetric(axes, 0.5 * (block.high - block.low), space.scale_axes);
  setup.strip_metric = displacementMetric(axes, strip.half_extent, space.scale_axes);
  const double radius = options.tolerance * cell;
  const auto coarse = coverSpace(space.uncertainty, block_metric, radius);
  const auto fine = coverSpace(
      space.uncertainty, displacementMetric(axes, stretch.half_extent, space.scale_axes), radius);
  auto by_rows = alongWaves(fine, waves.moving, waves.fixed, space, kWaveTolerance);
  setup.by_rows = !by_rows.empty();
  setup.plan =
      thinned(planOver(coarse, setup.by_rows ? by_rows : fine, block_metric), options.share);
  return setup;
}

/// At the options' cells or, where that is too much work, at coarser ones.
Setup affordableSetup(const correlation::MapSignals& fixed, const correlation::MapSignals& moving,
                      const RowWaves& waves, const SearchSpace& space,
                      const CorrelationOptions& options) {
  const auto at = [&](double cell) {
    const int factor = std::max(1, static_cast<int>(std::lround(cell / fixed.grid().frame.cell)));
    return setUp(moving.at(factor), fixed.at(factor).frame.cell, factor, space,
                 options.rows_on_rows ? waves : RowWaves{}, options);
  };
  double cell = options.cell;
  Setup setup = at(cell);
  while (setup.work(fixed.at(setup.factor)) > options.max_work * 1e6 &&
         cell * kCoarser <= kCoarsestCell) {
    cell *= kCoarser;
    setup = at(cell);
  }
  return setup;
}

Placement placementOf(const Candidate& candidate, const SearchSpace& space) {
  return {.pose = poseOf(candidate, space), .score = candidate.score, .matches = {}};
}

/// What a search that was not accepted is followed by, an ambiguous one, too: among places that fit
/// equally badly the right one may be missing. Finer cells are dearer, and needed where the
/// canopy is closed and only leaves tell places apart; then all headings and scales, should the
/// rows have misled.
struct Attempt {
  double cell;  ///< of the options' cell
  int climbs;   ///< times the options' climbs
  double work;  ///< times the options' limit
  bool rows_on_rows;
};
constexpr std::array<Attempt, kMostAttempts> kAttempts = {
    {{1.0, 1, 1.0, true}, {2.0 / 3.0, 3, 16.0, true}, {1.0, 2, 4.0, false}}};

}  // namespace

RowWaves rowWaves(const correlation::MapSignals& fixed, const correlation::MapSignals& moving) {
  const auto of = [](const correlation::MapSignals& map) {
    return strongestWaves(map.grid(), map.options(), kWaves, kMinWave);
  };
  return {of(fixed), of(moving)};
}

SearchResult searchByCorrelation(const correlation::MapSignals& fixed,
                                 const correlation::MapSignals& moving, const RowWaves& waves,
                                 const SearchSpace& space, const CorrelationOptions& options) {
  const Setup setup = affordableSetup(fixed, moving, waves, space, options);
  const map::SignalMap& cells = moving.at(setup.factor);
  const double cell = fixed.at(setup.factor).frame.cell;
  // A block counts as soon as its middle is within half of it from the map.
  const int rim = static_cast<int>(std::ceil(0.5 * options.block / cell));
  const correlation::MatchedFilter& filter = fixed.filter(setup.factor, options.filter, rim);
  const BlockSearch search(cells, filter, space, setup.strip, setup.blocks, options.peaks,
                           options.min_inside);
  const Plan& plan = setup.plan;
  std::vector<std::vector<Candidate>> found(plan.coarse.size());
  parallelFor(plan.coarse.size(),
              [&](std::size_t i) { found[i] = search.run(plan.coarse[i], plan.members[i]); });
  std::vector<Candidate> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::vector<Candidate> kept =
      distinctCandidates(std::move(all), options.climbs, options.separation, setup.strip, space);
  const Polisher polisher(cells, filter, space, setup.strip_metric, options.min_inside);
  parallelFor(kept.size(), [&](std::size_t i) { kept[i] = polisher.improve(kept[i]); });
  kept = distinctCandidates(std::move(kept), options.candidates, options.separation, setup.strip,
                            space);
  SearchResult result;
  const double work = setup.work(fixed.at(setup.factor));
  for (const Candidate& candidate : kept) {
    result.placements.push_back(placementOf(candidate, space));
  }
  result.report = {.hypotheses = plan.fine,
                   .correlations = plan.coarse.size() * setup.blocks.size(),
                   .blocks = setup.blocks.size(),
                   .rows_on_rows = setup.by_rows,
                   .cell = cell,
                   .work = work / 1e6,
                   .too_much_work = work > options.max_work * 1e6};
  return result;
}

std::vector<Eigen::Matrix2d> decoyMirrors(const correlation::MapSignals& moving,
                                          const RowWaves& waves, const SearchSpace& space) {
  const Eigen::Vector2d across = waves.moving.empty() ? map::stripFrame(moving.at(1)).axes.col(1)
                                                      : waves.moving.front().vector;
  const Eigen::Vector2d normal = across.normalized();
  const Eigen::Matrix2d mirror = Eigen::Matrix2d::Identity() - 2.0 * normal * normal.transpose();
  if (space.uncertainty.heading_deg >= 180.0) return {mirror};
  return {mirror, -mirror};
}

std::optional<CorrelationOptions> optionsOfAttempt(const CorrelationOptions& options,
                                                   std::size_t attempt,
                                                   const std::optional<SearchReport>& before) {
  if (attempt >= kAttempts.size()) return std::nullopt;
  const Attempt& chosen = kAttempts[attempt];
  // Nothing new when the rows did not restrict the search before.
  if (before && !chosen.rows_on_rows && !before->rows_on_rows) return std::nullopt;
  CorrelationOptions changed = options;
  changed.cell *= chosen.cell;
  changed.climbs *= chosen.climbs;
  changed.max_work *= chosen.work;
  changed.rows_on_rows = options.rows_on_rows && chosen.rows_on_rows;
  return changed;
}

}  // namespace agricolmap::locate
