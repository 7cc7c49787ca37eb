#include "agricolmap/pipeline/refinement.hpp"

#include <gtest/gtest.h>

#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::pipeline {
namespace {

using testing::shifted;
using testing::TestScene;

class RefinementTest : public ::testing::Test {
 protected:
  Refined refined(const std::vector<Placement>& placements,
                  const RegistrationOptions& options) const {
    return refinePlacements(signals_, placements, Eigen::Matrix2d::Identity(), options);
  }
  Placement at(const Eigen::Affine2d& pose) const {
    return {.pose = pose, .score = 1.0, .matches = {}};
  }
  /// A placement found by matching `count` points a side over the strip.
  Placement matched(const Eigen::Affine2d& pose, int count) const {
    Placement placement = at(pose);
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const Eigen::Vector2d q =
            scene_.middle + Eigen::Vector2d(4.0 * i / count - 2.0, 1.4 * j / count - 0.7);
        placement.matches.push_back({q, pose * q});
      }
    }
    return placement;
  }
  double off(const Refined& refined) const {
    return refined.best ? signals_.score().distance(refined.best->pose, scene_.pose) : 1e9;
  }

  const TestScene scene_ = testing::testScene({.size = 12.0}, {{0.5, -0.3}, 0.04, 1.04, 0.97});
  const correlation::MapSignals fixed_{scene_.fixed, {}};
  const correlation::MapSignals moving_{scene_.moving, {}};
  const refine::PairSignals signals_{fixed_, moving_, {}, {}};
};

TEST_F(RefinementTest, KnowsWhichPlacementWon) {
  const Refined dense =
      refined({at(shifted(scene_.pose, {1.3, 0.8})), at(shifted(scene_.pose, {0.06, 0.04}))}, {});
  ASSERT_TRUE(dense.best);
  EXPECT_EQ(dense.best->start, 1U);
  EXPECT_LT(off(dense), 0.01);
  EXPECT_EQ(dense.best->factor, 1);  // it followed the maps to their finest cells
}

TEST_F(RefinementTest, StartsFromTheAffineOfItsMatches) {
  Placement placement = matched(shifted(scene_.pose, {0.05, 0.0}), 5);
  placement.pose = shifted(scene_.pose, {3.0, 3.0});  // a vote's bin, say
  EXPECT_LT(off(refined({placement}, {})), 0.01);
}

TEST_F(RefinementTest, APlacementWithTooFewMatchesDoesNotTakeTheOthersWithIt) {
  RegistrationOptions options;
  options.refine = RefineKind::kCpd;
  const Refined points =
      refined({matched(shifted(scene_.pose, {2.0, 2.0}), 2), matched(scene_.pose, 5)}, options);
  ASSERT_TRUE(points.best) << points.failure;
  EXPECT_EQ(points.best->start, 1U);
  EXPECT_LT(off(points), 0.05);
  EXPECT_TRUE(points.cpd);
  const Refined nothing = refined({matched(scene_.pose, 2)}, options);
  EXPECT_FALSE(nothing.best);
  EXPECT_FALSE(nothing.failure.empty());
}

TEST_F(RefinementTest, SaysWhyThereIsNone) {
  EXPECT_FALSE(refined({}, {}).failure.empty());
  const Refined off_map = refined({at(shifted(scene_.pose, {100.0, 0.0}))}, {});
  EXPECT_FALSE(off_map.best);
  EXPECT_EQ(off_map.held, 0U);
  EXPECT_FALSE(off_map.failure.empty());
}

}  // namespace
}  // namespace agricolmap::pipeline
