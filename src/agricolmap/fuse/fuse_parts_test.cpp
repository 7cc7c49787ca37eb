// The parts that a shared map is made by.
#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/random.hpp"
#include "agricolmap/fuse/adjustment.hpp"
#include "agricolmap/fuse/owners.hpp"
#include "agricolmap/fuse/strip_cells.hpp"
#include "agricolmap/fuse/surface_map.hpp"
#include "agricolmap/fuse/test_scene.hpp"

namespace agricolmap::fuse {
namespace {

using test::groundCloud;

TEST(CellFor, LeavesRoomAndIsEasilySaid) {
  EXPECT_DOUBLE_EQ(cellFor(0.014), 0.02);
  EXPECT_DOUBLE_EQ(cellFor(0.027), 0.03);
  EXPECT_DOUBLE_EQ(cellFor(0.0051), 0.006);
  EXPECT_DOUBLE_EQ(cellFor(0.0001), 0.005);
  EXPECT_DOUBLE_EQ(cellFor(7.0), 1.0);
}

TEST(SurfaceMap, ShowsWhatLiesOnTop) {
  Cloud cloud;
  const auto add = [&](float x, float z, Rgb colour) {
    cloud.xyz.emplace_back(x, 0.05F, z);
    cloud.rgb.push_back(colour);
  };
  // A leaf over soil, and a point that flies above both.
  for (int i = 0; i < 4; ++i) add(0.05F, 0.30F + 0.004F * static_cast<float>(i), {0, 200, 0});
  add(0.05F, 0.0F, {100, 80, 60});
  add(0.05F, 2.0F, {255, 255, 255});
  add(0.15F, 0.1F, {100, 80, 60});
  const map::GridMap map =
      surfaceMap(CloudStream(cloud), {0.0, 0.0, 10.0}, {Eigen::Vector2d::Zero(), 0.1, 1, 3});
  EXPECT_FLOAT_EQ(map.height(0, 0), 10.306F);
  EXPECT_EQ(map.colour(0, 0), (Rgb{0, 200, 0}));
  EXPECT_FLOAT_EQ(map.weight(0, 0), 6.0F);
  EXPECT_FLOAT_EQ(map.height(0, 1), 10.1F);
  EXPECT_FALSE(map.valid(0, 2));
  EXPECT_EQ(map.filled, 2U);
  const map::GridMap coarse = coarsened(map, 2);
  EXPECT_FLOAT_EQ(coarse.height(0, 0), 0.5F * (10.306F + 10.1F));
  EXPECT_FLOAT_EQ(coarse.weight(0, 0), 7.0F);
  EXPECT_FALSE(coarse.valid(0, 1));
}

TEST(SurfaceMap, OnlyGapsOfACellAreFilled) {
  Cloud cloud = groundCloud({0.0, 0.0}, {1.0, 1.0}, 0.1, [](double x, double) { return x; });
  // A cell alone, and a block of three by three.
  std::erase_if(cloud.xyz, [](const Eigen::Vector3f& p) {
    const bool alone = std::abs(p.x() - 0.15F) < 0.01F && std::abs(p.y() - 0.15F) < 0.01F;
    return alone || (std::abs(p.x() - 0.65F) < 0.11F && std::abs(p.y() - 0.65F) < 0.11F);
  });
  cloud.rgb.resize(cloud.size());
  map::GridMap map = surfaceMap(CloudStream(cloud), Eigen::Vector3d::Zero(),
                                {Eigen::Vector2d::Zero(), 0.1, 10, 10});
  ASSERT_FALSE(map.valid(1, 1));
  fillBetween(map);
  EXPECT_NEAR(map.height(1, 1), 0.15, 0.01);
  EXPECT_FLOAT_EQ(map.weight(1, 1), kBetween);
  EXPECT_FALSE(map.valid(6, 6));
}

TEST(StripCells, SeesWhereItHasPointsAndNotBehindPlants) {
  // A strip of 4 m x 2 m with a hole of 0.3 m, and a single point far aside.
  Cloud cloud = groundCloud({2.0, 2.0}, {6.0, 4.0}, 0.01, [](double, double) { return 0.0; });
  Cloud strip = cloud;
  strip.xyz.clear();
  strip.rgb.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.xyz[i];
    if (std::abs(p.x() - 4.0F) < 0.15F && std::abs(p.y() - 3.0F) < 0.15F) continue;
    strip.xyz.push_back(p);
    strip.rgb.push_back(cloud.rgb[i]);
  }
  strip.xyz.emplace_back(7.5F, 3.0F, 0.0F);
  strip.rgb.push_back({});
  const Lattice lattice{{Eigen::Vector2d::Zero(), 0.05, 200, 200}, 5};
  const StripCells cells = stripCells(CloudStream(strip), Eigen::Vector3d::Zero(), lattice, 0.2);
  const auto at = [&](double x, double y) {
    const auto col = static_cast<int>(x / 0.05) - cells.col;
    const auto row = static_cast<int>(y / 0.05) - cells.row;
    return cells.depth.contains(row, col) ? cells.depth(row, col) : 0.0F;
  };
  EXPECT_FLOAT_EQ(at(4.0, 3.0), 0.0F);   // the hole
  EXPECT_FLOAT_EQ(at(7.52, 3.0), 0.0F);  // alone
  EXPECT_FLOAT_EQ(at(1.0, 3.0), 0.0F);   // beyond the strip
  EXPECT_NEAR(at(3.0, 2.42), 0.42, 0.06);
  EXPECT_NEAR(at(3.0, 3.52), 0.48, 0.06);
  EXPECT_DOUBLE_EQ(fineCells(CloudStream(strip), Eigen::Vector3d::Zero(), lattice).frame.cell,
                   0.01);
}

StripCells stripWith(double depth, int row, int col, int rows, int cols) {
  StripCells cells;
  cells.row = row;
  cells.col = col;
  cells.depth = Raster<float>(rows, cols, static_cast<float>(depth));
  return cells;
}

TEST(Owners, DoNotDependOnTheOrderOfStrips) {
  map::GridMap fixed;
  fixed.frame = {Eigen::Vector2d::Zero(), 0.1, 4, 10};
  fixed.weight = Raster<float>(4, 10, 1.0F);
  fixed.weight(0, 0) = 0.0F;
  const StripCells deep = stripWith(0.2, 1, 1, 2, 5), shallow = stripWith(0.1, 1, 4, 2, 5);
  const std::vector<Claim> claims{{&deep, 2, 0, 0.01}, {&shallow, 3, 0, 0.01}};
  const Raster<std::uint16_t> owners = ownersOf(fixed, claims);
  EXPECT_EQ(owners(0, 0), kNoSource);
  EXPECT_EQ(owners(0, 5), kFixedSource);
  EXPECT_EQ(owners(1, 2), 2);
  EXPECT_EQ(owners(1, 5), 2);  // both saw it, and one saw more around
  EXPECT_EQ(owners(2, 7), 3);
  const Raster<std::uint16_t> other = ownersOf(fixed, {claims[1], claims[0]});
  EXPECT_TRUE(std::equal(owners.begin(), owners.end(), other.begin()));
  // A later day counts first, and among equals the smaller error.
  EXPECT_EQ(ownersOf(fixed, {{&deep, 2, 20260501, 0.01}, {&shallow, 3, 20260601, 0.05}})(1, 5), 3);
  const StripCells same = stripWith(0.2, 1, 4, 2, 5);
  EXPECT_EQ(ownersOf(fixed, {{&deep, 2, 0, 0.04}, {&same, 3, 0, 0.01}})(1, 5), 3);
}

/// Two strips of one field, the second of which is laid `off`; `shared` is how wide a piece both
/// saw, `noise` of their heights, all in metres. They run at an angle to the cells.
class TwoStrips {
 public:
  explicit TwoStrips(const Eigen::Vector3d& off, double shared = 1.0, double noise = 0.0) {
    const auto bumps = [](double x, double y) {
      return 0.1 * std::sin(7.0 * x + 2.0 * std::sin(3.0 * y)) * std::cos(5.0 * y + x);
    };
    clouds_.push_back(groundCloud({1.0, 1.0}, {5.0, 3.0}, 0.01, bumps));
    clouds_.push_back(groundCloud({1.0, 3.0 - shared}, {5.0, 5.0 - shared}, 0.01, bumps));
    Random random(3);
    const Eigen::Rotation2Df turn(0.1F);
    for (Cloud& cloud : clouds_) {
      for (Eigen::Vector3f& p : cloud.xyz) {
        p.head<2>() = turn * p.head<2>();
        p.z() += static_cast<float>(noise * random.normal());
      }
    }
    for (Eigen::Vector3f& p : clouds_[1].xyz) p += off.cast<float>();
    for (const Cloud& cloud : clouds_) {
      cells_.push_back(stripCells(CloudStream(cloud), stay_, lattice_, 0.2));
    }
  }
  std::vector<Disagreement> compared(const std::vector<StripErrors>& errors) const {
    const auto fine = [&](std::size_t i) {
      return fineCells(CloudStream(clouds_[i]), stay_, lattice_);
    };
    return compareStrips({&cells_[0], &cells_[1]}, {lattice_.factor, fine}, errors);
  }

