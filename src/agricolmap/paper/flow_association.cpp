#include "agricolmap/paper/flow_association.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/keep_distinct.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/map/warp.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, FlowAssociationOptions& options) {
  table.group("describe", options.describe);
  table.group("cost", options.cost);
  table.group("flow", options.flow);
  table.group("vote", options.vote);
  table
      .flag("warps", options.warps,
            "match with the moving map turned and stretched where the guess may be far off; not in "
            "the paper")
      .basic();
  // There are as many warps as these make steps of what the guess leaves open: no finer ones.
  table.number("heading_tolerance_deg", options.heading_tolerance_deg, 0.5, 180.0, "deg",
               "heading error to match with without a warp");
  table.number("scale_tolerance", options.scale_tolerance, 0.05, 1.0, "",
               "scale error to match with without a warp, as a logarithm");
  table
      .flag("rematch", options.rematch,
            "match again with the moving map laid as each placement found; not in the paper")
      .basic();
}

namespace {

map::Box2 boxOf(const GridFrame& frame) {
  return {frame.corner, frame.corner + frame.cell * Eigen::Vector2d(frame.cols, frame.rows)};
}

/// What the moving map can reach, with ground for the descriptors' sample points.
map::Box2 searchWindow(const map::GridMap& moving, const Reach& reach,
                       const DescribeOptions& options) {
  const map::Box2 box = boxOf(moving.frame);
  map::Box2 window;
  for (const auto corner :
       {map::Box2::BottomLeft, map::Box2::BottomRight, map::Box2::TopLeft, map::Box2::TopRight}) {
    window.extend(reach.forwardBox(box.corner(corner)));
  }
  const double margin = 4.0 * options.daisy.radius * moving.frame.cell;
  window.min().array() -= margin;
  window.max().array() += margin;
  return window;
}

/// Middles of the fewest equal parts of −limit…limit that reach no further than `tolerance`.
std::vector<double> middles(double limit, double tolerance) {
  const int count = std::max(1, static_cast<int>(std::ceil(limit / tolerance - 1e-9)));
  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) result.push_back(limit * ((2.0 * k + 1.0) / count - 1.0));
  return result;
}

/// Warps of the moving map about the centre that leave only tolerable errors.
std::vector<Eigen::Affine2d> warpsOver(const SearchSpace& space,
                                       const FlowAssociationOptions& options) {
  if (!options.warps) return {Eigen::Affine2d::Identity()};
  const PriorUncertainty& u = space.uncertainty;
  const Eigen::Matrix2d axes = orthonormalAxes(space.scale_axes);
  const std::vector<double> scales = middles(logScaleLimit(u), options.scale_tolerance);
  std::vector<Eigen::Affine2d> warps;
  for (const double heading : middles(u.heading_deg, options.heading_tolerance_deg)) {
    for (const double x : scales) {
      for (const double y : scales) {
        Eigen::Affine2d warp = Eigen::Affine2d::Identity();
        warp.linear() = rotation2(radians(heading)) * axes *
                        Eigen::Vector2d(std::exp(x), std::exp(y)).asDiagonal() * axes.transpose();
        warp.translation() = space.centre - warp.linear() * space.centre;
        warps.push_back(warp);
      }
    }
  }
  return warps;
}

/// A placement with what it was found from.
struct Found {
  Placement placement;
  ScaledRotation pose;
  std::size_t seeds = 0;
  std::vector<Match> all;  ///< matches that were voted on
};

/// One search: its maps and what stays the same from warp to warp.
class FlowSearch {
 public:
  FlowSearch(const map::GridMap& fixed, const map::GridMap& moving, const SearchSpace& space,
             const FlowAssociationOptions& options, Monitor& monitor)
      : moving_(moving), space_(space), options_(options), monitor_(monitor) {
    monitor_.run(Stage::kDescribe, [&] {
      fixed_maps_ = describeMap(fixed, searchWindow(moving, Reach(space), options.describe),
                                options.flow.levels, options.describe);
    });
  }

  /// Placements under every warp of the options, best first.
  std::vector<Found> search() const {
    std::vector<Found> found;
    std::uint64_t seed = static_cast<std::uint64_t>(options_.seed);
    for (const Eigen::Affine2d& warp : warpsOver(space_, options_)) {
      const Matched matched = match(warp, Reach(space_, warp), options_.flow.levels, seed++);
      append(vote(matched, warp, space_, Eigen::Affine2d::Identity()), found);
    }
    return distinct(std::move(found));
  }

  /// Each placement again, with the moving map laid as found and only small errors left.
  std::vector<Found> rematch(const std::vector<Found>& found) const {
    std::vector<Found> result;
    std::uint64_t seed = Random::stream(static_cast<std::uint64_t>(options_.seed), 1).bits();
    for (const Found& candidate : found) {
      const Eigen::Affine2d& warp = candidate.pose.fixed_from_moving;
      // In the warped map the scale axes have turned, and scales multiply along them.
      SearchSpace near = space_;
      near.uncertainty = {.translation = 0.3, .heading_deg = 1.5, .scale = 0.04};
      near.scale_axes = rotation2(candidate.pose.yaw) * space_.scale_axes;
      near.centre = warp * space_.centre;
      const Matched matched =
          match(warp, Reach(near), std::min(kRematchLevels, options_.flow.levels), seed++);
      append(vote(matched, warp, near, warp), result);
    }
    return distinct(std::move(result));
  }

