#include "agricolmap/locate/hypotheses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::locate {
namespace {

const Eigen::Vector2d kStrip(5.0, 1.1);

TEST(Hypotheses, MetricIsTheMeanSquaredDisplacement) {
  const Eigen::Matrix2d axes = rotation2(0.4), scales = rotation2(-0.3);
  const Hypothesis small{0.002, {1.003, 0.999}};
  const Eigen::Matrix2d change = small.linear(scales) - Eigen::Matrix2d::Identity();
  Random random(1);
  double sum = 0.0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector2d p =
        axes * Eigen::Vector2d(random.uniform(-5.0, 5.0), random.uniform(-1.1, 1.1));
    sum += (change * p).squaredNorm() / kCount;
  }
  const Eigen::Vector3d v = small.vector();
  EXPECT_NEAR(v.dot(displacementMetric(axes, kStrip, scales) * v), sum, 0.03 * sum);
}

TEST(Hypotheses, CoverEveryCornerOfTheUncertainty) {
  const PriorUncertainty uncertainty;
  for (const double turn : {0.0, 0.3, 0.8}) {
    const Eigen::Matrix3d metric =
        displacementMetric(rotation2(turn), kStrip, Eigen::Matrix2d::Identity());
    const auto hypotheses = coverSpace(uncertainty, metric, 0.06);
    Random random(2);
    double worst = 0.0;
    for (int i = 0; i < 300; ++i) {
      const double limit = logScaleLimit(uncertainty);
      const Eigen::Vector3d p(random.uniform(-0.2, 0.2), random.uniform(-limit, limit),
                              random.uniform(-limit, limit));
      double nearest = 1e9;
      for (const Hypothesis& h : hypotheses) {
        const Eigen::Vector3d d = h.vector() - p;
        nearest = std::min(nearest, std::sqrt(d.dot(metric * d)));
      }
      worst = std::max(worst, nearest);
    }
    EXPECT_LT(worst, 0.08) << "turned by " << turn;
    EXPECT_LT(hypotheses.size(), 4000U);
  }
}

TEST(Hypotheses, TheGuessItselfIsOneAndWithoutUncertaintyTheOnlyOne) {
  const Eigen::Matrix3d metric =
      displacementMetric(Eigen::Matrix2d::Identity(), kStrip, Eigen::Matrix2d::Identity());
  const auto one = coverSpace({5.0, 0.0, 0.0}, metric, 0.06);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one.front().vector(), Eigen::Vector3d::Zero());
  const auto many = coverSpace({}, metric, 0.06);
  EXPECT_TRUE(std::any_of(many.begin(), many.end(),
                          [](const Hypothesis& h) { return h.vector().norm() < 1e-12; }));
}

TEST(Hypotheses, TheNearestIsWhatLookingAtAllOfThemFinds) {
  const Eigen::Matrix3d metric =
      displacementMetric(rotation2(0.3), {1.1, 1.1}, Eigen::Matrix2d::Identity());
  Random random(5);
  for (const PriorUncertainty& uncertainty :
       {PriorUncertainty{}, PriorUncertainty::none(), PriorUncertainty{5.0, 11.5, 0.0}}) {
    const auto among = coverSpace(uncertainty, metric, 0.1);
    const NearestHypothesis nearest(among, metric);
    for (int i = 0; i < 100; ++i) {
      const Hypothesis sought{random.uniform(-3.0, 3.0),
                              {random.uniform(0.7, 1.4), random.uniform(0.7, 1.4)}};
      double least = 1e9;
      for (const Hypothesis& h : among) {
        const Eigen::Vector3d d = h.vector() - sought.vector();
        least = std::min(least, d.dot(metric * d));
      }
      const Eigen::Vector3d d = among[nearest.of(sought)].vector() - sought.vector();
      EXPECT_NEAR(d.dot(metric * d), least, 1e-9);
    }
  }
}

TEST(Blocks, ALongStripIsSoughtByItsMostTexturedStretch) {
  map::StripFrame strip;
  strip.half_extent = {15.0, 1.0};
  std::vector<map::Block> blocks;
  for (int i = 0; i < 15; ++i) {
    map::Block block;
    block.low = {-15.0 + 2.0 * i, -1.0};
    block.high = {-13.0 + 2.0 * i, 1.0};
    block.energy = i >= 4 && i < 9 ? 3.0 : 1.0;
    blocks.push_back(block);
  }
  const map::Stretch stretch = map::texturedStretch(blocks, strip, 10.0);
  ASSERT_EQ(stretch.blocks.size(), 5U);
  EXPECT_EQ(stretch.blocks.front().low.x(), -7.0);
  EXPECT_EQ(stretch.half_extent, Eigen::Vector2d(5.0, 1.0));
  EXPECT_EQ(map::texturedStretch(blocks, strip, 40.0).blocks.size(), 15U);
}

}  // namespace
}  // namespace agricolmap::locate
