#include "agricolmap/pipeline/unknown_scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace agricolmap::pipeline {
namespace {

map::Box2 box(double width, double height) {
  return map::Box2(Eigen::Vector2d::Zero(), Eigen::Vector2d(width, height));
}

TEST(ScaleFactors, LeaveNoGapBetweenATenthAndTen) {
  const PriorUncertainty uncertainty;
  std::vector<double> factors = scaleFactors(box(10.0, 2.2), box(1000.0, 1000.0), uncertainty);
  EXPECT_EQ(factors.front(), 1.0);
  std::sort(factors.begin(), factors.end());
  const double reach = std::exp(logScaleLimit(uncertainty));
  EXPECT_GE(factors.back() * reach, 10.0);
  for (std::size_t i = 1; i < factors.size(); ++i) {
    EXPECT_LE(factors[i] / factors[i - 1], reach * reach);
  }
  // Smaller ones leave 22 square metres with less than a few plants.
  EXPECT_LE(factors.front(), 0.3);
}

TEST(ScaleFactors, LeaveOutWhatDoesNotFit) {
  const std::vector<double> factors = scaleFactors(box(10.0, 2.2), box(20.0, 20.0), {});
  ASSERT_FALSE(factors.empty());
  EXPECT_LT(*std::max_element(factors.begin(), factors.end()), 9.0);
  EXPECT_TRUE(scaleFactors(box(1000.0, 1000.0), box(1.0, 1.0), {}).empty());
}

}  // namespace
}  // namespace agricolmap::pipeline
