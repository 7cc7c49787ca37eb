#include "agricolmap/simulate/simulate.hpp"

#include <gtest/gtest.h>

namespace agricolmap {
namespace {

TEST(Simulate, Runs) {
  SimulationOptions options = cropPreset(Crop::kSoybean);
  options.field.width = 8;
  options.field.height = 8;
  options.ugv.length = 4;
  const SimulatedPair pair = simulatePair(options);
  EXPECT_GT(pair.uav.size(), 100000U);
  EXPECT_GT(pair.ugv.size(), 100000U);
}

}  // namespace
}  // namespace agricolmap
