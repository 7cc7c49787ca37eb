#include "agricolmap/core/robust.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "agricolmap/core/random.hpp"

namespace agricolmap {
namespace {

TEST(Robust, RanksAreThoseOfTheSortedList) {
  Random random(3);
  std::vector<double> values(101);
  for (double& value : values) value = random.normal();
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (const std::size_t rank : {0U, 1U, 50U, 99U, 100U}) {
    EXPECT_EQ(valueAtRank(values, rank), sorted[rank]);
  }
  EXPECT_EQ(quantile(values, 0.0), sorted.front());
  EXPECT_EQ(quantile(values, 0.1), sorted[10]);
  EXPECT_EQ(quantile(values, 1.0), sorted.back());
  EXPECT_EQ(median(values), sorted[50]);
}

TEST(Robust, OfTwoMiddleValuesTheLargerCounts) {
  EXPECT_EQ(median(std::vector{4, 1, 3, 2}), 3);
  EXPECT_EQ(quantile(std::vector{4, 1, 3, 2}, 0.5), 3);
  EXPECT_EQ(median(std::vector{7}), 7);
}

TEST(Robust, AnEmptyListHasNoRanks) {
  std::vector<double> none;
  EXPECT_THROW(median(none), UsageError);
  EXPECT_THROW(quantile(none, 0.5), UsageError);
  EXPECT_THROW(deviationFrom(none), UsageError);
  EXPECT_THROW(valueAtRank(std::vector{1.0}, 1), UsageError);
}

TEST(Robust, DeviationsAreThoseOfTheNormalAmongOutliers) {
  Random random(4);
  std::vector<double> line, plane;
  for (int i = 0; i < 200000; ++i) {
    line.push_back(std::abs(random.normal(0.3)));
    plane.push_back(std::hypot(random.normal(0.3), random.normal(0.3)));
  }
  EXPECT_NEAR(deviationFrom(line), 0.3, 0.003);
  EXPECT_NEAR(median(line), kMedianOnLine * 0.3, 0.002);
  EXPECT_NEAR(median(plane), kMedianInPlane * 0.3, 0.002);
  line.resize(line.size() + 20000, 1e9);
  EXPECT_NEAR(deviationFrom(line), 0.3, 0.05);
}

TEST(Robust, TheBiweightReachesZeroAtOne) {
  EXPECT_EQ(tukeyWeight(0.0), 1.0);
  EXPECT_DOUBLE_EQ(tukeyWeight(-0.5), 0.5625);
  for (const double u : {1.0, -1.0, 3.0, -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(tukeyWeight(u), 0.0);
  }
}

}  // namespace
}  // namespace agricolmap
