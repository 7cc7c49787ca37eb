#include "agricolmap/paper/flow/patch_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, FlowOptions& options) {
  table.integer("seed_spacing", options.seed_spacing, 1, 50, "cells", "between seeds");
  table.integer("levels", options.levels, 1, 7, "", "resolutions, each half the one before");
  table.integer("iterations", options.iterations, 1, 100, "",
                "of propagation and random search per level");
  table.integer("random_start", options.random_start, 1, 1000, "",
                "random displacements per seed at the coarsest level");
  table.number("refine_radius", options.refine_radius, 1.0, 100.0, "cells",
               "of the random search below the coarsest level");
  table.number("closure", options.closure, 0.0, 100.0, "cells",
               "largest forward-backward difference, 0 for no check");
}

namespace {

constexpr std::size_t kSeedGrain = 64;
constexpr std::array<int, 4> kStrides = {8, 4, 2, 1};

std::uint64_t mixed(std::uint64_t seed, std::uint64_t item) {
  return Random::stream(seed, item).bits();
}

/// A displacement and what it costs.
struct Candidate {
  Eigen::Vector2d displacement;
  float cost = MatchCost::kImpossible;
};

/// The last cells that a seed was compared with at this level. What it has costs less or as much
/// and only falls, so they cannot win any more.
class alignas(64) Tried {
 public:
  /// False when the cell was tried before; remembers it.
  bool first(int row, int col, std::size_t index) {
    // Cells of a 4 × 4 block keep out of each other's way: the search ends among neighbours.
    std::uint32_t& slot = cells_[static_cast<std::size_t>((row & 3) * 4 + (col & 3))];
    const auto cell = static_cast<std::uint32_t>(index);
    if (slot == cell) return false;
    slot = cell;
    return true;
  }
  void forget() { cells_.fill(0xFFFFFFFFU); }

 private:
  std::array<std::uint32_t, 16> cells_;
};

/// A displacement that may be better, and its cell of the target; none: nothing to compare with.
struct Trial {
  Eigen::Vector2d displacement;
  std::ptrdiff_t cell = -1;
};

/// Seeds that search in step. Cells are read in no order from maps far larger than the caches;
/// fetching those of all seeds before the first is compared hides most of the waiting.
constexpr std::size_t kTogether = 16;
struct Block {
  std::size_t count = 0;
  std::array<std::size_t, kTogether> seed{};
  std::array<Candidate, kTogether> best{};
  std::array<Trial, kTogether> trial{};
};

/// The seeds of one direction, at one level after the other.
class Matcher {
 public:
  Matcher(const Pyramid& fixed, const Pyramid& moving, const SeedLattice& seeds, const Reach& reach,
          Direction direction, const FlowOptions& options, std::uint64_t seed)
      : fixed_(fixed),
        moving_(moving),
        seeds_(seeds),
        reach_(reach),
        forward_(direction == Direction::kForward),
        options_(options),
        seed_(seed) {
    field_.displacement.assign(seeds.position.size(), Eigen::Vector2d::Zero());
    field_.cost.assign(seeds.position.size(), MatchCost::kImpossible);
    old_ = field_;
    for (std::size_t i = 0; i < seeds.active.size(); ++i) {
      if (seeds.active[i] != 0) active_.push_back(i);
    }
    tried_.resize(seeds.position.size());
    reachable_.resize(seeds.position.size());
    forSeeds([&](std::size_t i) {
      const Eigen::Vector2d& p = seeds.position[i];
      const map::Box2 box = forward_ ? reach.forwardBox(p) : reach.backwardBox(p);
      reachable_[i] = map::Box2(box.min() - p, box.max() - p);
    });
  }

  FlowField run(const CostOptions& cost_options) {
    const int coarsest_level = static_cast<int>(std::min(fixed_.size(), moving_.size())) - 1;
    for (int level = coarsest_level; level >= 0; --level) {
      const auto l = static_cast<std::size_t>(level);
      const bool coarsest = level == coarsest_level;
      enter(l, cost_options);
      if (coarsest) start();
      for (int it = 0; it < options_.iterations; ++it) {
        iterate(kStrides[static_cast<std::size_t>(it) % kStrides.size()], coarsest,
                mixed(seed_, static_cast<std::uint64_t>(1000 * (level + 1) + it)));
      }
    }
    descend();
    return std::move(field_);
  }

