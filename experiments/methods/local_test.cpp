// The local methods, affine ICP and CPD: right from centimetres off, lost from a plant's distance.
#include <gtest/gtest.h>

#include "agricolmap/core/random.hpp"
#include "experiments/methods/nearest_points.hpp"
#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

TEST(NearestPoints, FindsWhatLookingAtAllOfThemFinds) {
  Random random(5);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 500; ++i) {
    points.emplace_back(random.uniform(0.0, 4.0), random.uniform(0.0, 2.0),
                        random.uniform(0.0, 0.3));
  }
  const NearestPoints index(points);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d query(random.uniform(-0.5, 4.5), random.uniform(-0.5, 2.5),
                                random.uniform(-0.2, 0.5));
    std::size_t best = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      if ((points[k] - query).norm() < (points[best] - query).norm()) best = k;
    }
    const auto found = index.nearest(query, 0.4);
    EXPECT_EQ(found.has_value(), (points[best] - query).norm() <= 0.4);
    if (found) {
      EXPECT_EQ(*found, best);
    }
  }
  EXPECT_FALSE(NearestPoints({}).nearest(Eigen::Vector3d::Zero(), 1.0).has_value());
}

/// A few centimetres off, scales right: what local methods are for.
testing::GuessError nearby() {
  testing::GuessError error;
  error.shift = {0.02, -0.02};
  return error;
}

/// More than half a plant's distance off.
testing::GuessError faraway() {
  testing::GuessError error;
  error.shift = {0.7, 0.9};
  error.heading = 0.1;
  return error;
}

TEST(IcpAffine, IsRightFromNearby) { testing::expectRight(makeMethod("icp-affine"), nearby(), {}); }

TEST(IcpAffine, IsLostFromFaraway) { testing::expectLost(makeMethod("icp-affine"), faraway()); }

TEST(IcpAffine, FailsOnEmptyMaps) { testing::expectFailsOnEmptyMaps(makeMethod("icp-affine")); }

TEST(CpdAffine, IsRightFromNearby) { testing::expectRight(makeMethod("cpd-affine"), nearby(), {}); }

TEST(CpdAffine, IsLostFromFaraway) { testing::expectLost(makeMethod("cpd-affine"), faraway()); }

TEST(CpdAffine, FailsOnEmptyMaps) { testing::expectFailsOnEmptyMaps(makeMethod("cpd-affine")); }

}  // namespace
}  // namespace agricolmap::experiments