 private:
  static constexpr int kRematchLevels = 3;

  /// Matches from the warped map, in its coordinates.
  struct Matched {
    std::vector<Match> matches;
    std::size_t seeds = 0;
  };

  Matched match(const Eigen::Affine2d& warp, const Reach& reach, int levels,
                std::uint64_t seed) const {
    const Pyramid maps = monitor_.run(Stage::kDescribe, [&] {
      if (warp.isApprox(Eigen::Affine2d::Identity(), 1e-12)) {
        return describeMap(moving_, boxOf(moving_.frame), levels, options_.describe);
      }
      const map::GridMap map = map::warped(moving_, warp);
      return describeMap(map, boxOf(map.frame), levels, options_.describe);
    });
    Matched result;
    if (fixed_maps_.empty() || maps.empty()) return result;
    monitor_.run(Stage::kFlow, [&] {
      const SeedLattice seeds = latticeOn(maps.front(), options_.flow.seed_spacing);
      result.seeds =
          static_cast<std::size_t>(std::count(seeds.active.begin(), seeds.active.end(), 1));
      result.matches =
          matchMaps(fixed_maps_, maps, seeds, reach, options_.cost, options_.flow, seed);
    });
    return result;
  }

  /// Votes on matches of a warped map after `vote_from_moving`, in whose coordinates `space`
  /// speaks. Scores count seeds as if the warp did not stretch.
  std::vector<Found> vote(const Matched& matched, const Eigen::Affine2d& warp,
                          const SearchSpace& space, const Eigen::Affine2d& vote_from_moving) const {
    return monitor_.run(Stage::kVote, [&] {
      const Eigen::Affine2d unwarp = warp.inverse();
      std::vector<Match> original = matched.matches;
      for (Match& m : original) m.moving = unwarp * m.moving;
      std::vector<Match> voted_on = original;
      for (Match& m : voted_on) m.moving = vote_from_moving * m.moving;
      std::vector<Found> result;
      for (const VotedPlacement& voted :
           voteCoherent(voted_on, space, moving_.frame.cell, options_.vote)) {
        Found found;
        found.seeds = matched.seeds;
        found.all = original;
        found.placement.score =
            static_cast<double>(voted.inliers.size()) / warp.linear().determinant();
        for (const std::uint32_t i : voted.inliers) {
          found.placement.matches.push_back(original[i]);
        }
        const auto pose = fitScaledRotation(found.placement.matches, {}, space_.scale_axes);
        if (!pose) continue;
        found.pose = *pose;
        found.placement.pose = pose->fixed_from_moving;
        result.push_back(std::move(found));
      }
      return result;
    });
  }

  static void append(std::vector<Found> more, std::vector<Found>& to) {
    std::move(more.begin(), more.end(), std::back_inserter(to));
  }

  /// Best first, those that lay the moving map's corners where a better one does left out.
  std::vector<Found> distinct(std::vector<Found> found) const {
    constexpr double kSame = 0.15;  // half the narrowest row spacing sown, about [m]
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
      return a.placement.score > b.placement.score;
    });
    const auto corners = cornersOf(boxOf(moving_.frame));
    return keepDistinct(
        std::move(found),
        [&](const Found& better, const Found& one) {
          return poseDistance(corners, one.pose.fixed_from_moving, better.pose.fixed_from_moving) <
                 kSame;
        },
        static_cast<std::size_t>(options_.vote.placements));
  }

  const map::GridMap& moving_;
  const SearchSpace& space_;
  const FlowAssociationOptions& options_;
  Monitor& monitor_;
  Pyramid fixed_maps_;
};

MatchCount countOf(const std::vector<Found>& found) {
  if (found.empty()) return {};
  return {found.front().all.size(), found.front().placement.matches.size()};
}

}  // namespace

FlowResult associateByFlow(const map::GridMap& fixed, const map::GridMap& moving,
                           const SearchSpace& space, const FlowAssociationOptions& options,
                           Monitor& monitor) {
  const FlowSearch search(fixed, moving, space, options, monitor);
  std::vector<Found> found = search.search();
  FlowResult result;
  if (found.empty()) return result;
  result.report.seeds = found.front().seeds;
  result.report.first = countOf(found);
  result.matches = found.front().all;
  if (options.rematch) {
    found = search.rematch(found);
    if (!found.empty()) result.rematches = found.front().all;
    result.report.again = countOf(found);
  }
  for (Found& one : found) result.placements.push_back(std::move(one.placement));
  return result;
}

}  // namespace agricolmap::paper
