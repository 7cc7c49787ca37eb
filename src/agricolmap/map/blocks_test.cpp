#include "agricolmap/map/blocks.hpp"

#include <gtest/gtest.h>

namespace agricolmap::map {
namespace {

/// Blocks one behind the other, 2 m long, of these energies.
std::vector<Block> rowOf(const std::vector<double>& energies, StripFrame& strip) {
  strip.half_extent = {static_cast<double>(energies.size()), 1.0};
  std::vector<Block> blocks;
  for (const double energy : energies) {
    Block block;
    block.low = {2.0 * static_cast<double>(blocks.size()) - strip.half_extent.x(), -1.0};
    block.high = block.low + Eigen::Vector2d(2.0, 2.0);
    block.energy = energy;
    blocks.push_back(block);
  }
  return blocks;
}

TEST(TexturedStretch, IsTheOneThatHoldsMost) {
  StripFrame strip;
  const std::vector<Block> blocks = rowOf({5.0, 1.0, 3.0, 4.0, 1.0}, strip);
  const Stretch two = texturedStretch(blocks, strip, 5.0);
  ASSERT_EQ(two.blocks.size(), 2U);
  EXPECT_EQ(two.blocks.front().energy, 3.0);
  EXPECT_NEAR(two.half_extent.x(), 2.0, 1e-12);
  EXPECT_EQ(texturedStretch(blocks, strip, 10.0).blocks.size(), 5U);
}

TEST(TexturedStretch, IsNeverEmptyHoweverShort) {
  StripFrame strip;
  const std::vector<Block> blocks = rowOf({5.0, 1.0, 7.0, 4.0, 1.0}, strip);
  for (const double length : {0.0, 0.1, 1.9, 2.0}) {
    const Stretch one = texturedStretch(blocks, strip, length);
    ASSERT_EQ(one.blocks.size(), 1U) << length;
    EXPECT_EQ(one.blocks.front().energy, 7.0);
    EXPECT_NEAR(one.half_extent.x(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace agricolmap::map
