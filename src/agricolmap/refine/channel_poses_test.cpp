#include "agricolmap/refine/channel_poses.hpp"

#include <gtest/gtest.h>

#include "agricolmap/map/test_field.hpp"

namespace agricolmap::refine {
namespace {

/// Greenness and height from one field of bumps, luminance from another that lies `apart` [m]
/// further east than it should.
map::SignalMap seen(const GridFrame& frame, double apart) {
  const map::Box2 box(Eigen::Vector2d(-2.0, -2.0), Eigen::Vector2d(12.0, 4.0));
  const testing::BumpField plants(3, 400, box, 0.06, 0.06);
  const testing::BumpField stones(4, 400, box, 0.06, 0.06);
  map::SignalMap map;
  map.frame = frame;
  map.weight = Raster<float>(frame.rows, frame.cols, 1.0F);
  for (auto& channel : map.channel) channel = Raster<float>(frame.rows, frame.cols);
  for (int r = 0; r < frame.rows; ++r) {
    for (int c = 0; c < frame.cols; ++c) {
      const Eigen::Vector2d p = frame.centre(r, c);
      map.channel[map::kGreenChannel](r, c) = 20.0F * plants.at(p);
      map.channel[map::kHeightChannel](r, c) = 20.0F * plants.at(p);
      map.channel[map::kLuminanceChannel](r, c) =
          20.0F * stones.at(p - Eigen::Vector2d(apart, 0.0));
    }
  }
  for (double& deviation : map.deviation) deviation = 1.0;
  return map;
}

std::optional<double> disagreement(double apart) {
  return disagreementOfChannels(seen({{-2, -2}, 0.04, 150, 350}, apart),
                                seen({{0, 0}, 0.04, 55, 250}, 0.0), Eigen::Affine2d::Identity(),
                                {});
}

TEST(ChannelPoses, AgreeWherePlantsAndSoilDo) {
  const auto found = disagreement(0.0);
  ASSERT_TRUE(found);
  EXPECT_LT(*found, 0.001);
}

TEST(ChannelPoses, ContradictOneAnotherByHalfOfWhatLiesBetweenThem) {
  const auto found = disagreement(0.04);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 0.02, 0.003);
}

TEST(ChannelPoses, OneAloneContradictsNobody) {
  map::SignalMap fixed = seen({{-2, -2}, 0.04, 150, 350}, 0.04);
  fixed.deviation[map::kLuminanceChannel] = 0.0;
  EXPECT_FALSE(disagreementOfChannels(fixed, seen({{0, 0}, 0.04, 55, 250}, 0.0),
                                      Eigen::Affine2d::Identity(), {}));
}

}  // namespace
}  // namespace agricolmap::refine