 private:
  template <typename Body>
  void forSeeds(const Body& body) const {
    parallelFor(
        active_.size(), [&](std::size_t k) { body(active_[k]); }, kSeedGrain);
  }

  /// Calls `body` with blocks of seeds that have what `from` gives them, and keeps what it finds.
  template <typename Body>
  void forBlocks(const FlowField& from, const Body& body) {
    parallelFor((active_.size() + kTogether - 1) / kTogether,
                [&](std::size_t b) {
                  Block block;
                  block.count = std::min(kTogether, active_.size() - b * kTogether);
                  for (std::size_t k = 0; k < block.count; ++k) {
                    const std::size_t i = active_[b * kTogether + k];
                    block.seed[k] = i;
                    block.best[k] = {from.displacement[i], from.cost[i]};
                  }
                  body(block);
                  for (std::size_t k = 0; k < block.count; ++k) {
                    field_.displacement[block.seed[k]] = block.best[k].displacement;
                    field_.cost[block.seed[k]] = block.best[k].cost;
                  }
                },
                kSeedGrain / kTogether);
  }

  /// Tries for every seed of a block what `displacement(k)` gives, if anything.
  template <typename Displacement>
  void tryEach(Block& block, const Displacement& displacement) {
    for (std::size_t k = 0; k < block.count; ++k) {
      const std::optional<Eigen::Vector2d> d = displacement(k);
      block.trial[k] = d ? propose(block.seed[k], *d) : Trial{};
    }
    for (std::size_t k = 0; k < block.count; ++k) {
      settle(block.seed[k], block.trial[k], block.best[k]);
    }
  }

  const DescriptorMap& source() const { return (forward_ ? moving_ : fixed_)[level_]; }
  const DescriptorMap& target() const { return (forward_ ? fixed_ : moving_)[level_]; }
  double cell() const { return fixed_[level_].frame.cell; }

  /// A cell of a map; no index where a point lies outside.
  struct Cell {
    int row;
    int col;
    std::ptrdiff_t index = -1;
  };

  static Cell cellAt(const DescriptorMap& map, const Eigen::Vector2d& point) {
    const Eigen::Vector2d local = (point - map.frame.corner) / map.frame.cell;
    Cell cell{static_cast<int>(std::floor(local.y())), static_cast<int>(std::floor(local.x()))};
    if (cell.col >= 0 && cell.row >= 0 && cell.col < map.frame.cols && cell.row < map.frame.rows) {
      cell.index = static_cast<std::ptrdiff_t>(map.index(cell.row, cell.col));
    }
    return cell;
  }

  /// What seed i costs in a cell of the target, or anything not below `limit`.
  float costOf(std::size_t i, std::ptrdiff_t to, float limit) const {
    if (to < 0 || source_cell_[i] < 0) return MatchCost::kImpossible;
    const auto a = static_cast<std::size_t>(source_cell_[i]);
    const auto b = static_cast<std::size_t>(to);
    return forward_ ? cost_->below(b, a, limit) : cost_->below(a, b, limit);
  }

  /// What is left to compare of a displacement; asks for its cell.
  Trial propose(std::size_t i, const Eigen::Vector2d& displacement) {
    if (!reachable_[i].contains(displacement)) return {};
    const Cell to = cellAt(target(), seeds_.position[i] + displacement);
    if (to.index < 0) return {};
    const auto index = static_cast<std::size_t>(to.index);
    if (!tried_[i].first(to.row, to.col, index)) return {};
    target().prefetch(index);
    return {displacement, to.index};
  }

  void settle(std::size_t i, const Trial& trial, Candidate& best) const {
    if (trial.cell < 0) return;
    const float cost = costOf(i, trial.cell, best.cost);
    if (cost < best.cost) best = {trial.displacement, cost};
  }

