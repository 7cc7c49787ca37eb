// FPFH, fast global registration and generalised ICP of Open3D.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "experiments/methods/fpfh/fpfh_gicp_open3d.hpp"
#include "experiments/methods/peer_maps.hpp"
#include "experiments/methods/peers.hpp"

namespace agricolmap::experiments {
namespace {

/// The cloud's points that lie in `window` of the levelled frame, about `middle` [m].
PlainPoints pointsIn(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local,
                     const map::Box2& window, const Eigen::Vector2d& middle) {
  PlainPoints points;
  for (const Eigen::Vector3f& local : cloud.xyz) {
    const Eigen::Vector3d p = levelled_from_local * local.cast<double>();
    if (!window.contains(p.head<2>())) continue;
    points.push_back({p.x() - middle.x(), p.y() - middle.y(), p.z()});
  }
  return points;
}

/// Whether the motion about the strip's middle is one that the guess allows.
void judge(const Eigen::Affine3d& about, const PriorUncertainty& prior, MethodOutcome& outcome) {
  const double shift = about.translation().head<2>().norm();
  const double turn = Eigen::AngleAxisd(about.linear()).angle() * 180.0 / std::numbers::pi;
  outcome.accepted = shift <= prior.translation && turn <= prior.heading_deg + 1.0;
  if (!outcome.accepted) {
    outcome.why =
        fmt::format("{:.2f} m and {:.1f} deg from the guess, more than it may be off", shift, turn);
  }
}

}  // namespace

void fpfhGicp(const MethodInput& input, MethodOutcome& outcome) {
  const PeerMaps maps = makePeerMaps(input, outcome.times);
  const Eigen::Vector2d& middle = maps.space.centre;
  const map::Box2& moving_box = maps.frames.moving_footprint.box;
  const PlainPoints fixed =
      pointsIn(input.fixed, maps.frames.levelled_from_fixed,
               pipeline::reachableWindow(moving_box, maps.space, 1.0), middle);
  const PlainPoints moving =
      pointsIn(input.moving, maps.frames.levelled_from_moving, moving_box, middle);
  const FpfhGicpResult result = registerByFpfhGicp(fixed, moving);
  outcome.times.add("features", result.features_s);
  outcome.times.add("global", result.global_s);
  outcome.times.add("gicp", result.gicp_s);
  if (!result.found) throw InputError(fmt::format("no registration: {}", result.why));
  Eigen::Affine3d about;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      about.matrix()(r, c) = result.transform[static_cast<std::size_t>(4 * r + c)];
    }
  }
  judge(about, maps.space.uncertainty, outcome);
  const Eigen::Vector3d there(middle.x(), middle.y(), 0.0);
  setLevelledPose(maps, input, Eigen::Translation3d(there) * about * Eigen::Translation3d(-there),
                  outcome);
}

}  // namespace agricolmap::experiments
