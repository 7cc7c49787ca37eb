// Go-ICP on the vegetation points: rigid, by branch and bound.
#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "agricolmap/core/parallel.hpp"
#include "experiments/methods/go_icp/branch_and_bound.hpp"
#include "experiments/methods/nearest_points.hpp"
#include "experiments/methods/peer_maps.hpp"
#include "experiments/methods/peers.hpp"

namespace agricolmap::experiments {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t kMostFixed = 60000;   // points in the distance field; our choice: all at 2 cm
constexpr std::size_t kMostMoving = 500;    // data points of the search; the article: 100 to 1000
constexpr std::size_t kMostPolish = 20000;  // data points of the last ICP; our choice
constexpr double kFieldCell = 0.05;   // of the distance field [m]; the article: 1/300 of the extent
constexpr double kFieldMargin = 0.5;  // around the fixed points [m]; our choice
constexpr int kIcpIterations = 100;   // at most; our choice
constexpr double kIcpStop = 1e-4;     // done when no point moves further [m]; our choice
constexpr double kMostTime = 51.0;    // of the search [s], then what it has; our choice

Points inSpace(const std::vector<map::VegetationPoint>& vegetation) {
  Points points;
  points.reserve(vegetation.size());
  for (const map::VegetationPoint& p : vegetation) {
    points.emplace_back(p.position.x(), p.position.y(), p.height);
  }
  return points;
}

/// The rigid motion with the least squares between paired points. Not Eigen::umeyama: g++ 12 with
/// AVX takes it for a read out of bounds.
Eigen::Isometry3d fitRigid(const Points& from, const Points& to) {
  Eigen::Vector3d from_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    from_mean += from[i] / static_cast<double>(from.size());
    to_mean += to[i] / static_cast<double>(to.size());
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    cross += (to[i] - to_mean) * (from[i] - from_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) *= -1.0;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = u * svd.matrixV().transpose();
  motion.translation() = to_mean - motion.linear() * from_mean;
  return motion;
}

/// Trimmed rigid ICP.
Eigen::Isometry3d rigidIcp(const NearestPoints& fixed, const Points& moving,
                           Eigen::Isometry3d motion) {
  constexpr double kReach = 2.0;  // beyond this a point has no neighbour to speak of [m]
  double radius = 0.0;
  for (const Eigen::Vector3d& p : moving) radius = std::max(radius, p.norm());
  const auto most =
      static_cast<std::size_t>((1.0 - GoIcpSearch{}.trim) * static_cast<double>(moving.size()));
  struct Pair {
    double distance;
    std::size_t moving;
    std::size_t fixed;
  };
  for (int step = 0; step < kIcpIterations; ++step) {
    std::vector<std::optional<NearestPoints::Neighbour>> found(moving.size());
    parallelFor(
        moving.size(), [&](std::size_t i) { found[i] = fixed.nearest(motion * moving[i], kReach); },
        64);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < moving.size(); ++i) {
      if (found[i]) pairs.push_back({found[i]->distance, i, found[i]->index});
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    if (pairs.size() > most) pairs.resize(most);
    if (pairs.size() < 4) break;
    Points from;
    Points to;
    for (const Pair& pair : pairs) {
      from.push_back(moving[pair.moving]);
      to.push_back(fixed.points()[pair.fixed]);
    }
    const Eigen::Isometry3d next = fitRigid(from, to);
    const double moved = (next.translation() - motion.translation()).norm() +
                         radius * (next.linear() - motion.linear()).norm();
    motion = next;
    if (moved < kIcpStop) break;
  }
  return motion;
}

GoIcpResult search(const DistanceField& field, const NearestPoints& fixed, const Points& moving,
                   const PriorUncertainty& prior) {
  GoIcpSearch domain;
  domain.half_rotation =
      std::max(1e-3, std::min(prior.heading_deg, 180.0) * std::numbers::pi / 180.0);
  domain.half_translation = prior.translation;
  const GoIcpSearcher searcher(field, moving, domain, kMostTime);
  return searcher.run([&](const GoIcpPose& start) {
    const Eigen::Isometry3d motion = rigidIcp(fixed, moving, start.motion());
    const Eigen::AngleAxisd turn(motion.linear());
    GoIcpPose pose;
    pose.rotation = turn.angle() * turn.axis();
    pose.translation = motion.translation();
    pose.error = searcher.errorOf(pose);
    return pose;
  });
}

}  // namespace

void goIcp(const MethodInput& input, MethodOutcome& outcome) {
  const PeerMaps maps = makePeerMaps(input, outcome.times);
  const PriorUncertainty& prior = maps.space.uncertainty;
  const PeerPoints vegetation =
      makePeerPoints(maps, prior.translation + 1.0, kMostFixed, kMostPolish, outcome.times);
  Points fixed = inSpace(vegetation.fixed);
  // Rotations are about the middle of the strip, so that they move it little.
  Points all = inSpace(vegetation.moving);
  const Eigen::Vector3d middle =
      std::accumulate(all.begin(), all.end(), Eigen::Vector3d::Zero().eval()) /
      static_cast<double>(all.size());
  for (Eigen::Vector3d& p : all) p -= middle;
  Points few = inSpace(map::thinToAtMost(vegetation.moving, kMostMoving));
  for (Eigen::Vector3d& p : few) p -= middle;
  // The search moves the middle from where the guess lays it.
  for (Eigen::Vector3d& p : fixed) p -= middle;
  const NearestPoints near(fixed);
  const DistanceField field =
      outcome.times.run("field", [&] { return DistanceField(fixed, kFieldCell, kFieldMargin); });
  const GoIcpResult result =
      outcome.times.run("search", [&] { return search(field, near, few, prior); });
  const Eigen::Isometry3d motion =
      outcome.times.run("icp", [&] { return rigidIcp(near, all, result.pose.motion()); });
  outcome.accepted = result.proven;
  if (!outcome.accepted) {
    outcome.why =
        fmt::format("not proven best when it had to stop, after {} rotations and {} translations",
                    result.rotations, result.bounds);
  }
  const Eigen::Affine3d pose(Eigen::Translation3d(middle) * motion * Eigen::Translation3d(-middle));
  // Its horizontal part: where it lays the strip's own plane.
  Eigen::Affine2d plane = Eigen::Affine2d::Identity();
  const Eigen::Matrix3d& turn = motion.linear();
  plane.linear() = Eigen::Rotation2Dd(std::atan2(turn(1, 0), turn(0, 0))).toRotationMatrix();
  plane.translation() = (pose * middle).head<2>() - plane.linear() * middle.head<2>();
  setPlanePose(maps, input, plane, outcome);
}

}  // namespace agricolmap::experiments