  void improve(std::size_t i, const Eigen::Vector2d& displacement, Candidate& best) {
    settle(i, propose(i, displacement), best);
  }

  /// Takes the field to a level: what a seed has costs something else here.
  void enter(std::size_t level, const CostOptions& options) {
    level_ = level;
    cost_.emplace(fixed_[level], moving_[level], options);
    source_cell_.assign(seeds_.position.size(), -1);
    forSeeds([&](std::size_t i) {
      source_cell_[i] = cellAt(source(), seeds_.position[i]).index;
      tried_[i].forget();
      if (field_.cost[i] < MatchCost::kImpossible) {
        const Cell to = cellAt(target(), seeds_.position[i] + field_.displacement[i]);
        field_.cost[i] = costOf(i, to.index, std::numeric_limits<float>::infinity());
        if (to.index >= 0) tried_[i].first(to.row, to.col, static_cast<std::size_t>(to.index));
      }
    });
  }

  void start() {
    const FlowField nothing = field_;
    forBlocks(nothing, [&](Block& block) {
      std::array<std::optional<Random>, kTogether> random;
      for (std::size_t k = 0; k < block.count; ++k) {
        random[k] = Random::stream(seed_, block.seed[k]);
      }
      for (int n = 0; n < options_.random_start; ++n) {
        tryEach(block, [&](std::size_t k) -> std::optional<Eigen::Vector2d> {
          const Eigen::Vector2d& p = seeds_.position[block.seed[k]];
          return (forward_ ? reach_.sampleForward(p, *random[k])
                           : reach_.sampleBackward(p, *random[k])) -
                 p;
        });
      }
    });
  }

  void iterate(int stride, bool coarsest, std::uint64_t iteration_seed) {
    // Both hold the same where no seed is active.
    std::swap(field_, old_);
    forBlocks(old_, [&](Block& block) {
      propagate(stride, block);
      searchAround(coarsest, iteration_seed, block);
    });
  }

  /// What the neighbours in the lattice had after the iteration before.
  void propagate(int stride, Block& block) {
    const std::array<std::array<int, 2>, 4> steps = {
        {{-stride, 0}, {stride, 0}, {0, -stride}, {0, stride}}};
    for (const auto& step : steps) {
      tryEach(block, [&](std::size_t k) -> std::optional<Eigen::Vector2d> {
        const auto cols = static_cast<std::size_t>(seeds_.cols);
        const int r = static_cast<int>(block.seed[k] / cols) + step[0];
        const int c = static_cast<int>(block.seed[k] % cols) + step[1];
        if (r < 0 || c < 0 || r >= seeds_.rows || c >= seeds_.cols) return std::nullopt;
        const std::size_t j = static_cast<std::size_t>(r) * cols + static_cast<std::size_t>(c);
        if (old_.cost[j] >= MatchCost::kImpossible) return std::nullopt;
        return old_.displacement[j];
      });
    }
  }

  /// Random steps from the best so far, each half as far as the one before.
  void searchAround(bool coarsest, std::uint64_t iteration_seed, Block& block) {
    std::array<std::optional<Random>, kTogether> random;
    std::array<double, kTogether> radius{};
    for (std::size_t k = 0; k < block.count; ++k) {
      const std::size_t i = block.seed[k];
      random[k] = Random::stream(iteration_seed, i);
      radius[k] =
          coarsest ? 0.5 * reachable_[i].sizes().maxCoeff() : options_.refine_radius * cell();
    }
    for (bool more = true; more;) {
      more = false;
      tryEach(block, [&](std::size_t k) -> std::optional<Eigen::Vector2d> {
        if (radius[k] < cell()) return std::nullopt;
        const double x = random[k]->uniform(-radius[k], radius[k]);
        const double y = random[k]->uniform(-radius[k], radius[k]);
        radius[k] *= 0.5;
        more = true;
        return block.best[k].displacement + Eigen::Vector2d(x, y);
      });
    }
  }

