#include "agricolmap/core/affine_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap {
namespace {

constexpr std::size_t kChunk = 1U << 15;

struct Moments {
  Eigen::Matrix3d from_from = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d to_from = Eigen::Matrix3d::Zero();
  Moments& operator+=(const Moments& other) {
    from_from += other.from_from;
    to_from += other.to_from;
    return *this;
  }
};

/// Mean of `value(i)` over i in [0, count).
template <typename Value>
Eigen::Vector3d mean(std::size_t count, const Value& value) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d sum =
      parallelSum(count, kChunk, zero, [&](std::size_t begin, std::size_t end) {
        Eigen::Vector3d part = Eigen::Vector3d::Zero();
        for (std::size_t i = begin; i < end; ++i) part += value(i);
        return part;
      });
  return sum / static_cast<double>(std::max<std::size_t>(count, 1));
}

/// The linear map with the least sum of squares between centred points.
Eigen::Matrix3d linearFrom(const Moments& sums) {
  return sums.from_from.ldlt().solve(sums.to_from.transpose()).transpose();
}

}  // namespace

Eigen::Vector3d meanPoint(const Cloud& cloud) {
  return mean(cloud.size(),
              [&](std::size_t i) -> Eigen::Vector3d { return cloud.xyz[i].cast<double>(); });
}

Eigen::Affine3d fitAffine(const Cloud& cloud, const std::vector<Eigen::Vector3d>& targets) {
  if (cloud.size() != targets.size() || cloud.size() < 4) {
    throw InputError(fmt::format(
        "{}: {} points cannot be compared with {} true positions (equal numbers, at least 4)",
        cloud.name, cloud.size(), targets.size()));
  }
  // Both relative to their means, so that UTM coordinates cost no digits.
  const Eigen::Vector3d from = meanPoint(cloud);
  const Eigen::Vector3d to =
      targets.front() + mean(targets.size(), [&](std::size_t i) -> Eigen::Vector3d {
        return targets[i] - targets.front();
      });
  const Moments sums =
      parallelSum(cloud.size(), kChunk, Moments{}, [&](std::size_t begin, std::size_t end) {
        Moments part;
        for (std::size_t i = begin; i < end; ++i) {
          const Eigen::Vector3d p = cloud.xyz[i].cast<double>() - from;
          part.from_from += p * p.transpose();
          part.to_from += (targets[i] - to) * p.transpose();
        }
        return part;
      });
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.linear() = linearFrom(sums);
  affine.translation() = to - affine.linear() * (cloud.origin + from);
  return affine;
}

Eigen::Affine3d fitAffine(std::span<const Eigen::Vector3d> from,
                          std::span<const Eigen::Vector3d> targets,
                          std::span<const double> weights) {
  double total = 0.0;
  Eigen::Vector3d mean_from = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_to = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    total += weights[i];
    mean_from += weights[i] * from[i];
    mean_to += weights[i] * targets[i];
  }
  mean_from /= total;
  mean_to /= total;
  Moments sums;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3d p = from[i] - mean_from;
    sums.from_from += weights[i] * p * p.transpose();
    sums.to_from += weights[i] * (targets[i] - mean_to) * p.transpose();
  }
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.linear() = linearFrom(sums);
  affine.translation() = mean_to - affine.linear() * mean_from;
  return affine;
}

}  // namespace agricolmap
