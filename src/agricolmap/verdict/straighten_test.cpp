#include "agricolmap/verdict/straighten.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/random.hpp"

namespace agricolmap::verdict {
namespace {

/// Blocks of a strip of two rows, whose true places `bend` moves across it from x = 5 m on, each
/// measured to 2 cm; a share of `lost` anywhere within half a metre.
Evidence evidenceOf(double bend, double lost) {
  Random random(11);
  Evidence evidence;
  evidence.block_side = 1.0;
  for (int col = 0; col < 10; ++col) {
    for (int row = 0; row < 2; ++row) {
      BlockEvidence block;
      block.moving = {col + 0.5, row + 0.5};
      block.place = block.moving;
      const double beyond = std::max(0.0, col + 0.5 - 5.0);
      block.offset = {random.normal(0.02), bend * beyond * beyond / 25.0 + random.normal(0.02)};
      if (random.chance(lost))
        block.offset = {random.uniform(-0.4, 0.4), random.uniform(-0.3, 0.3)};
      block.agrees = block.offset.norm() <= 0.08;
      evidence.agreeing += block.agrees ? 1 : 0;
      evidence.blocks.push_back(block);
    }
  }
  return evidence;
}

TEST(Straighten, ABentStripIsLaidAsWellAsAnAffineCan) {
  for (const double lost : {0.0, 0.2}) {
    const auto pose = straightenedPose(evidenceOf(0.35, lost), Eigen::Matrix2d::Identity());
    ASSERT_TRUE(pose.has_value());
    double before = 0.0, after = 0.0;
    for (const BlockEvidence& block : evidenceOf(0.35, 0.0).blocks) {
      before += block.offset.squaredNorm();
      after += (*pose * block.moving - block.place - block.offset).squaredNorm();
    }
    EXPECT_LT(std::sqrt(after), 0.65 * std::sqrt(before)) << lost;
  }
}

TEST(Straighten, BlocksThatFellForOtherPlantsBendNothing) {
  EXPECT_FALSE(straightenedPose(evidenceOf(0.0, 0.0), Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(straightenedPose(evidenceOf(0.0, 0.3), Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(straightenedPose(Evidence{}, Eigen::Matrix2d::Identity()));
}

}  // namespace
}  // namespace agricolmap::verdict
