#include "experiments/methods/peer_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/refine/vertical.hpp"

namespace agricolmap::experiments {
namespace {

constexpr std::size_t kLeastPoints = 20;

/// The fixed map within `rim` of the moving map's bounds.
map::GridMap fixedAround(const PeerMaps& maps, double rim) {
  const GridFrame& frame = maps.moving.frame;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(rim);
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  return map::croppedMap(maps.fixed,
                         map::Box2(frame.corner - margin, frame.corner + size + margin));
}

std::vector<map::VegetationPoint> pointsOf(const map::GridMap& map, std::size_t most,
                                           std::string_view which) {
  const map::Vegetation vegetation = map::extractVegetation(map, {});
  if (vegetation.points.size() < kLeastPoints) {
    throw InputError(
        fmt::format("vegetation cannot be told from soil in the {} map: {} ({} points)", which,
                    toString(vegetation.threshold.status), vegetation.points.size()));
  }
  return map::thinToAtMost(vegetation.points, most);
}

}  // namespace

PeerMaps makePeerMaps(const MethodInput& input, MethodTimes& times) {
  for (const Cloud* cloud : {&input.fixed, &input.moving}) {
    if (!cloud->hasColour()) {
      throw InputError(fmt::format("{}: has no colours; Excess Green needs them", cloud->name));
    }
  }
  const pipeline::RegistrationOptions paper = pipeline::preset("paper");
  PeerMaps maps;
  const CloudStream stream(input.fixed);
  const pipeline::FixedCloud fixed_cloud(stream);
  const Eigen::Affine3d guess =
      pipeline::centredGuess(fixed_cloud, input.moving, input.guess, input.prior);
  times.run("level", [&] {
    pipeline::levelFixed(fixed_cloud, paper.level, maps.frames);
    pipeline::levelMoving(stream.facts(), input.moving, guess, paper.level, maps.frames);
  });
  times.run("grid", [&] {
    const map::Box2& fixed = maps.frames.fixed_footprint.box;
    const map::Box2& moving = maps.frames.moving_footprint.box;
    pipeline::requirePlausibleExtents(stream.facts(), input.moving, fixed, moving);
    maps.space = pipeline::searchSpace(moving, maps.frames, input.prior);
    const map::Box2 window =
        pipeline::reachableWindow(moving, maps.space, 2.0 * paper.signal.high_pass);
    maps.fixed = map::makeGridMap(stream, maps.frames.levelled_from_fixed,
                                  window.intersection(fixed), paper.grid);
    maps.moving =
        map::makeGridMap(input.moving, maps.frames.levelled_from_moving, moving, paper.grid);
  });
  return maps;
}

PeerPoints makePeerPoints(const PeerMaps& maps, double rim, std::size_t most_fixed,
                          std::size_t most_moving, MethodTimes& times) {
  return times.run("vegetation", [&] {
    PeerPoints points;
    points.fixed = pointsOf(fixedAround(maps, rim), most_fixed, "fixed");
    points.moving = pointsOf(maps.moving, most_moving, "moving");
    return points;
  });
}

void setPlanePose(const PeerMaps& maps, const MethodInput& input, const Eigen::Affine2d& pose,
                  MethodOutcome& outcome) {
  const refine::VerticalResult vertical = outcome.times.run("vertical", [&] {
    return refine::fitVertical(maps.fixed, maps.moving, pose, refine::VerticalOptions{});
  });
  if (vertical.status != refine::VerticalStatus::kOk) {
    outcome.accepted = false;
    outcome.why = "the heights of the two maps do not fit one another";
    return;
  }
  setLevelledPose(maps, input, refine::liftPose(pose, vertical), outcome);
}

void setLevelledPose(const PeerMaps& maps, const MethodInput& input, const Eigen::Affine3d& pose,
                     MethodOutcome& outcome) {
  outcome.fixed_from_moving =
      Eigen::Translation3d(input.fixed.origin) * maps.frames.levelled_from_fixed.inverse() * pose *
      maps.frames.levelled_from_moving * Eigen::Translation3d(-input.moving.origin);
}

void addMatches(const std::string& name, const pipeline::PairFrames& frames,
                const MethodInput& input, const std::vector<Match>& matches, double coherent,
                MethodOutcome& outcome) {
  outcome.facts.emplace_back(name, static_cast<double>(matches.size()));
  outcome.facts.emplace_back(name + "_coherent", coherent);
  if (!input.truth) return;
  // In the plane: the association is a matter of it, and heights are those of the ground.
  const Eigen::Affine3d fixed_file =
      Eigen::Translation3d(input.fixed.origin) * frames.levelled_from_fixed.inverse();
  const Eigen::Affine3d moving_file =
      Eigen::Translation3d(input.moving.origin) * frames.levelled_from_moving.inverse();
  const auto lifted = [](const Eigen::Vector2d& p) { return Eigen::Vector3d(p.x(), p.y(), 0.0); };
  const auto right = std::count_if(matches.begin(), matches.end(), [&](const Match& match) {
    const Eigen::Vector3d off =
        *input.truth * (moving_file * lifted(match.moving)) - fixed_file * lifted(match.fixed);
    return off.head<2>().norm() <= input.right_match;
  });
  outcome.facts.emplace_back(name + "_right", static_cast<double>(right));
}

}  // namespace agricolmap::experiments
