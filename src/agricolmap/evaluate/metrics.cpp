#include "agricolmap/evaluate/metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::evaluate {
namespace {

constexpr std::size_t kChunk = 1U << 15;

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

/// The rotation of the horizontal plane: the nearest one to what becomes of x and y. What becomes
/// of z is hardly seen in a map a few centimetres thick, and a least-squares affine shears there
/// freely (one semi-real pair at 2 cm RMS had 0.13 rad by it).
Eigen::Matrix3d groundRotation(const Eigen::Matrix3d& linear) {
  Eigen::Matrix3d upright = linear;
  const double stretch = std::sqrt(linear.col(0).norm() * linear.col(1).norm());
  upright.col(2) = stretch * linear.col(0).cross(linear.col(1)).normalized();
  return nearestRotation(upright);
}

void requireTruth(const Truth& truth, const Cloud& moving) {
  if (moving.empty()) throw InputError(fmt::format("{}: the cloud has no points", moving.name));
  if (!truth.points.empty() && truth.points.size() != moving.size()) {
    throw InputError(fmt::format("{}: has {} points, the truth has {}", moving.name, moving.size(),
                                 truth.points.size()));
  }
}

/// The part of the errors that is of points; `place(i)`: where point i was laid.
template <typename Place>
RegistrationErrors errorsOfPoints(const Truth& truth, const Cloud& moving, const Place& place) {
  const ErrorSums sums =
      parallelSum<ErrorSums>(moving.size(), kChunk, {}, [&](std::size_t begin, std::size_t end) {
        ErrorSums part;
        for (std::size_t i = begin; i < end; ++i) {
          const Eigen::Vector3d placed = place(i);
          const Eigen::Vector3d affine = truth.best_affine * moving.filePoint(i);
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
  return errors;
}

}  // namespace

RegistrationErrors evaluateAligned(const Cloud& aligned, const Truth& truth, const Cloud& moving) {
  requireTruth(truth, moving);
  if (aligned.size() != moving.size()) {
    throw InputError(
        fmt::format("{}: has {} points, {} has {}; an aligned cloud has one per moving "
                    "point, in the same order",
                    aligned.name, aligned.size(), moving.name, moving.size()));
  }
  return errorsOfPoints(truth, moving, [&](std::size_t i) { return aligned.filePoint(i); });
}

RegistrationErrors evaluateTransform(const Eigen::Affine3d& estimate, const Truth& truth,
                                     const Cloud& moving) {
  requireTruth(truth, moving);
  RegistrationErrors errors = errorsOfPoints(
      truth, moving, [&](std::size_t i) { return (estimate * moving.filePoint(i)).eval(); });
  const Eigen::Vector3d centre = moving.origin + meanPoint(moving);
  errors.translation = (estimate * centre - truth.best_affine * centre).norm();
  const Eigen::Matrix3d difference =
      groundRotation(estimate.linear()).transpose() * groundRotation(truth.best_affine.linear());
  errors.rotation = std::acos(std::clamp((difference.trace() - 1.0) / 2.0, -1.0, 1.0));
  errors.scale = (horizontalScales(estimate).cwiseQuotient(horizontalScales(truth.best_affine)) -
                  Eigen::Vector2d::Ones())
                     .norm();
  return errors;
}

}  // namespace agricolmap::evaluate
