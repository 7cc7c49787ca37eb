// A shared map as a whole.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "agricolmap/core/error.hpp"
#include "agricolmap/fuse/point_rule.hpp"
#include "agricolmap/fuse/shared_map.hpp"
#include "agricolmap/fuse/test_scene.hpp"

namespace agricolmap::fuse {
namespace {

using test::plantCloud;
using test::plantHeight;

/// A drone's cloud that shows 70 % of the plants' heights, and robots' strips that show all and lie
/// 1 cm higher.
class SharedMapTest : public ::testing::Test {
 protected:
  SharedMapTest()
      : drone_(plantCloud({0.0, 0.0}, {12.0, 12.0}, 0.02, 0.7, 0.0, 1)),
        west_(plantCloud({1.0, 2.0}, {3.0, 9.0}, 0.008, 1.0, 0.01, 2)),
        east_(plantCloud({2.5, 2.0}, {4.5, 9.0}, 0.008, 1.0, 0.01, 3)) {}

  SharedMap shared(bool swapped = false, const FuseOptions& options = {}) const {
    std::vector<StripInput> inputs{{"east", &east_stream_, 20260601, {0.01, 0.01}, false},
                                   {"west", &west_stream_, 20260601, {0.01, 0.01}, false}};
    if (swapped) std::swap(inputs[0], inputs[1]);
    return shareMap(drone_stream_, 20260520, inputs, options);
  }
  static std::size_t cellAt(const SharedMap& map, double x, double y) {
    const Eigen::Vector2d at = map.layers.frame.cellOf({x, y}) + Eigen::Vector2d::Constant(0.5);
    return map.layers.source.index(static_cast<int>(at.y()), static_cast<int>(at.x()));
  }

  Cloud drone_, west_, east_;
  CloudStream drone_stream_{drone_}, west_stream_{west_}, east_stream_{east_};
};

TEST_F(SharedMapTest, StripsReplaceWhatTheySawAndCorrectTheRest) {
  const SharedMap map = shared();
  const Layers& layers = map.layers;
  ASSERT_TRUE(map.bias);
  std::size_t plants = 0;
  double before = 0.0, after = 0.0;
  for (double y = 1.26; y < 11.0; y += 0.5) {
    for (double x = 6.01; x < 11.0; x += 0.5) {  // where no strip was, in plants and beside them
      const std::size_t i = cellAt(map, x, y - 0.25);
      EXPECT_EQ(layers.source[i], kFixedSource);
      const double truth = plantHeight(x, y - 0.25);
      if (truth <= 0.15) continue;
      ++plants;
      before += 0.3 * truth;
      after += std::abs(static_cast<double>(layers.plant_height[i]) - truth);
    }
  }
  ASSERT_GT(plants, 50U);
  EXPECT_LT(after, 0.25 * before);
  const std::size_t inside = cellAt(map, 2.01, 5.51);
  EXPECT_GT(layers.source[inside], kFixedSource);
  EXPECT_NEAR(layers.plant_height[inside], plantHeight(2.01, 5.51), 0.02);
  EXPECT_EQ(layers.date[inside], 20260601);
  EXPECT_FLOAT_EQ(layers.height_error[inside], 0.01F);
  EXPECT_EQ(layers.date[cellAt(map, 8.0, 8.0)], 20260520);
  EXPECT_NEAR(layers.cover[inside], 1.0, 0.1);
  EXPECT_NEAR(layers.cover[cellAt(map, 8.25, 8.25)], 0.0, 0.1);
}

TEST_F(SharedMapTest, NoStepIsLeftAtTheBorderOfAStrip) {
  const SharedMap map = shared();
  double inside = 0.0, outside = 0.0;
  int count = 0;
  for (double y = 3.25; y < 8.5; y += 0.5) {  // between the rows
    inside += double{map.layers.surface[cellAt(map, 1.1, y)]};
    outside += double{map.layers.surface[cellAt(map, 0.92, y)]};
    ++count;
  }
  EXPECT_NEAR(inside / count, 0.01, 0.004);
  EXPECT_NEAR(outside / count, inside / count, 0.005);
  EXPECT_NEAR(map.layers.surface[cellAt(map, 10.25, 10.25)], 0.0, 0.012);
}

TEST_F(SharedMapTest, DoesNotDependOnTheOrderOfStrips) {
  const SharedMap one = shared(), other = shared(true);
  EXPECT_TRUE(
      std::equal(one.layers.source.begin(), one.layers.source.end(), other.layers.source.begin()));
  EXPECT_TRUE(
      std::equal(one.layers.surface.begin(), one.layers.surface.end(), other.layers.surface.begin(),
                 [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
}

TEST_F(SharedMapTest, EveryPlaceHasPointsOfOneSourceAlone) {
  const SharedMap map = shared();
  const PointRule rule(map, {});
  const auto count = [&](const Eigen::Vector3f& place) {
    int sources = rule.ofFixed(place, {}) ? 1 : 0;
    for (std::size_t i = 0; i < map.strips.size(); ++i) {
      if (rule.ofStrip(i, place - map.strips[i].moved.cast<float>(), {})) ++sources;
    }
    return sources;
  };
  for (float x = 0.11F; x < 11.9F; x += 0.37F) {
    for (float y = 0.11F; y < 11.9F; y += 0.37F) EXPECT_EQ(count({x, y, 0.0F}), 1);
  }
  EXPECT_EQ(count({50.0F, 0.0F, 0.0F}), 0);
  const auto raised = rule.ofFixed({8.25F, 8.25F, 0.0F}, {1, 2, 3});
  ASSERT_TRUE(raised);
  EXPECT_FLOAT_EQ(raised->place.z(), raised->raised);
}

TEST_F(SharedMapTest, WithoutStripsItIsTheDronesMap) {
  const SharedMap map = shareMap(drone_stream_, 0, {}, {});
  EXPECT_FALSE(map.bias);
  EXPECT_EQ(map.layers.source[cellAt(map, 2.0, 5.5)], kFixedSource);
  EXPECT_TRUE(std::isnan(map.layers.height_error[cellAt(map, 2.0, 5.5)]));
}

TEST_F(SharedMapTest, StripsOfLimitedHeightsCorrectNothing) {
  const SharedMap map =
      shareMap(drone_stream_, 0, {{"west", &west_stream_, 0, {0.01, 0.1}, true}}, {});
  EXPECT_FALSE(map.bias);
}

TEST_F(SharedMapTest, RefusesWhatDoesNotTouchAndWhatIsNamedTwice) {
  Cloud far = west_;
  far.origin = {500.0, 0.0, 0.0};
  const CloudStream far_stream(far);
  EXPECT_THROW(shareMap(drone_stream_, 0, {{"far", &far_stream, 0, {}, false}}, {}), InputError);
  EXPECT_THROW(
      shareMap(drone_stream_, 0,
               {{"a", &west_stream_, 0, {}, false}, {"a", &east_stream_, 0, {}, false}}, {}),
      UsageError);
}

}  // namespace
}  // namespace agricolmap::fuse
