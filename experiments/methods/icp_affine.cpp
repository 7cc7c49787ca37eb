#include "experiments/methods/icp_affine.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "experiments/methods/nearest_points.hpp"
#include "experiments/methods/peer_maps.hpp"

namespace agricolmap::experiments {
namespace {

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
      const Eigen::Vector3d& target = fixed.points()[found->index];
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

double farthestCorner(const map::Box2& box, const Eigen::Affine2d& a, const Eigen::Affine2d& b) {
  double farthest = 0.0;
  for (const auto which :
       {map::Box2::BottomLeft, map::Box2::BottomRight, map::Box2::TopLeft, map::Box2::TopRight}) {
    const Eigen::Vector2d corner = box.corner(which);
    farthest = std::max(farthest, (a * corner - b * corner).norm());
  }
  return farthest;
}

class IcpAffine : public Method {
 public:
  explicit IcpAffine(const IcpAffineOptions& options) : options_(options) {}
  std::string name() const override { return "icp-affine"; }
  std::string about() const override { return "affine ICP on the vegetation points"; }

 protected:
  void attempt(const MethodInput& input, MethodOutcome& outcome) const override {
    const PeerMaps maps = makePeerMaps(input, outcome.times);
    const PeerPoints points =
        makePeerPoints(maps, maps.space.uncertainty.translation + 1.0, options_.most_fixed,
                       options_.most_moving, outcome.times);
    Pose pose;
    const std::string failure =
        outcome.times.run("icp", [&] { return iterate(points, pose, outcome.accepted); });
    if (!failure.empty()) {
      outcome.why = failure;
      return;
    }
    if (!outcome.accepted) outcome.why = "still moving when the iterations ended";
    setPlanePose(maps, input, pose.plane, outcome);
  }

 private:
  /// Why there is no answer, or nothing; `converged` says whether it came to rest.
  std::string iterate(const PeerPoints& points, Pose& pose, bool& converged) const {
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
    for (int i = 0; i < options_.iterations && !converged; ++i) {
      const Sums sums = pairUp(fixed, points.moving, middle, pose, options_.most_distance);
      if (sums.pairs < options_.least_pairs * static_cast<double>(points.moving.size())) {
        return fmt::format("only {:.0f} of {} moving points have a fixed one within {} m",
                           sums.pairs, points.moving.size(), options_.most_distance);
      }
      const Eigen::FullPivLU<Eigen::Matrix3d> solver(sums.from);
      if (!solver.isInvertible()) return "the pairs determine no affine";
      const Eigen::Matrix<double, 2, 3> fit = solver.solve(sums.to.transpose()).transpose();
      Pose next;
      next.plane.linear() = fit.leftCols<2>();
      next.plane.translation() = fit.col(2) - fit.leftCols<2>() * middle;
      next.height = sums.height / sums.pairs;
      if (!(next.plane.linear().determinant() > 0.0)) return "the map collapsed";
      converged = farthestCorner(box, next.plane, pose.plane) < options_.stop;
      pose = next;
    }
    return {};
  }

  IcpAffineOptions options_;
};

}  // namespace

std::unique_ptr<Method> makeIcpAffine(const IcpAffineOptions& options) {
  return std::make_unique<IcpAffine>(options);
}

}  // namespace agricolmap::experiments
