#include "agricolmap/change/distribution.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace agricolmap::change {
namespace {

HeightChange changesOf(const std::vector<float>& values) {
  HeightChange change{Raster<float>(1, static_cast<int>(values.size())),
                      {},
                      Raster<float>(1, static_cast<int>(values.size()))};
  for (std::size_t i = 0; i < values.size(); ++i) {
    change.change[i] = values[i];
    change.significant[i] = values[i] > 0.1F ? 1.0F : 0.0F;
  }
  return change;
}

TEST(Distribution, HasEachKnownCellOnceAndTellsTheSureApart) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const Distribution found = distributionOf(changesOf({-0.19F, -0.01F, 0.01F, 0.19F, none}), 4);
  EXPECT_DOUBLE_EQ(found.reach, 0.2);
  ASSERT_EQ(found.bins.size(), 4U);
  for (const Distribution::Bin& bin : found.bins) EXPECT_EQ(bin.sure + bin.unsure, 1.0);
  EXPECT_EQ(found.bins[3].sure, 1.0);
  EXPECT_EQ(found.bins[2].unsure, 1.0);
}

TEST(Distribution, OfNothingOrNextToNothingHasAReach) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_DOUBLE_EQ(reachOf(changesOf({none}).change), 0.02);
  EXPECT_DOUBLE_EQ(reachOf(changesOf({0.0F, 0.001F}).change), 0.02);
}

TEST(Distribution, WhatLiesBeyondIsInTheOutermostBins) {
  std::vector<float> values(1000, 0.0F);
  values.front() = -5.0F;
  values.back() = 5.0F;
  const Distribution found = distributionOf(changesOf(values), 2);
  EXPECT_DOUBLE_EQ(found.reach, 0.02);
  EXPECT_EQ(found.bins[0].unsure, 1.0);
  EXPECT_EQ(found.bins[1].sure, 1.0);
}

}  // namespace
}  // namespace agricolmap::change