 private:
  const Eigen::Vector3d stay_ = Eigen::Vector3d::Zero();
  const Lattice lattice_{{Eigen::Vector2d::Zero(), 0.05, 120, 120}, 5};
  std::vector<Cloud> clouds_;
  std::vector<StripCells> cells_;
};

TEST(Adjustment, FindsHowFarStripsLieApartAndMovesTheWorse) {
  const Eigen::Vector3d off(0.032, -0.017, 0.011);
  const std::vector<StripErrors> errors{{0.005, 0.005}, {0.04, 0.02}};
  const auto found = TwoStrips(off).compared(errors);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR((found[0].offset - off).norm(), 0.0, 0.004);
  EXPECT_TRUE(found[0].plausible());
  const auto shifts = adjustedShifts(found, errors);
  EXPECT_LT(shifts[0].norm(), 0.005);
  EXPECT_NEAR((shifts[0] - shifts[1] - off).norm(), 0.0, 0.01);
}

TEST(Adjustment, ANarrowOverlapTellsLess) {
  const std::vector<StripErrors> errors{{0.01, 0.01}, {0.01, 0.01}};
  const auto found = TwoStrips({0.01, 0.0, 0.0}, 0.2, 0.03).compared(errors);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR((found[0].offset - Eigen::Vector3d(0.01, 0.0, 0.0)).norm(), 0.0, 0.005);
  EXPECT_GT(found[0].deviation, 0.01);
  EXPECT_LT(adjustedShifts(found, errors)[0].norm(), 0.003);
  // Of strips that are hardly alike none is found where they touch with their corners alone.
  EXPECT_TRUE(TwoStrips({0.01, 0.0, 0.0}, 0.15, 0.2).compared(errors).empty());
}

TEST(Adjustment, WhatNoErrorExplainsIsSaidAndNotSpreadOut) {
  const std::vector<StripErrors> errors{{0.01, 0.01}, {0.01, 0.01}};
  const auto found = TwoStrips({0.2, 0.0, 0.0}).compared(errors);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].plausible());
  EXPECT_TRUE(adjustedShifts(found, errors)[1].isZero());
}

}  // namespace
}  // namespace agricolmap::fuse