  /// Ends at a minimum among the neighbouring cells, aligned with the cells' centres.
  void descend() {
    forSeeds([&](std::size_t i) {
      if (field_.cost[i] >= MatchCost::kImpossible) return;
      const Eigen::Vector2d& p = seeds_.position[i];
      const GridFrame& frame = target().frame;
      const Eigen::Vector2d place = frame.cellOf(p + field_.displacement[i]).array().round();
      Candidate best{frame.centre(place.y(), place.x()) - p, field_.cost[i]};
      for (bool better = true; better;) {
        const Candidate from = best;
        for (int k = 0; k < 9; ++k) {
          improve(i, from.displacement + cell() * Eigen::Vector2d(k % 3 - 1, k / 3 - 1), best);
        }
        better = best.cost < from.cost;
      }
      field_.displacement[i] = best.displacement;
      field_.cost[i] = best.cost;
    });
  }

  const Pyramid& fixed_;
  const Pyramid& moving_;
  const SeedLattice& seeds_;
  const Reach& reach_;
  bool forward_;
  const FlowOptions& options_;
  std::uint64_t seed_;
  std::size_t level_ = 0;
  std::optional<MatchCost> cost_;
  std::vector<std::ptrdiff_t> source_cell_;
  std::vector<map::Box2> reachable_;  ///< of displacements
  std::vector<std::size_t> active_;   ///< seeds that take part
  std::vector<Tried> tried_;
  FlowField field_;
  FlowField old_;  ///< of the iteration before
};

}  // namespace

SeedLattice latticeOn(const DescriptorMap& moving, int seed_spacing) {
  SeedLattice seeds;
  seeds.rows = (moving.frame.rows + seed_spacing / 2) / seed_spacing;
  seeds.cols = (moving.frame.cols + seed_spacing / 2) / seed_spacing;
  for (int r = 0; r < seeds.rows; ++r) {
    for (int c = 0; c < seeds.cols; ++c) {
      const int row = r * seed_spacing + seed_spacing / 2;
      const int col = c * seed_spacing + seed_spacing / 2;
      const bool inside = row < moving.frame.rows && col < moving.frame.cols;
      seeds.position.push_back(moving.frame.centre(row, col));
      seeds.active.push_back(inside && usable(moving, moving.index(row, col)) ? 1 : 0);
    }
  }
  return seeds;
}

FlowField matchSeeds(const Pyramid& fixed, const Pyramid& moving, const SeedLattice& seeds,
                     const Reach& reach, Direction direction, const CostOptions& cost,
                     const FlowOptions& options, std::uint64_t seed) {
  return Matcher(fixed, moving, seeds, reach, direction, options, seed).run(cost);
}

std::vector<Match> matchMaps(const Pyramid& fixed, const Pyramid& moving, const SeedLattice& seeds,
                             const Reach& reach, const CostOptions& cost,
                             const FlowOptions& options, std::uint64_t seed) {
  const FlowField flow =
      matchSeeds(fixed, moving, seeds, reach, Direction::kForward, cost, options, seed);
  SeedLattice ends = seeds;
  for (std::size_t i = 0; i < ends.position.size(); ++i) {
    ends.active[i] = flow.cost[i] < MatchCost::kImpossible ? 1 : 0;
    ends.position[i] += flow.displacement[i];
  }
  FlowField back;
  if (options.closure > 0.0) {
    back =
        matchSeeds(fixed, moving, ends, reach, Direction::kBackward, cost, options, mixed(seed, 1));
  }
  const double limit = options.closure * moving.front().frame.cell;
  std::vector<Match> matches;
  for (std::size_t i = 0; i < ends.position.size(); ++i) {
    if (ends.active[i] == 0) continue;
    if (options.closure > 0.0) {
      const Eigen::Vector2d gap = ends.position[i] + back.displacement[i] - seeds.position[i];
      if (!(gap.norm() <= limit)) continue;
    }
    matches.push_back({seeds.position[i], ends.position[i]});
  }
  return matches;
}

}  // namespace agricolmap::paper
