#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "agricolmap/report/page/page_maps.hpp"
#include "agricolmap/report/page/page_points.hpp"
#include "agricolmap/report/page/registration_page.hpp"
#include "agricolmap/report/test_registration.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

/// `count` points on a square of side 10 m.
Cloud carpet(std::size_t count) {
  Cloud cloud;
  Random random(3);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.xyz.emplace_back(static_cast<float>(random.uniform(0.0, 10.0)),
                           static_cast<float>(random.uniform(0.0, 10.0)),
                           static_cast<float>(random.uniform(0.0, 0.4)));
    cloud.rgb.push_back({static_cast<std::uint8_t>(i), 2, 3});
  }
  return cloud;
}

const Eigen::AlignedBox2d kHalf(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(5.0, 10.0));

TEST(PagePoints, ASampleIsFairAndCounted) {
  const Cloud cloud = carpet(40'000);
  const PointSample sample =
      samplePoints(CloudStream(cloud), Eigen::Affine3d::Identity(), kHalf, 3'000);
  EXPECT_EQ(sample.xyz.size(), 3'000U);
  EXPECT_EQ(sample.rgb.size(), 3'000U);
  EXPECT_NEAR(static_cast<double>(sample.of), 20'000.0, 500.0);
  std::array<int, 4> quarters{};
  for (const Eigen::Vector3f& point : sample.xyz) {
    ASSERT_LE(point.x(), 5.0F);
    ++quarters[(point.x() < 2.5F ? 0U : 1U) + (point.y() < 5.0F ? 0U : 2U)];
  }
  // Six standard deviations of a fair draw.
  for (const int quarter : quarters) EXPECT_NEAR(quarter, 750, 143);
}

TEST(PagePoints, TheSameComeWhateverTheirOrder) {
  Cloud cloud = carpet(20'000);
  const auto packed = [&] {
    return packedPoints(
        samplePoints(CloudStream(cloud), Eigen::Affine3d::Identity(), kHalf, 1'000));
  };
  const Json first = packed();
  std::reverse(cloud.xyz.begin(), cloud.xyz.end());
  std::reverse(cloud.rgb.begin(), cloud.rgb.end());
  EXPECT_EQ(packed(), first);
}

TEST(PagePoints, FewPointsAndNoneArePacked) {
  EXPECT_EQ(packedPoints({})["count"], 0);
  const Json two = packedPoints({{{1.0F, 2.0F, 3.0F}, {71.0F, 2.0F, 3.0F}}, {}, 2});
  EXPECT_EQ(two["count"], 2);
  EXPECT_FALSE(two["coloured"]);
  // 16 bits do not hold 70 m of millimetres.
  EXPECT_DOUBLE_EQ(two["step_m"].get<double>(), 70.0 / 65535.0);
}

TEST(PageMaps, HaveLayersFramesAndABoundedSize) {
  pipeline::Registration registration = testing::testRegistration({.field = 40.0});
  const Json maps = pageMaps(registration, {}, {}, {true, true});
  ASSERT_EQ(maps["fixed"].size(), 2U);  // 40 m of 2 cm are too much: all of it, and about the strip
  EXPECT_EQ(maps["fixed"][0]["pixel_m"], 0.06);
  EXPECT_EQ(maps["fixed"][1]["pixel_m"], 0.02);
  for (const Json& picture : {maps["fixed"][0], maps["fixed"][1], maps["moving"]["picture"]}) {
    EXPECT_LE(picture["cols"].get<int>() * picture["rows"].get<int>(), 700'000);
    for (const char* layer : {"colour", "exg", "height"}) {
      EXPECT_TRUE(picture["layers"].contains(layer)) << layer;
    }
  }
  EXPECT_EQ(maps["moving"]["picture"]["rectangle_m"].size(), 4U);
  // The lower left corner of the strip's picture lies where the pose lays the map's.
  const Eigen::Vector2d corner = registration.placed->pose * registration.maps.moving.frame.corner;
  EXPECT_NEAR(maps["moving"]["after"][4].get<double>(), corner.x(), 1e-9);
  EXPECT_NEAR(maps["moving"]["after"][5].get<double>(), corner.y(), 1e-9);
}

TEST(PageMaps, CloudsWithoutColoursHaveHeightsAlone) {
  const Json maps = pageMaps(testing::testRegistration(), {}, {}, {true, false});
  EXPECT_TRUE(maps["fixed"][0]["layers"].contains("colour"));
  EXPECT_FALSE(maps["moving"]["picture"]["layers"].contains("colour"));
  EXPECT_TRUE(maps["moving"]["picture"]["layers"].contains("height"));
}

TEST(PageMaps, FlatCloudsHaveNoLayerOfHeights) {
  pipeline::Registration registration = testing::testRegistration();
  std::fill(registration.maps.moving.height.begin(), registration.maps.moving.height.end(), 0.0F);
  const Json flat = pageMaps(registration, {}, {}, {true, true});
  EXPECT_FALSE(flat["moving"]["picture"]["layers"].contains("height"));
  EXPECT_TRUE(flat["moving"]["picture"]["layers"].contains("colour"));
  // Of clouds without colours it is all there is.
  const Json bare = pageMaps(registration, {}, {}, {false, false});
  EXPECT_TRUE(bare["moving"]["picture"]["layers"].contains("height"));
}

TEST(PageMaps, WithoutAPlaceTheStripLiesAsGuessed) {
  pipeline::Registration registration = testing::testRegistration();
  registration.placed.reset();
  registration.transform.reset();
  const Json maps = pageMaps(registration, {}, {}, {true, true});
  EXPECT_FALSE(maps["moving"].contains("after"));
  EXPECT_TRUE(maps["moving"].contains("before"));
}

}  // namespace
}  // namespace agricolmap::report
