#include "agricolmap/io/cloud/plain_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace agricolmap::io {
namespace {

template <typename Value>
using Values = std::array<Value, PointBlock::kCapacity>;

/// How many are true of `of(i)`, which is cheap: without a branch.
template <typename Count, typename Of>
Count countOf(std::size_t points, const Of& of) {
  Count count = 0;
  for (std::size_t i = 0; i < points; ++i) count += of(i) ? 1 : 0;
  return count;
}

bool allNear(const PointBlock& block, const Eigen::Vector3d& origin) {
  std::uint64_t far = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Values<double>& values = block.xyz[static_cast<std::size_t>(axis)];
    const double middle = origin[axis];
    far += countOf<std::uint64_t>(block.count, [&](std::size_t i) {
      return !(std::abs(values[i] - middle) <= kMaxFromOrigin);  // of NaN, too
    });
  }
  return far == 0;
}

bool noneAt(const Values<double>& heights, std::size_t count, double hole) {
  return countOf<std::uint64_t>(count, [&](std::size_t i) { return heights[i] == hole; }) == 0;
}

/// The least and the largest channel of each point.
struct Spans {
  Values<float> least;
  Values<float> most;
};

/// False where a colour is not finite.
bool spansOf(const PointBlock& block, Spans& spans) {
  std::uint32_t bad = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    const float red = block.wide[0][i];
    const float green = block.wide[1][i];
    const float blue = block.wide[2][i];
    const float low = green < red ? green : red;
    const float high = green < red ? red : green;
    spans.least[i] = blue < low ? blue : low;
    spans.most[i] = high < blue ? blue : high;
    const float sum = red + green + blue;
    bad += std::abs(sum) <= std::numeric_limits<float>::max() ? 0 : 1;
  }
  return bad == 0;
}

/// `ColourTally::take` of all.
void tallyColours(const Spans& spans, std::size_t count, ColourTally& tally) {
  // No structured binding: clang 14 cannot capture one, and the fuzz targets are built by it.
  const auto& least = spans.least;
  const auto& most = spans.most;
  tally.coloured += countOf<std::uint32_t>(
      count, [&](std::size_t i) { return least[i] != 0.0F || most[i] != 0.0F; });
  for (std::size_t range = 0; range < kColourRanges.size(); ++range) {
    const ColourScale scale = scaleOfRange(range);
    tally.outside[range] += countOf<std::uint32_t>(
        count, [&](std::size_t i) { return !(least[i] >= scale.low && most[i] <= scale.high); });
  }
  // New extremes are rare, and so a count of them is cheaper than they are.
  const auto beyond = countOf<std::uint32_t>(
      count, [&](std::size_t i) { return least[i] < tally.low || most[i] > tally.high; });
  for (std::size_t i = 0; beyond > 0 && i < count; ++i) {
    tally.low = std::min(tally.low, least[i]);
    tally.high = std::max(tally.high, most[i]);
  }
}

/// `LowestHeights::take` of all: what is not below the next lowest changes nothing.
void tallyHeights(const Values<double>& heights, std::size_t count, LowestHeights& lowest) {
  const double next = lowest.next;
  const auto below =
      countOf<std::uint64_t>(count, [&](std::size_t i) { return heights[i] < next; });
  for (std::size_t i = 0; below > 0 && i < count; ++i) lowest.take(heights[i]);
}

void takePlaces(const PointBlock& block, const Eigen::Vector3d& origin, TakenPoints& taken) {
  const double x = origin.x();
  const double y = origin.y();
  const double z = origin.z();
  for (std::size_t i = 0; i < block.count; ++i) {
    taken.xyz[i] = Eigen::Vector3f(static_cast<float>(block.xyz[0][i] - x),
                                   static_cast<float>(block.xyz[1][i] - y),
                                   static_cast<float>(block.xyz[2][i] - z));
  }
}

void takeColours(const PointBlock& block, ColourKind kind, float factor, TakenPoints& taken) {
  if (kind == ColourKind::kNone) return;
  if (kind == ColourKind::kByte) {
    std::copy_n(block.rgb.begin(), block.count, taken.rgb.begin());
    return;
  }
  for (std::size_t i = 0; i < block.count; ++i) {
    taken.rgb[i] = {narrowed(block.wide[0][i], factor), narrowed(block.wide[1][i], factor),
                    narrowed(block.wide[2][i], factor)};
  }
}

}  // namespace

bool takePlainBlock(const PointBlock& block, ColourKind kind, const Taking& taking, Tally& tally,
                    TakenPoints& taken) {
  const Values<double>& heights = block.xyz[2];
  if (!allNear(block, taking.origin)) return false;
  if (taking.hole && !noneAt(heights, block.count, *taking.hole)) return false;
  if (isWide(kind)) {
    Spans spans;
    if (!spansOf(block, spans)) return false;
    const ColourScale& scale = taking.colours;
    const auto off = countOf<std::uint32_t>(
        block.count, [&](std::size_t i) { return !scale.holds(spans.least[i], spans.most[i]); });
    if (off > 0) return false;
    tallyColours(spans, block.count, tally.colours);
  }
  tallyHeights(heights, block.count, tally.heights);
  takePlaces(block, taking.origin, taken);
  takeColours(block, kind, taking.colours.factor, taken);
  taken.count = block.count;
  return true;
}

}  // namespace agricolmap::io
