#include "agricolmap/map/level.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::map {
namespace {

/// A 10 × 2.2 m strip with plants on 30 % of it and flying points.
Cloud makeStrip(double roll_deg, double pitch_deg, double height) {
  Random random(7);
  const Eigen::Affine3d tilt(Eigen::Translation3d(0, 0, height) *
                             Eigen::AngleAxisd(radians(roll_deg), Eigen::Vector3d::UnitX()) *
                             Eigen::AngleAxisd(radians(pitch_deg), Eigen::Vector3d::UnitY()));
  Cloud cloud;
  cloud.name = "strip";
  for (int i = 0; i < 50000; ++i) {
    Eigen::Vector3d p(random.uniform(0, 10), random.uniform(0, 2.2), random.normal(0.01));
    if (random.chance(0.3)) p.z() += random.uniform(0.0, 0.2);
    if (random.chance(0.01)) p.z() += random.normal(2.0);
    cloud.xyz.push_back((tilt * p).cast<float>());
  }
  return cloud;
}

/// Points of a strip, drawn with `seed`, of which `rise(point, random)` says how high over the
/// ground each lies [m].
template <typename Rise>
Cloud cropStrip(int seed, int count, const Rise& rise) {
  Random random(static_cast<std::uint64_t>(seed));
  Cloud cloud;
  cloud.name = "crop";
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d p(random.uniform(0, 10), random.uniform(0, 2.2), random.normal(0.01));
    p.z() += rise(p, random);
    cloud.xyz.push_back(p.cast<float>());
  }
  return cloud;
}

TEST(Level, FindsTheGroundUnderPlantsAndFlyingPoints) {
  for (const double roll : {0.0, 3.0, -10.0, 30.0}) {
    const Cloud cloud = makeStrip(roll, 2.0, 5.0);
    const Levelling level = levelCloud(cloud, Eigen::Affine3d::Identity(), {});
    double worst = 0.0;
    const Cloud flat = makeStrip(0, 0, 0);
    for (std::size_t i = 0; i < cloud.size(); i += 97) {
      const Eigen::Vector3d p = level.levelled_from_guess * cloud.xyz[i].cast<double>();
      if (std::abs(flat.xyz[i].z()) < 0.2F) {
        worst = std::max(worst, std::abs(p.z() - static_cast<double>(flat.xyz[i].z())));
      }
    }
    EXPECT_LT(worst, 0.03) << "roll " << roll;
  }
}

// As thick as it is wide: the plane through all its points stands on edge.
TEST(Level, ANarrowStripOfATallCropStandsUpright) {
  const Cloud cloud = cropStrip(8, 50000, [](const Eigen::Vector3d&, Random& random) {
    return random.chance(0.7) ? (random.chance(0.5) ? 0.2 : 2.2) : 0.0;
  });
  const Levelling level = levelCloud(cloud, Eigen::Affine3d::Identity(), {});
  EXPECT_LT(level.tilt, 0.02);
}

// It stands on a handful of cells, which lie in a line and are level.
TEST(Level, AStripOnItsEdgeIsRefusedAsTilted) {
  for (const auto& [roll, pitch] : {std::pair{90.0, 0.0}, {80.0, 0.0}, {0.0, 90.0}, {100.0, 1.0}}) {
    Random random(7);
    const Eigen::Affine3d tilt(Eigen::AngleAxisd(radians(roll), Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(radians(pitch), Eigen::Vector3d::UnitY()));
    Cloud cloud;
    cloud.name = "strip";
    for (int i = 0; i < 50000; ++i) {
      // Rough ground, so that a canopy is thought of.
      Eigen::Vector3d p(random.uniform(0, 10), random.uniform(0, 3.7), random.normal(0.05));
      p.z() += 0.06 * std::sin(2.0 * p.x()) * std::sin(3.0 * p.y());
      if (random.chance(0.3)) p.z() += random.uniform(0.0, 0.5);
      cloud.xyz.push_back((tilt * p).cast<float>());
    }
    try {
      levelCloud(cloud, Eigen::Affine3d::Identity(), {});
      ADD_FAILURE() << "roll " << roll << ", pitch " << pitch << " was taken as level";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("tilted by"), std::string::npos) << error.what();
    }
  }
}

TEST(Level, AsksForTheUnitsOfACloudThatSeemsSparse) {
  Random random(7);
  Cloud cloud;
  cloud.name = "centimetres";
  for (int i = 0; i < 2000; ++i) {
    cloud.xyz.emplace_back(random.uniform(0, 2000), random.uniform(0, 220), random.normal(1.0));
  }
  try {
    levelCloud(cloud, Eigen::Affine3d::Identity(), {});
    ADD_FAILURE() << "levelled";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_LT(what.find("metres?"), what.find("too sparse")) << what;
    EXPECT_EQ(what.find("e+"), std::string::npos) << what;
  }
}

// Under a canopy that nearly closes one point in twenty is of the ground, and the lower leaves of a
// crop that grows better on one side make a plane of their own.
TEST(Level, FindsTheGroundUnderATallCropThatNearlyCloses) {
  const Cloud cloud = cropStrip(9, 100000, [](const Eigen::Vector3d& p, Random& random) {
    return random.chance(0.95) ? (0.4 + 0.3 * p.y()) * random.uniform(0.5, 2.0) : 0.0;
  });
  const Levelling level = levelCloud(cloud, Eigen::Affine3d::Identity(), {});
  EXPECT_LT(level.tilt, 0.02);
  EXPECT_LT(level.roughness, 0.03);
}

