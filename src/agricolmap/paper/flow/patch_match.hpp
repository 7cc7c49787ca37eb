// Coarse-to-fine PatchMatch (Hu, Song & Li, CVPR 2016) over descriptor maps.
#pragma once

#include <cstdint>
#include <vector>

#include "agricolmap/paper/describe/descriptor_map.hpp"
#include "agricolmap/paper/flow/match_cost.hpp"
#include "agricolmap/paper/flow/reach.hpp"

namespace agricolmap::paper {

struct FlowOptions {
  int seed_spacing = 3;      ///< between seeds [cells of the finest level], d in CPM
  int levels = 3;            ///< resolutions, each half the one before
  int iterations = 8;        ///< of propagation and random search per level, n in CPM
  int random_start = 16;     ///< random displacements per seed at the coarsest level
  double refine_radius = 4;  ///< of the random search below the coarsest level [cells], r in CPM
  double closure = 5.0;      ///< largest forward–backward difference [cells]; 0 = no check
};
void listOptions(OptionTable& table, FlowOptions& options);

/// Seeds in a lattice; those on unusable ground take no part.
struct SeedLattice {
  int rows = 0;
  int cols = 0;
  std::vector<Eigen::Vector2d> position;  ///< [m]
  std::vector<std::uint8_t> active;       ///< 1 or 0
};

/// What each seed is matched with.
struct FlowField {
  std::vector<Eigen::Vector2d> displacement;  ///< [m]
  std::vector<float> cost;                    ///< MatchCost::kImpossible when nothing was found
};

/// A pyramid of descriptor maps, finest first.
using Pyramid = std::vector<DescriptorMap>;

/// Seeds on the usable cells of the moving map, every `seed_spacing` cells.
SeedLattice latticeOn(const DescriptorMap& moving, int seed_spacing);

/// Which map the seeds lie in.
enum class Direction { kForward, kBackward };

/// Matches seeds of the moving map to the fixed one (forward) or the reverse, through all levels
/// that both pyramids have. Per level: candidates from neighbours in the lattice at strides 8, 4,
/// 2, 1 and random search with shrinking radius. An iteration reads only the field of the one
/// before and every seed has its own random stream, so the result depends on `seed` alone.
FlowField matchSeeds(const Pyramid& fixed, const Pyramid& moving, const SeedLattice& seeds,
                     const Reach& reach, Direction direction, const CostOptions& cost,
                     const FlowOptions& options, std::uint64_t seed);

/// Forward flow of the moving map's lattice with the seeds that a backward flow confirms.
std::vector<Match> matchMaps(const Pyramid& fixed, const Pyramid& moving, const SeedLattice& seeds,
                             const Reach& reach, const CostOptions& cost,
                             const FlowOptions& options, std::uint64_t seed);

}  // namespace agricolmap::paper
