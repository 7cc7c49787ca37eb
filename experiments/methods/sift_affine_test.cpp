
#include <gtest/gtest.h>

#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

TEST(SiftAffine, IsRightFromNearby) {
  testing::GuessError error;
  error.shift = {0.3, -0.2};
  PriorUncertainty prior;
  prior.translation = 0.5;
  prior.heading_deg = 1.0;
  prior.scale = 0.02;
  testing::expectRight(makeMethod("sift-affine"), error, prior);
}

TEST(SiftAffine, FailsOnEmptyMaps) { testing::expectFailsOnEmptyMaps(makeMethod("sift-affine")); }

}  // namespace
}  // namespace agricolmap::experiments
