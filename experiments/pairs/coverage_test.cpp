#include "experiments/pairs/coverage.hpp"

#include <gtest/gtest.h>

namespace agricolmap::experiments {
namespace {

/// A strip of points, a registration of it that is off by `error` (at the middle [m], heading
/// [rad]) and states 1 cm, 0.01 rad and 2 cm of height.
Coverage coverageOff(const Eigen::Vector3d& shift, double heading) {
  Cloud moving;
  moving.origin = {10.0, 20.0, 0.0};
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 8; ++j) {
      moving.xyz.emplace_back(0.25F * static_cast<float>(i) - 5.0F,
                              0.25F * static_cast<float>(j) - 1.0F, 0.0F);
    }
  }
  Cloud fixed;
  fixed.origin = {464000.0, 5257000.0, 500.0};
  evaluate::Truth truth;
  truth.best_affine = Eigen::Translation3d(fixed.origin - moving.origin);
  StatedError stated;
  stated.pose.covariance.setZero();
  stated.pose.covariance.diagonal() << 1e-4, 1e-4, 1e-4, 1e-4, 1e-4;
  stated.pose.height_deviation = 0.02;
  const Eigen::Affine3d found = Eigen::Translation3d(fixed.origin + shift) *
                                Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                                Eigen::Translation3d(-moving.origin);
  return coverageOf(found, stated, fixed, moving, truth).value();
}

TEST(Coverage, IsTheErrorInDeviationsThatAreStated) {
  const Coverage none = coverageOff(Eigen::Vector3d::Zero(), 0.0);
  EXPECT_NEAR(none.pose_distance2, 0.0, 1e-9);
  const Coverage shifted = coverageOff({0.03, -0.04, 0.06}, 0.0);
  EXPECT_NEAR(shifted.error.x(), -0.03, 1e-6);
  EXPECT_NEAR(shifted.error.y(), 0.04, 1e-6);
  EXPECT_NEAR(shifted.shift_distance2, 25.0, 1e-3);
  EXPECT_NEAR(shifted.pose_distance2, 25.0, 1e-3);
  EXPECT_NEAR(shifted.height_distance2, 9.0, 1e-6);
  const Coverage turned = coverageOff(Eigen::Vector3d::Zero(), 0.02);
  EXPECT_NEAR(turned.error(2), -0.02, 1e-4);
  EXPECT_NEAR(turned.pose_distance2, 4.0, 0.1);
  EXPECT_NEAR(turned.shift_distance2, 0.0, 1e-3);
}

}  // namespace
}  // namespace agricolmap::experiments
