#include "agricolmap/verdict/evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/correlation/map_signals.hpp"
#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::verdict {
namespace {

using testing::shifted;
using testing::TestScene;

constexpr int kFactor = 3;

class EvidenceTest : public ::testing::Test {
 protected:
  explicit EvidenceTest() { space_.centre = scene_.middle; }
  Evidence at(const Eigen::Affine2d& pose, double rival = 0.0) const {
    return measureEvidence(score_, pose, space_, rival, {});
  }

  const TestScene scene_ = testing::testScene({.size = 12.0}, {{0.6, -0.4}, 0.05, 1.05, 0.96});
  const correlation::MapSignals fixed_{scene_.fixed, {}};
  const correlation::MapSignals moving_{scene_.moving, {}};
  const correlation::StripScore score_{fixed_.at(kFactor), moving_.at(kFactor),
                                       fixed_.filter(kFactor, {})};
  SearchSpace space_;
};

TEST_F(EvidenceTest, BlocksAgreeWithTheTruth) {
  const Evidence evidence = at(scene_.pose);
  ASSERT_GE(evidence.blocks.size(), 8U);
  EXPECT_GE(evidence.agreement(), 0.9);
  EXPECT_GT(evidence.uniqueness, 1.5);
  for (const BlockEvidence& block : evidence.blocks) {
    EXPECT_TRUE(block.place.isApprox(scene_.pose * block.moving));
  }
  // What was cut is told, so that pictures need not guess it.
  EXPECT_TRUE(evidence.strip.centre.isApprox(score_.strip().centre));
  EXPECT_NEAR(evidence.block_size.x(), evidence.block_side, 0.35 * evidence.block_side);
}

TEST_F(EvidenceTest, BlocksSayHowFarAWrongPoseIsOff) {
  const Eigen::Vector2d error(0.24, -0.12);
  const Evidence evidence = at(shifted(scene_.pose, error));
  EXPECT_LT(evidence.agreement(), 0.2);
  std::size_t back = 0;
  for (const BlockEvidence& block : evidence.blocks) {
    if ((block.offset + error).norm() < 0.06) ++back;
  }
  EXPECT_GE(back, evidence.blocks.size() / 2);
}

TEST_F(EvidenceTest, ARivalMakesAPlaceLessUnique) {
  const Evidence alone = at(scene_.pose);
  const Evidence rivalled = at(scene_.pose, 0.9 * alone.significance);
  EXPECT_NEAR(rivalled.uniqueness, 1.0 / 0.9, 1e-9);
  EXPECT_EQ(rivalled.significance, alone.significance);
}

TEST_F(EvidenceTest, ATightGuessDoesNotMakeAPlaceUnique) {
  const Eigen::Affine2d wrong = shifted(scene_.pose, {0.9, 0.4});
  const Evidence wide = at(wrong);
  space_.centre = wrong * scene_.pose.inverse() * scene_.middle;
  space_.uncertainty.translation = 0.1;
  const Evidence tight = at(wrong);
  EXPECT_EQ(tight.significance, wide.significance);
  EXPECT_LE(tight.uniqueness, tight.significance / std::sqrt(5.9));
}

TEST_F(EvidenceTest, BlocksOffTheMapAreNotCounted) {
  const Evidence half = at(shifted(scene_.pose, {5.5, 0.0}));
  EXPECT_LT(half.blocks.size(), at(scene_.pose).blocks.size());
  const Evidence nothing = at(shifted(scene_.pose, {100.0, 0.0}));
  EXPECT_TRUE(nothing.blocks.empty());
  EXPECT_EQ(nothing.agreement(), 0.0);
  EXPECT_EQ(nothing.significance, 0.0);
}

TEST(Evidence, WhatABendGainsByChanceDoesNotCount) {
  Evidence evidence;
  evidence.significance = 6.7;
  evidence.uniqueness = 1.34;
  discountFreedom(evidence, 4.2, 24.0);  // of a mirrored strip
  EXPECT_NEAR(evidence.significance, 4.57, 0.01);
  EXPECT_NEAR(evidence.uniqueness, 1.34 * 4.57 / 6.7, 0.01);
  evidence.significance = 6.0;
  discountFreedom(evidence, 5.9, 24.0);
  EXPECT_EQ(evidence.significance, 5.9);
}

TEST(Evidence, WhatABendGainsBeyondChanceCounts) {
  Evidence evidence;
  evidence.significance = 25.0;
  evidence.uniqueness = 4.0;
  discountFreedom(evidence, 15.0, 24.0);  // of a strip that drifted
  EXPECT_GT(evidence.significance, 24.5);
  EXPECT_GT(evidence.uniqueness, 3.9);
}

}  // namespace
}  // namespace agricolmap::verdict
