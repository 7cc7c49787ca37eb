#include "agricolmap/verdict/slip.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace agricolmap::verdict {
namespace {

/// Ten slices of a metre, of which those from `behind` on slipped, as an affine laid them.
std::vector<SliceOffset> slippedSlices(std::size_t behind, const Eigen::Vector2d& step,
                                       const Compromise& undone) {
  std::vector<SliceOffset> slices;
  for (std::size_t i = 0; i < 10; ++i) {
    const double along = static_cast<double>(i) - 4.5;
    Eigen::Vector2d offset = undone.shift + undone.slope * along;
    if (i >= behind) offset += step;
    slices.push_back({along, offset});
  }
  return slices;
}

TEST(Slip, TheAffineOfTheLargerPartIsFound) {
  const Compromise undone{{0.05, -0.02}, {0.004, -0.02}};
  const Eigen::Vector2d step(-0.1, 0.2);
  const auto first = largerPart(slippedSlices(7, step, undone));
  ASSERT_TRUE(first.has_value());
  EXPECT_LT((first->shift - undone.shift).norm(), 1e-9);
  EXPECT_LT((first->slope - undone.slope).norm(), 1e-9);
  // The larger part is the one behind: what slipped are the slices before.
  const auto second = largerPart(slippedSlices(3, step, undone));
  ASSERT_TRUE(second.has_value());
  EXPECT_LT((second->shift - (undone.shift + step)).norm(), 1e-9);
}

TEST(Slip, NeedsSlicesOnBothSides) {
  EXPECT_FALSE(largerPart({}).has_value());
  std::vector<SliceOffset> few = slippedSlices(5, {0.1, 0.0}, {});
  few.resize(5);
  EXPECT_FALSE(largerPart(few).has_value());
}

TEST(Slip, WhatNoSlipExplainsIsLeftAlone) {
  std::vector<SliceOffset> zigzag;
  for (int i = 0; i < 12; ++i) {
    zigzag.push_back({i - 5.5, {i % 2 == 0 ? 0.1 : -0.1, 0.0}});
  }
  EXPECT_FALSE(largerPart(zigzag).has_value());
}

}  // namespace
}  // namespace agricolmap::verdict
