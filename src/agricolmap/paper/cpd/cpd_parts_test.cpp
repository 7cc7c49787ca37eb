// The pieces of CPD one by one: the mixer, the fit of a pose to moments, the sums over a mixture.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/paper/cpd/cpd_accelerate.hpp"
#include "agricolmap/paper/cpd/cpd_fit.hpp"
#include "agricolmap/paper/cpd/cpd_kernel.hpp"

namespace agricolmap::paper {
namespace {

TEST(AndersonMixer, FindsTheFixedPointOfALinearMapInAFewSteps) {
  const Eigen::Vector3d rates(0.99, 0.9, 0.3);
  const Eigen::Vector3d goal(1.0, -2.0, 3.0);
  const auto map = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return goal + rates.cwiseProduct(x - goal);
  };
  AndersonMixer mixer(5);
  Eigen::VectorXd x = Eigen::Vector3d::Zero();
  for (int i = 0; i < 8; ++i) x = mixer.next(x, map(x), 10.0);
  EXPECT_LT((x - goal).norm(), 1e-3);
  mixer.restart();
  EXPECT_TRUE(mixer.next(x, map(x), 10.0).isApprox(map(x)));
}

TEST(CpdFit, RecoversPosesFromExactPairs) {
  Random random(9);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Matrix2d axes = rotation2(random.uniform(-3.0, 3.0));
    const Eigen::Vector2d scales(random.uniform(0.7, 1.3), random.uniform(0.7, 1.3));
    CpdPose truth;
    truth.plane.linear() =
        rotation2(random.uniform(-0.5, 0.5)) * axes * scales.asDiagonal() * axes.transpose();
    truth.plane.translation() = Eigen::Vector2d(random.normal(), random.normal());
    truth.height_offset = random.normal();
    CpdMoments moments;
    for (int k = 0; k < 40; ++k) {
      const Eigen::Vector3d y(random.normal(), random.normal(), random.normal());
      Eigen::Vector3d x;
      x << truth.plane * y.head<2>(), y.z() + truth.height_offset;
      moments.add(random.uniform(0.1, 1.0), y, x);
    }
    const auto pose = fitCpdPose(moments);
    ASSERT_TRUE(pose);
    EXPECT_TRUE(pose->plane.isApprox(truth.plane, 1e-9));
    EXPECT_NEAR(pose->height_offset, truth.height_offset, 1e-9);
  }
}

TEST(CpdMixture, SumsAreThoseOfAllPairs) {
  Random random(6);
  std::vector<Eigen::Vector4f> points(3000);
  for (Eigen::Vector4f& p : points) {
    p = Eigen::Vector4d(random.uniform(-2.0, 2.0), random.uniform(-1.0, 1.0), random.normal(0.1),
                        random.uniform())
            .cast<float>();
  }
  const CpdWidths widths{0.1F, 0.2F};
  for (const float bin : {0.03F, 0.1F, 0.5F, 10.0F}) {
    const CpdMixture mixture(points, bin);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d query(random.uniform(-2.5, 2.5), random.uniform(-1.5, 1.5), 0.05);
      double weight = 0.0;
      Eigen::Vector3d offset = Eigen::Vector3d::Zero();
      for (const Eigen::Vector4f& p : points) {
        const Eigen::Vector3d d = p.head<3>().cast<double>() - query;
        if (d.head<2>().norm() > 0.3) continue;
        const double k = static_cast<double>(p.w()) *
                         std::exp(-d.head<2>().squaredNorm() / 0.02 - d.z() * d.z() / 0.08);
        weight += k;
        offset += k * d;
      }
      const CpdSums sums = mixture.at(query.cast<float>(), widths);
      EXPECT_NEAR(static_cast<double>(sums.weight), weight, 1e-3 * weight + 1e-3);
      if (weight > 0.1) {
        EXPECT_LT((sums.mean_offset.cast<double>() - offset / weight).norm(), 1e-3);
      }
    }
  }
}

TEST(CpdMixture, EmptyAndFarPoints) {
  EXPECT_EQ(CpdMixture({}, 0.1F).at({0.0F, 0.0F, 0.0F}, {}).weight, 0.0F);
  const CpdMixture far({{0.0F, 0.0F, 0.0F, 1.0F}, {1e6F, 1e6F, 0.0F, 1.0F}}, 0.01F);
  EXPECT_NEAR(far.at({0.0F, 0.0F, 0.0F}, {}).weight, 1.0F, 1e-5F);
  EXPECT_EQ(far.at({500.0F, -3e5F, 0.0F}, {}).weight, 0.0F);
}

}  // namespace
}  // namespace agricolmap::paper
