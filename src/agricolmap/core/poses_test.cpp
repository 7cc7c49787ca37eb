// How far poses are apart, which of many are distinct, and the fit of one to matches.
#include <gtest/gtest.h>

#include <vector>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/keep_distinct.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/scaled_rotation.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap {
namespace {

TEST(PoseDistance, IsThatOfTheFarthestCorner) {
  const auto corners =
      cornersOf(Eigen::AlignedBox2d(Eigen::Vector2d(-5.0, -1.0), Eigen::Vector2d(5.0, 1.0)));
  const Eigen::Affine2d start(Eigen::Translation2d(3.0, 4.0));
  EXPECT_EQ(poseDistance(corners, start, start), 0.0);
  EXPECT_NEAR(poseDistance(corners, start, Eigen::Translation2d(0.3, 0.4) * start), 0.5, 1e-12);
  Eigen::Affine2d stretched = start;
  stretched.linear() = Eigen::Vector2d(1.1, 1.0).asDiagonal();
  EXPECT_NEAR(poseDistance(corners, start, stretched), 0.5, 1e-12);
  Eigen::Affine2d turned = start;
  turned.linear() = rotation2(0.01);
  EXPECT_NEAR(poseDistance(corners, start, turned), 0.01 * std::hypot(5.0, 1.0), 1e-6);
}

TEST(PoseDistance, NoPointOfTheBoxIsFartherThanACorner) {
  Random random(11);
  const Eigen::AlignedBox2d box(Eigen::Vector2d(-2.0, -1.0), Eigen::Vector2d(4.0, 3.0));
  for (int i = 0; i < 200; ++i) {
    Eigen::Affine2d a, b;
    a.matrix() << random.normal(), random.normal(), random.normal(), random.normal(),
        random.normal(), random.normal(), 0.0, 0.0, 1.0;
    b.matrix() << random.normal(), random.normal(), random.normal(), random.normal(),
        random.normal(), random.normal(), 0.0, 0.0, 1.0;
    const Eigen::Vector2d inside(random.uniform(-2.0, 4.0), random.uniform(-1.0, 3.0));
    EXPECT_LE((a * inside - b * inside).norm(), poseDistance(cornersOf(box), a, b) + 1e-12);
  }
}

TEST(KeepDistinct, TheFirstOfEachNeighbourhoodStays) {
  const auto near = [](double better, double one) { return std::abs(better - one) < 1.0; };
  const std::vector<double> sorted = {5.0, 5.5, 9.0, 4.2, 6.3, 8.1};
  EXPECT_EQ(keepDistinct(sorted, near), (std::vector<double>{5.0, 9.0, 6.3}));
  EXPECT_EQ(keepDistinct(sorted, near, 2), (std::vector<double>{5.0, 9.0}));
  EXPECT_TRUE(keepDistinct(sorted, near, 0).empty());
  EXPECT_TRUE(keepDistinct(std::vector<double>{}, near).empty());
}

TEST(KeepDistinct, WhatWasLeftOutHidesNothing) {
  // 1.5 is near 0.8, which is left out for 0: only what is kept counts.
  const auto near = [](double better, double one) { return std::abs(better - one) < 1.0; };
  EXPECT_EQ(keepDistinct(std::vector<double>{0.0, 0.8, 1.5}, near),
            (std::vector<double>{0.0, 1.5}));
}

TEST(YawScales, ComeBackFromTheirVector) {
  const YawScales one{0.3, {1.2, 0.7}};
  const YawScales back = YawScales::fromVector(one.vector());
  EXPECT_DOUBLE_EQ(back.yaw, one.yaw);
  EXPECT_TRUE(back.scale.isApprox(one.scale, 1e-14));
  const Eigen::Matrix2d axes = rotation2(0.4);
  EXPECT_TRUE(one.linear(axes).isApprox(
      rotation2(0.3) * axes * Eigen::Vector2d(1.2, 0.7).asDiagonal() * axes.inverse(), 1e-14));
}

TEST(YawScales, AreFoundFromMomentsWhateverTheAxes) {
  Random random(12);
  for (int i = 0; i < 100; ++i) {
    Eigen::Matrix2d axes = rotation2(random.uniform(-3.1, 3.1));
    if (i % 2 == 1) axes.col(1) *= -1.0;  // left-handed, as a file's axes may be
    const YawScales truth{random.uniform(-3.1, 3.1),
                          {random.uniform(0.5, 1.5), random.uniform(0.5, 1.5)}};
    Eigen::Matrix2d products = Eigen::Matrix2d::Zero(), spread = Eigen::Matrix2d::Zero();
    for (int k = 0; k < 10; ++k) {
      const Eigen::Vector2d q(random.normal(), random.normal());
      const Eigen::Vector2d u = axes.transpose() * q;
      products += truth.linear(axes) * q * u.transpose();
      spread += u * u.transpose();
    }
    const auto found = fitYawScales(products, spread, axes);
    ASSERT_TRUE(found);
    EXPECT_NEAR(wrapAngle(found->yaw - truth.yaw), 0.0, 1e-9);
    EXPECT_TRUE(found->scale.isApprox(truth.scale, 1e-9));
  }
}

TEST(YawScales, AMirrorIsNoRotation) {
  Eigen::Matrix2d mirror = Eigen::Matrix2d::Identity();
  mirror(1, 1) = -1.0;
  EXPECT_FALSE(fitYawScales(mirror, Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity()));
}

}  // namespace
}  // namespace agricolmap
