// A block with one point that is not kept is taken point by point, one without as a whole. What is
// kept must not depend on it.
#include "agricolmap/io/cloud/plain_block.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace agricolmap::io {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PointBlock randomBlock(ColourKind kind, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-300.0, 300.0);
  std::uniform_int_distribution<int> channel(0, 65535);
  PointBlock block;
  block.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) block.xyz[axis][i] = 5e5 + place(random);
    // Heights in centimetres, so that some are equal.
    block.xyz[2][i] = std::round(place(random)) / 100.0;
    block.rgb[i] = {static_cast<std::uint8_t>(channel(random)), 7, 200};
    for (std::size_t c = 0; c < 3; ++c) {
      const int value = channel(random);
      block.wide[c][i] = kind == ColourKind::kWideFloat ? static_cast<float>(value) / 65535.0F
                                                        : static_cast<float>(value);
    }
    if (i % 7 == 0) block.wide[0][i] = block.wide[1][i] = block.wide[2][i] = 0.0F;
  }
  return block;
}

/// A block after the other as a file.
class Blocks : public PointSource {
 public:
  Blocks(std::vector<PointBlock> blocks, ColourKind kind)
      : blocks_(std::move(blocks)), kind_(kind) {}
  std::size_t points() const override { return 0; }
  std::size_t chunks() const override { return 1; }
  std::size_t firstPoint(std::size_t /*chunk*/) const override { return 0; }
  ColourKind colourKind() const override { return kind_; }
  bool floatCoordinates() const override { return false; }
  void decode(std::size_t /*chunk*/, const Sink& sink) const override {
    for (const PointBlock& block : blocks_) sink(block);
  }

 private:
  std::vector<PointBlock> blocks_;
  ColourKind kind_;
};

struct Taken {
  Tally tally;
  std::vector<Eigen::Vector3f> xyz;
  std::vector<Rgb> rgb;
};

Taken takenOf(const std::vector<PointBlock>& blocks, ColourKind kind, const Taking& taking) {
  Taken all;
  all.tally = takeChunk(Blocks(blocks, kind), 0, taking, [&](const TakenPoints& taken) {
    all.xyz.insert(all.xyz.end(), taken.xyz.begin(), taken.xyz.begin() + taken.count);
    all.rgb.insert(all.rgb.end(), taken.rgb.begin(), taken.rgb.begin() + taken.count);
  });
  return all;
}

void expectSame(const Taken& a, const Taken& b, bool coloured) {
  ASSERT_EQ(a.xyz.size(), b.xyz.size());
  for (std::size_t i = 0; i < a.xyz.size(); ++i) {
    EXPECT_EQ(a.xyz[i], b.xyz[i]);
    if (!coloured) continue;
    EXPECT_EQ(a.rgb[i].r, b.rgb[i].r);
    EXPECT_EQ(a.rgb[i].g, b.rgb[i].g);
    EXPECT_EQ(a.rgb[i].b, b.rgb[i].b);
  }
  EXPECT_EQ(a.tally.kept, b.tally.kept);
  EXPECT_EQ(a.tally.colours.coloured, b.tally.colours.coloured);
  EXPECT_EQ(a.tally.colours.outside, b.tally.colours.outside);
  EXPECT_EQ(a.tally.colours.low, b.tally.colours.low);
  EXPECT_EQ(a.tally.colours.high, b.tally.colours.high);
  EXPECT_EQ(a.tally.heights.lowest, b.tally.heights.lowest);
  EXPECT_EQ(a.tally.heights.next, b.tally.heights.next);
}

struct Case {
  ColourKind kind;
  std::size_t count;
};

class PlainBlock : public testing::TestWithParam<Case> {
 protected:
  Taking taking() const {
    Taking taking;
    taking.origin = {5e5, 5e5, 0.0};
    if (GetParam().kind == ColourKind::kWideInteger) taking.colours = scaleOfRange(2);
    if (GetParam().kind == ColourKind::kWideFloat) taking.colours = scaleOfRange(0);
    return taking;
  }
};

TEST_P(PlainBlock, IsTakenAsItsPointsAre) {
  const auto [kind, count] = GetParam();
  std::vector<PointBlock> plain;
  std::vector<PointBlock> each;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    plain.push_back(randomBlock(kind, count, seed));
    PointBlock more = plain.back();
    for (std::size_t axis = 0; axis < 3; ++axis) more.xyz[axis][count] = kNan;
    ++more.count;
    each.push_back(more);
  }
  Tally tally;
  TakenPoints taken;
  EXPECT_TRUE(takePlainBlock(plain.front(), kind, taking(), tally, taken));
  EXPECT_FALSE(takePlainBlock(each.front(), kind, taking(), tally, taken));
  expectSame(takenOf(plain, kind, taking()), takenOf(each, kind, taking()),
             kind != ColourKind::kNone);
}

TEST_P(PlainBlock, LeavesAloneWhatIsNotKept) {
  const auto [kind, count] = GetParam();
  const auto refused = [&](const auto& spoil) {
    PointBlock block = randomBlock(kind, count, 9);
    Taking how = taking();
    spoil(block, how);
    Tally tally;
    TakenPoints taken;
    taken.count = 3;
    const bool plain = takePlainBlock(block, kind, how, tally, taken);
    EXPECT_TRUE(plain || (taken.count == 3 && tally.colours.coloured == 0 &&
                          std::isinf(tally.heights.lowest)));
    return !plain;
  };
  const std::size_t last = count - 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(refused([&](PointBlock& b, Taking&) { b.xyz[axis][last] = kNan; }));
    EXPECT_TRUE(refused([&](PointBlock& b, Taking&) { b.xyz[axis][0] = -HUGE_VAL; }));
    EXPECT_TRUE(refused([&](PointBlock& b, Taking&) { b.xyz[axis][last] = 6e5; }));
  }
  EXPECT_TRUE(refused([&](PointBlock& b, Taking& how) { how.hole = b.xyz[2][last]; }));
  EXPECT_FALSE(refused([&](PointBlock&, Taking& how) { how.hole = -9999.0; }));
  if (!isWide(kind)) return;
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_TRUE(refused([&](PointBlock& b, Taking&) { b.wide[c][last] = std::nanf(""); }));
    EXPECT_TRUE(refused([&](PointBlock& b, Taking&) { b.wide[c][last] = HUGE_VALF; }));
    EXPECT_TRUE(refused([&](PointBlock& b, Taking&) { b.wide[c][last] = 7e4F; }));
    EXPECT_TRUE(refused([&](PointBlock& b, Taking&) { b.wide[c][0] = -1.0F; }));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PlainBlock,
                         testing::Values(Case{ColourKind::kNone, 1}, Case{ColourKind::kByte, 300},
                                         Case{ColourKind::kWideInteger, 511},
                                         Case{ColourKind::kWideInteger, 3},
                                         Case{ColourKind::kWideFloat, 77}));

}  // namespace
}  // namespace agricolmap::io
