// Affine ICP on the vegetation points.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "experiments/methods/nearest_points.hpp"
#include "experiments/methods/peer_maps.hpp"
#include "experiments/methods/peers.hpp"

namespace agricolmap::experiments {
namespace {

// Points per cloud at most, merged to squares. Our choice: all of a 10 m strip's at 2 cm.
constexpr std::size_t kMostFixed = 60000;
constexpr std::size_t kMostMoving = 20000;
// Pairs further apart do not count [m]. Our choice: about a row's width; without any limit, plants
// that the other map lacks pull the strip out of shape.
constexpr double kMostDistance = 0.3;
constexpr int kIterations = 200;  // at most; our choice, it converges in 20 to 80
constexpr double kStop = 1e-4;    // done when no corner of the strip moves further [m]; our choice
constexpr double kLeastPairs = 0.2;  // share of the moving points that need a partner; our choice

/// Sums of the least-squares problem fixed = M·(moving, 1), and of the heights' difference.
struct Sums {
  Eigen::Matrix3d from = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 2, 3> to = Eigen::Matrix<double, 2, 3>::Zero();
  double height = 0.0;
  double pairs = 0.0;
  Sums& operator+=(const Sums& other) {
    from += other.from;
    to += other.to;
    height += other.height;
    pairs += other.pairs;
    return *this;
  }
};

struct Pose {
  Eigen::Affine2d plane = Eigen::Affine2d::Identity();
  double height = 0.0;  ///< added to the moving heights [m]
};

Sums pairUp(const NearestPoints& fixed, const std::vector<map::VegetationPoint>& moving,
            const Eigen::Vector2d& middle, const Pose& pose, double most) {
  return parallelSum(moving.size(), 1024, Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums part;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector2d at = pose.plane * moving[i].position;
      const Eigen::Vector3d query(at.x(), at.y(), moving[i].height + pose.height);
      const auto found = fixed.nearest(query, most);
      if (!found) continue;
      const Eigen::Vector3d& target = fixed.points()[*found];
      const Eigen::Vector2d arm = moving[i].position - middle;
      const Eigen::Vector3d from(arm.x(), arm.y(), 1.0);
      part.from += from * from.transpose();
      part.to += target.head<2>() * from.transpose();
      part.height += target.z() - moving[i].height;
      part.pairs += 1.0;
    }
    return part;
  });
}

/// Why there is no answer, or nothing; `converged` says whether it came to rest.
std::string iterate(const PeerPoints& points, Pose& pose, bool& converged) {
  std::vector<Eigen::Vector3d> targets;
  targets.reserve(points.fixed.size());
  for (const map::VegetationPoint& p : points.fixed) {
    targets.emplace_back(p.position.x(), p.position.y(), p.height);
  }
  const NearestPoints fixed(std::move(targets));
  map::Box2 box;
  for (const map::VegetationPoint& p : points.moving) box.extend(p.position);
  const Eigen::Vector2d middle = box.center();
  converged = false;
  for (int i = 0; i < kIterations && !converged; ++i) {
    const Sums sums = pairUp(fixed, points.moving, middle, pose, kMostDistance);
    if (sums.pairs < kLeastPairs * static_cast<double>(points.moving.size())) {
      return fmt::format("only {:.0f} of {} moving points have a fixed one within {} m", sums.pairs,
                         points.moving.size(), kMostDistance);
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> solver(sums.from);
    if (!solver.isInvertible()) return "the pairs determine no affine";
    const Eigen::Matrix<double, 2, 3> fit = solver.solve(sums.to.transpose()).transpose();
    Pose next;
    next.plane.linear() = fit.leftCols<2>();
    next.plane.translation() = fit.col(2) - fit.leftCols<2>() * middle;
    next.height = sums.height / sums.pairs;
    if (!(next.plane.linear().determinant() > 0.0)) return "the map collapsed";
    converged = poseDistance(cornersOf(box), next.plane, pose.plane) < kStop;
    pose = next;
  }
  return {};
}

}  // namespace

void icpAffine(const MethodInput& input, MethodOutcome& outcome) {
  const PeerMaps maps = makePeerMaps(input, outcome.times);
  const PeerPoints points = makePeerPoints(maps, maps.space.uncertainty.translation + 1.0,
                                           kMostFixed, kMostMoving, outcome.times);
  Pose pose;
  outcome.why = outcome.times.run("icp", [&] { return iterate(points, pose, outcome.accepted); });
  if (!outcome.why.empty()) return;
  if (!outcome.accepted) outcome.why = "still moving when the iterations ended";
  setPlanePose(maps, input, pose.plane, outcome);
}

}  // namespace agricolmap::experiments
