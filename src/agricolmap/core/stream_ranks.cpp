#include "agricolmap/core/stream_ranks.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap {
namespace {

constexpr int kHalf = 16;  ///< bits that a pass settles
constexpr std::uint32_t kSign = 0x80000000U;

/// Numbers in the order of the floats whose bits they are made of.
std::uint32_t keyOf(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}
float valueOf(std::uint32_t key) {
  return std::bit_cast<float>((key & kSign) != 0 ? key & ~kSign : ~key);
}

/// Finds the coordinate at a rank: how many there are of each upper half of its key, then how many
/// of each lower half under the right upper one.
class RankSearch {
 public:
  RankSearch(Eigen::Index axis, std::size_t rank)
      : axis_(axis), rank_(rank), counts_(std::size_t{1} << kHalf) {}

  void take(const PointBatch& batch) {
    for (const Eigen::Vector3f& point : batch.xyz) {
      const std::uint32_t key = keyOf(point[axis_]);
      const std::uint32_t upper = key >> kHalf;
      if (!upper_known_) {
        ++counts_[upper];
      } else if (upper == upper_) {
        ++counts_[key & 0xFFFFU];
      }
    }
  }
  /// After the first pass.
  void settleUpper() {
    upper_ = settled();
    upper_known_ = true;
    counts_.assign(counts_.size(), 0);
  }
  /// After the second.
  float value() { return valueOf(upper_ << kHalf | settled()); }

 private:
  /// Whose count the rank lies in; it becomes that among those.
  std::uint32_t settled() {
    std::uint32_t half = 0;
    while (half + 1 < counts_.size() && rank_ >= counts_[half]) rank_ -= counts_[half++];
    return half;
  }

  Eigen::Index axis_;
  std::size_t rank_;
  std::vector<std::size_t> counts_;
  bool upper_known_ = false;
  std::uint32_t upper_ = 0;
};

}  // namespace

Box3 boxWithoutTails(const PointStream& points, std::size_t tail) {
  const std::size_t count = points.facts().points;
  if (tail >= (count + 1) / 2) throw UsageError("nothing is left between the tails of a cloud");
  std::vector<RankSearch> searches;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    searches.emplace_back(axis, tail);
    searches.emplace_back(axis, count - 1 - tail);
  }
  const auto pass = [&] {
    points.pass([&](const PointBatch& batch) {
      parallelFor(searches.size(), [&](std::size_t i) { searches[i].take(batch); });
    });
  };
  pass();
  for (RankSearch& search : searches) search.settleUpper();
  pass();
  Box3 box;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<std::size_t>(2 * axis);
    box.min[axis] = searches[low].value();
    box.max[axis] = searches[low + 1].value();
  }
  return box;
}

}  // namespace agricolmap
