#include "agricolmap/4_associate/correlate/hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/transform.hpp"

namespace agricolmap {

Eigen::Matrix2d linearOf(const Hypothesis& hypothesis, const Eigen::Matrix2d& scale_axes) {
  const Eigen::Vector2d scales(hypothesis.scale_x, hypothesis.scale_y);
  return rotation2(hypothesis.yaw) * scale_axes * scales.asDiagonal() * scale_axes.transpose();
}

std::vector<double> coverInterval(double limit, double step) {
  const int count = std::max(1, static_cast<int>(std::ceil(2.0 * limit / step)));
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(limit * ((2.0 * i + 1.0) / count - 1.0));
  return values;
}

std::vector<Hypothesis> coverSpace(const PriorUncertainty& uncertainty,
                                   const Eigen::Vector2d& half_extent, double tolerance) {
  const double yaw_limit = uncertainty.heading_deg * std::numbers::pi / 180.0;
  const double scale_limit = logScaleLimit(uncertainty);
  const double step = 2.0 * tolerance;
  std::vector<Hypothesis> hypotheses;
  for (const double yaw : coverInterval(yaw_limit, step / half_extent.norm())) {
    for (const double x : coverInterval(scale_limit, step / half_extent.x())) {
      for (const double y : coverInterval(scale_limit, step / half_extent.y())) {
        hypotheses.push_back({yaw, std::exp(x), std::exp(y)});
      }
    }
  }
  return hypotheses;
}

}  // namespace agricolmap
