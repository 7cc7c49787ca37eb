#include "agricolmap/evaluate/metrics.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap {
namespace {

constexpr std::size_t kChunk = 1U << 15;

/// Moving file frame shifted to the middle of the points, so that nothing is lost to UTM offsets.
Eigen::Vector3d meanLocal(const Cloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : cloud.xyz) sum += p.cast<double>();
  return sum / static_cast<double>(cloud.size());
}

struct Moments {
  Eigen::Matrix3d qq = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d pq = Eigen::Matrix3d::Zero();
  Moments& operator+=(const Moments& other) {
    qq += other.qq;
    pq += other.pq;
    return *this;
  }
};

struct ErrorSums {
  double horizontal2 = 0.0, vertical2 = 0.0, affine2 = 0.0, worst2 = 0.0;
  ErrorSums& operator+=(const ErrorSums& other) {
    horizontal2 += other.horizontal2;
    vertical2 += other.vertical2;
    affine2 += other.affine2;
    worst2 = std::max(worst2, other.worst2);
    return *this;
  }
};

/// Horizontal scales along the moving file's axes: lengths of the first two columns.
Eigen::Vector2d horizontalScales(const Eigen::Affine3d& affine) {
  return {affine.linear().col(0).norm(), affine.linear().col(1).norm()};
}

}  // namespace

Eigen::Affine3d bestAffine(const Cloud& moving, const std::vector<Eigen::Vector3d>& targets) {
  if (moving.size() != targets.size() || moving.size() < 4) {
    throw InputError(fmt::format(
        "{}: {} points cannot be compared with {} true positions (equal numbers, at least 4)",
        moving.name, moving.size(), targets.size()));
  }
  const Eigen::Vector3d middle = meanLocal(moving);
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& t : targets) target_mean += t - targets.front();
  target_mean = target_mean / static_cast<double>(targets.size()) + targets.front();
  const Moments sums =
      parallelSum<Moments>(moving.size(), kChunk, {}, [&](std::size_t begin, std::size_t end) {
        Moments part;
        for (std::size_t i = begin; i < end; ++i) {
          const Eigen::Vector3d q = moving.xyz[i].cast<double>() - middle;
          part.qq += q * q.transpose();
          part.pq += (targets[i] - target_mean) * q.transpose();
        }
        return part;
      });
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.linear() = sums.qq.ldlt().solve(sums.pq.transpose()).transpose();
  affine.translation() = target_mean - affine.linear() * (moving.origin + middle);
  return affine;
}

RegistrationErrors evaluateTransform(const Eigen::Affine3d& estimate, const Truth& truth,
                                     const Cloud& moving) {
  if (moving.empty()) throw InputError(fmt::format("{}: the cloud has no points", moving.name));
  if (!truth.points.empty() && truth.points.size() != moving.size()) {
    throw InputError(fmt::format("{}: has {} points, the truth has {}", moving.name, moving.size(),
                                 truth.points.size()));
  }
  const ErrorSums sums =
      parallelSum<ErrorSums>(moving.size(), kChunk, {}, [&](std::size_t begin, std::size_t end) {
        ErrorSums part;
        for (std::size_t i = begin; i < end; ++i) {
          const Eigen::Vector3d point = moving.filePoint(i);
          const Eigen::Vector3d placed = estimate * point;
          const Eigen::Vector3d affine = truth.best_affine * point;
          const Eigen::Vector3d error = placed - (truth.points.empty() ? affine : truth.points[i]);
          part.horizontal2 += error.head<2>().squaredNorm();
          part.vertical2 += error.z() * error.z();
          part.affine2 += (placed - affine).head<2>().squaredNorm();
          part.worst2 = std::max(part.worst2, error.squaredNorm());
        }
        return part;
      });
  const auto count = static_cast<double>(moving.size());
  RegistrationErrors errors;
  errors.rms_horizontal = std::sqrt(sums.horizontal2 / count);
  errors.rms_vertical = std::sqrt(sums.vertical2 / count);
  errors.rms = std::hypot(errors.rms_horizontal, errors.rms_vertical);
  errors.rms_to_best_affine = std::sqrt(sums.affine2 / count);
  errors.worst = std::sqrt(sums.worst2);
  const Eigen::Vector3d centre = moving.origin + meanLocal(moving);
  errors.translation = (estimate * centre - truth.best_affine * centre).norm();
  const Eigen::Matrix3d difference =
      nearestRotation(estimate.linear()).transpose() * nearestRotation(truth.best_affine.linear());
  errors.rotation = std::acos(std::clamp((difference.trace() - 1.0) / 2.0, -1.0, 1.0));
  errors.scale = (horizontalScales(estimate).cwiseQuotient(horizontalScales(truth.best_affine)) -
                  Eigen::Vector2d::Ones())
                     .norm();
  return errors;
}

}  // namespace agricolmap
