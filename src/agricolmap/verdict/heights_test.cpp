#include "agricolmap/verdict/heights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace agricolmap::verdict {
namespace {

refine::VerticalResult bareGround() {
  refine::VerticalResult heights;
  heights.status = refine::VerticalStatus::kOk;
  heights.relief = true;
  heights.ground_seen = 1.0;
  heights.residual = 0.008;
  heights.canopy = 0.2;
  return heights;
}

TEST(Heights, AreMeasuredWhereGroundIsSeen) {
  const HeightsVerdict verdict = judgeHeights(bareGround(), {});
  EXPECT_EQ(verdict.status, HeightsStatus::kMeasured);
  EXPECT_EQ(verdict.limit, HeightsLimit::kNone);
  EXPECT_LT(verdict.deviation, 0.02);
}

TEST(Heights, AreLimitedByPlantsThatHideTheGroundHoweverWellTheyFit) {
  refine::VerticalResult heights = bareGround();
  heights.ground_seen = 0.1;
  const HeightsVerdict hidden = judgeHeights(heights, {});
  EXPECT_TRUE(hidden.limited());
  EXPECT_EQ(hidden.limit, HeightsLimit::kNoGround);
  EXPECT_GT(hidden.deviation, 0.1);  // what may be above the ground is as tall as the plants
  EXPECT_GT(hidden.bias, 0.1);
  EXPECT_THAT(describe(hidden), ::testing::HasSubstr("no ground is seen"));
  heights.ground_seen = 0.4;
  EXPECT_EQ(judgeHeights(heights, {}).limit, HeightsLimit::kCanopy);
  // Seedlings hide less.
  heights.canopy = 0.02;
  EXPECT_FALSE(judgeHeights(heights, {}).limited());
}

TEST(Heights, AreLimitedByALiftThatIsNotKnownWell) {
  refine::VerticalResult heights = bareGround();
  heights.lift = 0.15;
  EXPECT_EQ(judgeHeights(heights, {}).limit, HeightsLimit::kCanopy);
  heights.lift = 0.02;
  EXPECT_FALSE(judgeHeights(heights, {}).limited());
}

TEST(Heights, OfGroundsThatDoNotFitAreLimited) {
  refine::VerticalResult heights = bareGround();
  heights.residual = 0.07;
  EXPECT_EQ(judgeHeights(heights, {}).limit, HeightsLimit::kUneven);
}

TEST(Heights, OfFlatCloudsAreNone) {
  refine::VerticalResult heights = bareGround();
  heights.relief = false;
  const HeightsVerdict verdict = judgeHeights(heights, {});
  EXPECT_EQ(verdict.limit, HeightsLimit::kFlat);
  EXPECT_TRUE(std::isinf(verdict.deviation));
}

}  // namespace
}  // namespace agricolmap::verdict
