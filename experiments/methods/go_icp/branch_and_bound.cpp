#include "experiments/methods/go_icp/branch_and_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <utility>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/stopwatch.hpp"

namespace agricolmap::experiments {
namespace {

const double kRoot3 = std::sqrt(3.0);
/// Translations that one inner search may look at; reached only where nothing can be told apart.
constexpr std::int64_t kMostInner = 1'000'000;

/// A cube of rotation vectors or translations.
struct Cube {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double half = 0.0;
  double bound = 0.0;      ///< no point of it has less error
  std::int64_t order = 0;  ///< of making, so that equals come in a known order

  Cube child(int octant) const {
    Cube part;
    part.half = 0.5 * half;
    for (int k = 0; k < 3; ++k) {
      part.centre[k] = centre[k] + (((octant >> k) & 1) != 0 ? part.half : -part.half);
    }
    return part;
  }
};

struct Later {
  bool operator()(const Cube& a, const Cube& b) const {
    return a.bound != b.bound ? a.bound > b.bound : a.order > b.order;
  }
};
using CubeQueue = std::priority_queue<Cube, std::vector<Cube>, Later>;

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

}  // namespace

struct GoIcpSearcher::Inner {
  double error = 0.0;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  bool better = false;  ///< than what was known
  std::int64_t bounds = 0;
};

Eigen::Isometry3d GoIcpPose::motion() const {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotationOf(rotation);
  motion.translation() = translation;
  return motion;
}

GoIcpSearcher::GoIcpSearcher(const DistanceField& field, std::vector<Eigen::Vector3d> moving,
                             const GoIcpSearch& search, double deadline_s)
    : field_(field),
      moving_(std::move(moving)),
      search_(search),
      kept_(std::max<std::size_t>(
          1, static_cast<std::size_t>((1.0 - search.trim) * static_cast<double>(moving_.size())))),
      epsilon_(search.threshold * static_cast<double>(kept_)),
      expired_([watch = Stopwatch(), deadline_s] { return watch.seconds() > deadline_s; }) {}

std::vector<Eigen::Vector3f> GoIcpSearcher::rotated(const Eigen::Vector3d& rotation) const {
  const Eigen::Matrix3d matrix = rotationOf(rotation);
  std::vector<Eigen::Vector3f> points;
  points.reserve(moving_.size());
  for (const Eigen::Vector3d& p : moving_) points.emplace_back((matrix * p).cast<float>());
  return points;
}

std::vector<float> GoIcpSearcher::slackOf(double half_side) const {
  // Eq. 8: a rotation within the cube moves a point by no more than that on its sphere.
  const double angle = std::min(0.5 * kRoot3 * half_side, 0.5 * std::numbers::pi);
  std::vector<float> slack;
  slack.reserve(moving_.size());
  for (const Eigen::Vector3d& p : moving_) {
    slack.push_back(static_cast<float>(2.0 * std::sin(angle) * p.norm()));
  }
  return slack;
}

double GoIcpSearcher::trimmedSum(std::vector<float>& distances) const {
  if (kept_ < distances.size()) {
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(kept_),
                     distances.end());
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < kept_; ++i) {
    sum += static_cast<double>(distances[i]) * static_cast<double>(distances[i]);
  }
  return sum;
}

double GoIcpSearcher::errorOf(const GoIcpPose& pose) const {
  const Eigen::Vector3f shift = pose.translation.cast<float>();
  std::vector<float> distances;
  distances.reserve(moving_.size());
  for (const Eigen::Vector3f& p : rotated(pose.rotation)) distances.push_back(field_.at(p + shift));
  // Not nth_element's order, which would make the sum depend on rounding.
  std::sort(distances.begin(), distances.end());
  return trimmedSum(distances);
}

GoIcpSearcher::Inner GoIcpSearcher::searchTranslations(const std::vector<Eigen::Vector3f>& points,
                                                       const std::vector<float>& slack,
                                                       double best_known) const {
  Inner inner;
  inner.error = best_known;
  CubeQueue queue;
  queue.push({Eigen::Vector3d::Zero(), search_.half_translation, 0.0, 0});
  std::vector<float> distances(points.size());
  std::vector<float> nearer(points.size());
  std::int64_t made = 0;
  while (!queue.empty() && inner.bounds < kMostInner) {
    const Cube cube = queue.top();
    queue.pop();
    if (inner.error - cube.bound < epsilon_) break;
    if ((inner.bounds & 1023) < 8 && expired_()) break;
    for (int octant = 0; octant < 8; ++octant) {
      Cube part = cube.child(octant);
      const Eigen::Vector3f shift = part.centre.cast<float>();
      const auto reach = static_cast<float>(kRoot3 * part.half);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const float d = std::max(field_.at(points[i] + shift) - slack[i], 0.0F);
        distances[i] = d;
        nearer[i] = std::max(d - reach, 0.0F);
      }
      ++inner.bounds;
      part.bound = trimmedSum(nearer);
      if (part.bound >= inner.error) continue;
      const double error = trimmedSum(distances);
      if (error < inner.error) {
        inner.error = error;
        inner.translation = part.centre;
        inner.better = true;
      }
      part.order = ++made;
      queue.push(part);
    }
  }
  return inner;
}

GoIcpResult GoIcpSearcher::run(const LocalSearch& local) const {
  const std::vector<float> none(moving_.size(), 0.0F);
  GoIcpResult result;
  result.pose = local(GoIcpPose{});
  const auto improve = [&](const Eigen::Vector3d& rotation, const Inner& inner) {
    result.bounds += inner.bounds;
    if (!inner.better || inner.error >= result.pose.error) return;
    GoIcpPose found{rotation, inner.translation, inner.error};
    const GoIcpPose polished = local(found);
    result.pose = polished.error < found.error ? polished : found;
  };
  improve(Eigen::Vector3d::Zero(),
          searchTranslations(rotated(Eigen::Vector3d::Zero()), none, result.pose.error));
  CubeQueue queue;
  queue.push({Eigen::Vector3d::Zero(), search_.half_rotation, 0.0, 0});
  std::int64_t made = 0;
  while (!queue.empty()) {
    const Cube cube = queue.top();
    queue.pop();
    if (result.pose.error - cube.bound < epsilon_) {
      result.proven = true;
      return result;
    }
    if (expired_() || result.bounds > search_.most_bounds) return result;
    // All eight parts against the same best error, so that threads change nothing.
    std::array<Inner, 8> upper;
    std::array<Inner, 8> lower;
    const double best = result.pose.error;
    parallelFor(8, [&](std::size_t i) {
      const Cube part = cube.child(static_cast<int>(i));
      if (part.centre.norm() - kRoot3 * part.half > std::numbers::pi) return;
      const std::vector<Eigen::Vector3f> points = rotated(part.centre);
      upper[i] = searchTranslations(points, none, best);
      lower[i] = searchTranslations(points, slackOf(part.half), best);
    });
    for (int octant = 0; octant < 8; ++octant) {
      Cube part = cube.child(octant);
      const auto i = static_cast<std::size_t>(octant);
      improve(part.centre, upper[i]);
      result.bounds += lower[i].bounds;
      ++result.rotations;
      part.bound = std::max(cube.bound, lower[i].error - epsilon_);
      part.order = ++made;
      // Nothing better in it when the inner search came back with what was known.
      if (lower[i].better && part.bound < result.pose.error) queue.push(part);
    }
  }
  result.proven = !expired_();
  return result;
}

}  // namespace agricolmap::experiments