// Four cells of five show canopy only, which is higher on one side; a few points lie below ground.
TEST(Level, FindsTheGroundThatAClosedCanopyShowsInAFewCells) {
  const Cloud cloud = cropStrip(10, 100000, [](const Eigen::Vector3d& p, Random& random) {
    const bool hole =
        std::fmod(p.x(), 0.5) < 0.1 && std::fmod(0.37 * std::floor(p.x() / 0.5), 1) < 0.4;
    const double canopy = hole ? 0.0 : 0.3 + 0.1 * p.y() + random.uniform(0.0, 0.2);
    return canopy - (random.chance(1e-4) ? 0.3 : 0.0);
  });
  const Levelling level = levelCloud(cloud, Eigen::Affine3d::Identity(), {});
  EXPECT_TRUE(level.under_canopy);
  EXPECT_LT(level.support, 1.0);
  EXPECT_LT(level.tilt, 0.01);
  EXPECT_LT(level.roughness, 0.03);
  EXPECT_NEAR((level.levelled_from_guess * Eigen::Vector3d(5.0, 1.1, 0.0)).z(), 0.0, 0.03);
}

// As stereo makes them in the shade of tall plants: the lowest plane that cells support is of
// these.
TEST(Level, StrayPointsBelowTheGroundDoNotTiltIt) {
  Cloud cloud = cropStrip(11, 40000, [](const Eigen::Vector3d& p, Random& random) {
    const double leaves = 0.3 + 0.6 * std::abs(std::sin(3.0 * p.x()) * std::cos(5.0 * p.y()));
    return random.chance(0.95) ? random.uniform(leaves, 2.0) : 0.0;
  });
  for (double x = 0.25; x < 10.0; x += 0.5) {
    for (double y = 0.25; y < 1.5; y += 0.5) {
      cloud.xyz.emplace_back(Eigen::Vector3d(x, y, -0.6 + 0.32 * y).cast<float>());
    }
  }
  const Levelling level = levelCloud(cloud, Eigen::Affine3d::Identity(), {});
  EXPECT_LT(degrees(level.tilt), 1.0);
  EXPECT_TRUE(level.under_canopy);
}

// A cloud from rasters: every fifth column is a row of plants, and one point in five is looked at.
TEST(Level, LooksAtAllColumnsOfACloudInRasterOrder) {
  Random random(11);
  Cloud cloud;
  cloud.name = "raster";
  constexpr int kSide = 1000;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double height = random.normal(0.01) + (col % 5 == 0 ? 0.3 : 0.0);
      cloud.xyz.push_back(Eigen::Vector3d(0.02 * col, 0.02 * row, height).cast<float>());
    }
  }
  const Levelling level = levelCloud(cloud, Eigen::Affine3d::Identity(), {});
  EXPECT_NEAR((level.levelled_from_guess * Eigen::Vector3d(10, 10, 0)).z(), 0.0, 0.03);
}

// Rough ground, nothing grows on it: the deviation is not that of the cells close to the plane
// only.
TEST(Level, SaysHowRoughTheGroundIs) {
  Random random(12);
  Cloud cloud;
  cloud.name = "ploughed";
  for (int row = 0; row < 60; ++row) {
    for (int col = 0; col < 60; ++col) {
      const double ground = random.normal(0.06);
      for (int i = 0; i < 40; ++i) {
        cloud.xyz.push_back(Eigen::Vector3d(0.5 * (col + random.uniform()),
                                            0.5 * (row + random.uniform()),
                                            ground + random.normal(0.005))
                                .cast<float>());
      }
    }
  }
  const Levelling level = levelCloud(cloud, Eigen::Affine3d::Identity(), {});
  EXPECT_GT(level.roughness, 0.05);
  EXPECT_LT(level.roughness, 0.08);
  EXPECT_LT(level.support, level.under_canopy ? 0.8 : 1.1);
}

TEST(Level, RefusesCloudsThatAreNoMap) {
  Cloud cloud;
  cloud.name = "bad";
  EXPECT_THROW(levelCloud(cloud, Eigen::Affine3d::Identity(), {}), InputError);
  cloud.xyz.assign(1, Eigen::Vector3f(1, 2, 3));
  EXPECT_THROW(levelCloud(cloud, Eigen::Affine3d::Identity(), {}), InputError);
  cloud.xyz.assign(1000, Eigen::Vector3f(1, 2, 3));
  EXPECT_THROW(levelCloud(cloud, Eigen::Affine3d::Identity(), {}), InputError);
  cloud.xyz.clear();
  for (int i = 0; i < 1000; ++i) cloud.xyz.emplace_back(0.01F * static_cast<float>(i), 0, 0);
  EXPECT_THROW(levelCloud(cloud, Eigen::Affine3d::Identity(), {}), InputError);
  EXPECT_THROW(levelCloud(makeStrip(70, 0, 0), Eigen::Affine3d::Identity(), {}), InputError);
}

}  // namespace
}  // namespace agricolmap::map
