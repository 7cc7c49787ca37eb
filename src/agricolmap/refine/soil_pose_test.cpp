#include "agricolmap/refine/soil_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "agricolmap/map/test_scene.hpp"
#include "agricolmap/refine/multi_start.hpp"

namespace agricolmap::refine {
namespace {

using testing::shifted;
using testing::TestScene;

/// Adds clods of 4 cm that lie where `field_from_map` puts the map's cells, to cells that are not
/// green.
void strew(map::GridMap& map, const Eigen::Affine2d& field_from_map, std::uint64_t seed) {
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      if (!map.valid(map.weight.index(r, c)) || map.exg(r, c) > 0.2F) continue;
      const Eigen::Vector2d p = field_from_map * map.frame.centre(r, c) / 0.04;
      const auto clod = static_cast<std::uint64_t>(1000.0 * std::floor(p.y()) + std::floor(p.x()));
      const auto level = static_cast<std::uint8_t>(Random::stream(seed, clod).uniform(60.0, 160.0));
      map.colour(r, c) = {level, level, level};
    }
  }
}

/// Plants that lean by `lean` between the views, over soil with clods.
TestScene leaning(const Eigen::Vector2d& lean, std::uint64_t clods_there = 5) {
  TestScene scene = testing::testScene({.size = 12.0}, {{0.5, -0.3}, 0.04, 1.04, 0.97});
  strew(scene.fixed, Eigen::Affine2d::Identity(), clods_there);
  // The soil's true pose lies beside the plants'.
  strew(scene.moving, shifted(scene.pose, lean), 5);
  return scene;
}

const Eigen::Vector2d kLean(0.09, -0.05);

TEST(SoilPoseTest, LiesWhereTheSoilLiesAlthoughThePlantsLean) {
  const TestScene scene = leaning(kLean);
  const SoilWitness soil = askSoil(scene.fixed, scene.moving, scene.pose, 1, {});
  EXPECT_GT(soil.share, 0.1);
  EXPECT_GT(soil.peak, 10.0);
  EXPECT_LT(soil.at_plants, 5.0);
  ASSERT_TRUE(soil.pose);
  const Eigen::Vector2d middle = scene.pose.inverse() * scene.middle;
  EXPECT_LT((*soil.pose * middle - (scene.middle + kLean)).norm(), 0.006);
  EXPECT_LT((soil.pose->linear() - scene.pose.linear()).norm(), 0.005);
}

TEST(SoilPoseTest, SoilThatWasTilledOrIsHiddenSaysNothing) {
  const TestScene tilled = leaning(kLean, 6);
  const SoilWitness soil = askSoil(tilled.fixed, tilled.moving, tilled.pose, 1, {});
  EXPECT_GT(soil.share, 0.1);
  EXPECT_FALSE(soil.pose);
  const TestScene scene = leaning(kLean);
  EXPECT_FALSE(askSoil(scene.fixed, scene.moving, scene.pose, 1, {.share = 0.9}).pose);
  EXPECT_FALSE(askSoil(scene.fixed, scene.moving, scene.pose, 1, {.agree = 0.99}).pose);
  EXPECT_FALSE(askSoil(scene.fixed, scene.moving, scene.pose, 1, {.reach = 0.05}).pose);
  // Off the map nothing is shared.
  const SoilWitness off =
      askSoil(scene.fixed, scene.moving, shifted(scene.pose, {200.0, 0.0}), 1, {});
  EXPECT_FALSE(off.pose);
  EXPECT_EQ(off.share, 0.0);
}

TEST(SoilPoseTest, TheRefinementEndsThereUnlessToldNotTo) {
  const TestScene scene = leaning(kLean);
  const auto ends = [&](const map::SignalOptions& signal, bool follow) {
    const correlation::MapSignals fixed(scene.fixed, signal), moving(scene.moving, signal);
    const PairSignals signals(fixed, moving, {}, {});
    DenseRefineOptions options;
    options.soil.follow = follow;
    const auto refined = refineFrom(signals, shifted(scene.pose, {0.03, -0.02}), options);
    return refined ? (refined->pose * (scene.pose.inverse() * scene.middle) - scene.middle).eval()
                   : Eigen::Vector2d::Constant(1e3).eval();
  };
  EXPECT_LT((ends({}, true) - kLean).norm(), 0.006);
  EXPECT_GT((ends({}, false) - kLean).norm(), 0.03);
  // Who wants no luminance compared gets none.
  EXPECT_LT(ends({.term = map::SignalTerm::kExgHeight}, true).norm(), 0.015);
}

TEST(SoilPose, OfPlantsAndSoilThatAgreeTheMeanCountsAndElseTheSoil) {
  const Eigen::Affine2d plants(Eigen::Translation2d(1.0, 2.0));
  SoilWitness soil{.share = 0.3, .peak = 15.0, .at_plants = 15.0, .correlation = 0.6, .pose = {}};
  EXPECT_TRUE(heardTogether(plants, soil).isApprox(plants)) << "it was not clear";
  soil.pose = Eigen::Affine2d(Eigen::Translation2d(1.01, 2.0));
  EXPECT_NEAR(heardTogether(plants, soil).translation().x(), 1.005, 1e-12);
  soil.at_plants = 9.0;
  EXPECT_NEAR(heardTogether(plants, soil).translation().x(), 1.01, 1e-12);
}

}  // namespace
}  // namespace agricolmap::refine
