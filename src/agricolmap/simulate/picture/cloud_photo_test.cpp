#include "agricolmap/simulate/picture/cloud_photo.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/report/draw/outline.hpp"

namespace agricolmap::simulate {
namespace {

using report::GroundRect;
using report::View;

constexpr Rgb kSoil{140, 110, 80};
constexpr Rgb kLeaf{40, 160, 50};
constexpr std::uint32_t kSoilPixel = 0x8C6E50;
constexpr std::uint32_t kLeafPixel = 0x28A032;

/// `width` × `height` m of points every `spacing`, shaken by a third of that.
Cloud sheet(double width, double height, double spacing, float z, const Rgb& colour) {
  Cloud cloud;
  cloud.origin = {432000.0, 5200000.0, 400.0};
  Random random(3);
  for (double y = 0.5 * spacing; y < height; y += spacing) {
    for (double x = 0.5 * spacing; x < width; x += spacing) {
      const double dx = random.uniform(-0.33, 0.33) * spacing;
      const double dy = random.uniform(-0.33, 0.33) * spacing;
      cloud.xyz.emplace_back(static_cast<float>(x + dx), static_cast<float>(y + dy), z);
      cloud.rgb.push_back(colour);
    }
  }
  return cloud;
}

void append(Cloud& cloud, const Cloud& more, const Eigen::Vector3f& shift) {
  for (const Eigen::Vector3f& p : more.xyz) cloud.xyz.push_back(p + shift);
  cloud.rgb.insert(cloud.rgb.end(), more.rgb.begin(), more.rgb.end());
}

std::uint32_t pixelAt(const Raster<std::uint32_t>& photo, const View& view,
                      const Eigen::Vector2d& ground) {
  const Eigen::Vector2d at = view.pixel(ground) - Eigen::Vector2d(view.rect.x, view.rect.y);
  return photo(static_cast<int>(at.y()), static_cast<int>(at.x()));
}

TEST(CloudPhoto, KnowsSpacingAndOutline) {
  Cloud cloud = sheet(3.0, 1.0, 0.01, 0.0F, kSoil);
  Random random(4);
  for (int i = 0; i < 20; ++i) {  // flying points around it
    cloud.xyz.emplace_back(static_cast<float>(random.uniform(-3.0, 6.0)),
                           static_cast<float>(random.uniform(2.0, 4.0)), 1.0F);
    cloud.rgb.push_back(kLeaf);
  }
  Eigen::Affine3d turned = Eigen::Affine3d::Identity();
  turned.linear().topLeftCorner<2, 2>() = rotation2(0.7);
  const CloudPhoto photo(cloud, turned);
  EXPECT_NEAR(photo.spacing(), 0.01, 0.001);
  const GroundRect outline = report::smallestRectangle(photo.outline());
  EXPECT_NEAR(outline.half_extent.x(), 1.5, 0.06);
  EXPECT_NEAR(outline.half_extent.y(), 0.5, 0.06);
  EXPECT_LT((outline.centre - rotation2(0.7) * Eigen::Vector2d(1.5, 0.5)).norm(), 0.06);
}

TEST(CloudPhoto, ShowsThingsWhereTheyAreAtAnyScale) {
  Cloud cloud = sheet(4.0, 2.0, 0.01, 0.0F, kSoil);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.xyz[i].x() > 2.0F) cloud.rgb[i] = kLeaf;
  }
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear().topLeftCorner<2, 2>() = rotation2(0.4) * 1.1;
  pose.translation() = Eigen::Vector3d(7.0, -3.0, 2.0);
  const CloudPhoto photo(cloud, pose);
  const auto ground = [&](double x, double y) {
    return Eigen::Vector2d((pose * Eigen::Vector3d(x, y, 0.0)).head<2>());
  };
  for (const double scale : {20.0, 90.0, 300.0}) {
    const View view{{11, 5, 300, 200}, ground(2.0, 1.0), rotation2(0.2), scale};
    const Raster<std::uint32_t> picture = photo.shoot(view);
    ASSERT_EQ(picture.rows(), 200);
    ASSERT_EQ(picture.cols(), 300);
    const double step = 3.0 / scale + 0.012;  // pixels and points beside the border
    EXPECT_EQ(pixelAt(picture, view, ground(2.0 - step, 1.0)), kSoilPixel) << scale;
    EXPECT_EQ(pixelAt(picture, view, ground(2.0 + step, 1.0)), kLeafPixel) << scale;
    if (scale < 50.0) {
      EXPECT_EQ(pixelAt(picture, view, ground(2.0, 2.3)), CloudPhoto::kNothing);
      EXPECT_EQ(pixelAt(picture, view, ground(4.3, 1.0)), CloudPhoto::kNothing);
    } else if (scale > 200.0) {
      for (const std::uint32_t pixel : picture) ASSERT_NE(pixel, CloudPhoto::kNothing);
    }
  }
}

TEST(CloudPhoto, LeavesHideTheSoilUnderThem) {
  Cloud cloud = sheet(1.0, 1.0, 0.01, 0.0F, kSoil);
  append(cloud, sheet(0.4, 0.4, 0.01, 0.0F, kLeaf), {0.3F, 0.3F, 0.2F});
  const CloudPhoto photo(cloud, Eigen::Affine3d::Identity());
  const View view{{0, 0, 100, 100}, {0.5, 0.5}, Eigen::Matrix2d::Identity(), 100.0};
  const Raster<std::uint32_t> picture = photo.shoot(view);
  EXPECT_EQ(pixelAt(picture, view, {0.5, 0.5}), kLeafPixel);
  EXPECT_EQ(pixelAt(picture, view, {0.15, 0.5}), kSoilPixel);
}

TEST(CloudPhoto, ClosesGapsButNotHoles) {
  Cloud cloud = sheet(1.0, 1.0, 0.01, 0.0F, kSoil);
  Cloud holed;
  holed.origin = cloud.origin;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector2f p = cloud.xyz[i].head<2>();
    if ((p - Eigen::Vector2f(0.3F, 0.5F)).norm() < 0.015F) continue;  // a gap
    if ((p - Eigen::Vector2f(0.7F, 0.5F)).norm() < 0.12F) continue;   // a hole
    holed.xyz.push_back(cloud.xyz[i]);
    holed.rgb.push_back(cloud.rgb[i]);
  }
  const CloudPhoto photo(holed, Eigen::Affine3d::Identity());
  for (const double scale : {60.0, 200.0}) {
    const View view{{0, 0, 60, 40}, {0.5, 0.5}, Eigen::Matrix2d::Identity(), scale};
    const View wide{{0, 0, 200, 200}, {0.5, 0.5}, Eigen::Matrix2d::Identity(), scale};
    EXPECT_EQ(pixelAt(photo.shoot(wide), wide, {0.3, 0.5}), kSoilPixel) << scale;
    EXPECT_EQ(pixelAt(photo.shoot(wide), wide, {0.7, 0.5}), CloudPhoto::kNothing) << scale;
    EXPECT_EQ(photo.shoot(view).size(), 2400U);
  }
}

TEST(CloudPhoto, NeedsColours) {
  Cloud cloud = sheet(1.0, 1.0, 0.1, 0.0F, kSoil);
  cloud.rgb.clear();
  EXPECT_THROW(CloudPhoto(cloud, Eigen::Affine3d::Identity()), UsageError);
  EXPECT_THROW(CloudPhoto(Cloud{}, Eigen::Affine3d::Identity()), UsageError);
}

}  // namespace
}  // namespace agricolmap::simulate
