#include "agricolmap/4_associate/flow_association.hpp"

#include <algorithm>

namespace agricolmap {

void describe(OptionTable& table, FlowAssociationOptions& options) {
  table.group("describe", options.describe);
  table.group("cost", options.cost);
  table.group("flow", options.flow);
  table.group("vote", options.vote);
  table.integer("seed", options.seed, 0, 2147483647, "", "of the random search");
}

namespace {

Box2 boxOf(const GridFrame& frame) {
  return {frame.corner, frame.corner + frame.cell * Eigen::Vector2d(frame.cols, frame.rows)};
}

/// What the moving map can reach, with ground for the descriptors' sample points.
Box2 searchWindow(const GridMap& moving, const Reach& reach, const DescribeOptions& options) {
  const Box2 box = boxOf(moving.frame);
  Box2 window;
  for (const auto corner : {Box2::BottomLeft, Box2::BottomRight, Box2::TopLeft, Box2::TopRight}) {
    window.extend(reach.forwardBox(box.corner(corner)));
  }
  const double margin = 4.0 * options.daisy.radius * moving.frame.cell;
  window.min().array() -= margin;
  window.max().array() += margin;
  return window;
}

}  // namespace

FlowAssociation::FlowAssociation(const FlowAssociationOptions& options) : options_(options) {
  checkOptions(options);
}

AssociationResult FlowAssociation::associate(const GridMap& fixed, const GridMap& moving,
                                             const SearchSpace& space, StageTimes& times) const {
  const Reach reach(space);
  AssociationResult result;
  Pyramid fixed_maps;
  Pyramid moving_maps;
  times.run("describe", [&] {
    const int levels = options_.flow.levels;
    fixed_maps = describeMap(fixed, searchWindow(moving, reach, options_.describe), levels,
                             options_.describe);
    moving_maps = describeMap(moving, boxOf(moving.frame), levels, options_.describe);
  });
  std::size_t seed_count = 0;
  if (!fixed_maps.empty() && !moving_maps.empty()) {
    times.run("flow", [&] {
      const SeedLattice seeds = latticeOn(moving_maps.front(), options_.flow.seed_spacing);
      seed_count =
          static_cast<std::size_t>(std::count(seeds.active.begin(), seeds.active.end(), 1));
      result.all_matches = matchMaps(fixed_maps, moving_maps, seeds, reach, options_.cost,
                                     options_.flow, static_cast<std::uint64_t>(options_.seed));
    });
    times.run("vote", [&] {
      for (const VotedPlacement& voted :
           voteCoherent(result.all_matches, space, moving.frame.cell, options_.vote)) {
        Placement placement;
        placement.score = static_cast<double>(voted.inliers.size());
        for (const std::uint32_t i : voted.inliers) {
          placement.matches.push_back(result.all_matches[i]);
        }
        result.placements.push_back(std::move(placement));
      }
    });
  }
  const double matches = static_cast<double>(result.all_matches.size());
  const double inliers = result.placements.empty() ? 0.0 : result.placements.front().score;
  result.counts = {{"seeds", static_cast<double>(seed_count)},
                   {"matches", matches},
                   {"inliers", inliers},
                   {"inlier_share", matches > 0.0 ? inliers / matches : 0.0}};
  return result;
}

}  // namespace agricolmap
