#include "agricolmap/4_associate/flow/patch_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap {

void describe(OptionTable& table, FlowOptions& options) {
  table.integer("seed_spacing", options.seed_spacing, 1, 50, "cells", "between seeds");
  table.integer("levels", options.levels, 1, 7, "", "resolutions, each half the one before");
  table.integer("iterations", options.iterations, 1, 100, "",
                "of propagation and random search per level");
  table.integer("random_start", options.random_start, 1, 10000, "",
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
  float cost;
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
    reachable_.resize(seeds.position.size());
    forSeeds([&](std::size_t i) {
      const Eigen::Vector2d& p = seeds.position[i];
      const Box2 box = forward_ ? reach.forwardBox(p) : reach.backwardBox(p);
      reachable_[i] = Box2(box.min() - p, box.max() - p);
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
        seeds_.position.size(),
        [&](std::size_t i) {
          if (seeds_.active[i] != 0) body(i);
        },
        kSeedGrain);
  }

  const DescriptorMap& source() const { return (forward_ ? moving_ : fixed_)[level_]; }
  const DescriptorMap& target() const { return (forward_ ? fixed_ : moving_)[level_]; }
  double cell() const { return fixed_[level_].frame.cell; }

  static std::ptrdiff_t cellAt(const DescriptorMap& map, const Eigen::Vector2d& point) {
    const Eigen::Vector2d local = (point - map.frame.corner) / map.frame.cell;
    const int col = static_cast<int>(std::floor(local.x()));
    const int row = static_cast<int>(std::floor(local.y()));
    if (col < 0 || row < 0 || col >= map.frame.cols || row >= map.frame.rows) return -1;
    return static_cast<std::ptrdiff_t>(map.index(row, col));
  }

  float costOf(std::size_t i, const Eigen::Vector2d& displacement) const {
    const std::ptrdiff_t to = cellAt(target(), seeds_.position[i] + displacement);
    if (to < 0 || source_cell_[i] < 0) return MatchCost::kImpossible;
    const auto a = static_cast<std::size_t>(source_cell_[i]);
    const auto b = static_cast<std::size_t>(to);
    return forward_ ? (*cost_)(b, a) : (*cost_)(a, b);
  }

  void improve(std::size_t i, const Eigen::Vector2d& displacement, Candidate& best) const {
    if (!reachable_[i].contains(displacement)) return;
    const float cost = costOf(i, displacement);
    if (cost < best.cost) best = {displacement, cost};
  }

  /// Takes the field to a level: what a seed has costs something else here.
  void enter(std::size_t level, const CostOptions& options) {
    level_ = level;
    cost_.emplace(fixed_[level], moving_[level], options);
    source_cell_.assign(seeds_.position.size(), -1);
    forSeeds([&](std::size_t i) {
      source_cell_[i] = cellAt(source(), seeds_.position[i]);
      if (field_.cost[i] < MatchCost::kImpossible) {
        field_.cost[i] = costOf(i, field_.displacement[i]);
      }
    });
  }

  void start() {
    forSeeds([&](std::size_t i) {
      Random random = Random::stream(seed_, i);
      Candidate best{field_.displacement[i], MatchCost::kImpossible};
      const Eigen::Vector2d& p = seeds_.position[i];
      for (int k = 0; k < options_.random_start; ++k) {
        improve(i,
                (forward_ ? reach_.sampleForward(p, random) : reach_.sampleBackward(p, random)) - p,
                best);
      }
      field_.displacement[i] = best.displacement;
      field_.cost[i] = best.cost;
    });
  }

  void iterate(int stride, bool coarsest, std::uint64_t iteration_seed) {
    const FlowField old = field_;
    const auto cols = static_cast<std::size_t>(seeds_.cols);
    forSeeds([&](std::size_t i) {
      const int row = static_cast<int>(i / cols);
      const int col = static_cast<int>(i % cols);
      Candidate best{old.displacement[i], old.cost[i]};
      const std::array<std::array<int, 2>, 4> steps = {
          {{-stride, 0}, {stride, 0}, {0, -stride}, {0, stride}}};
      for (const auto& step : steps) {
        const int r = row + step[0];
        const int c = col + step[1];
        if (r < 0 || c < 0 || r >= seeds_.rows || c >= seeds_.cols) continue;
        const std::size_t j = static_cast<std::size_t>(r) * cols + static_cast<std::size_t>(c);
        if (old.cost[j] < MatchCost::kImpossible) improve(i, old.displacement[j], best);
      }
      Random random = Random::stream(iteration_seed, i);
      const double widest =
          coarsest ? 0.5 * reachable_[i].sizes().maxCoeff() : options_.refine_radius * cell();
      for (double radius = widest; radius >= cell(); radius *= 0.5) {
        const double x = random.uniform(-radius, radius);
        const double y = random.uniform(-radius, radius);
        improve(i, best.displacement + Eigen::Vector2d(x, y), best);
      }
      field_.displacement[i] = best.displacement;
      field_.cost[i] = best.cost;
    });
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
  std::vector<Box2> reachable_;  ///< of displacements
  FlowField field_;
};

}  // namespace

SeedLattice latticeOn(const DescriptorMap& moving, int seed_spacing) {
  SeedLattice seeds;
  seeds.rows = (moving.frame.rows + seed_spacing / 2) / seed_spacing;
  seeds.cols = (moving.frame.cols + seed_spacing / 2) / seed_spacing;
  const MatchCost cost(moving, moving, {});
  for (int r = 0; r < seeds.rows; ++r) {
    for (int c = 0; c < seeds.cols; ++c) {
      const int row = r * seed_spacing + seed_spacing / 2;
      const int col = c * seed_spacing + seed_spacing / 2;
      const bool inside = row < moving.frame.rows && col < moving.frame.cols;
      seeds.position.push_back(moving.frame.centre(row, col));
      seeds.active.push_back(inside && cost.usable(moving.index(row, col)) ? 1 : 0);
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

}  // namespace agricolmap
