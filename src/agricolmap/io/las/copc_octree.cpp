#include "agricolmap/io/las/copc_octree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kTogether = 8;
/// Levels at which points are counted; the second only where cells of the first have too many.
constexpr int kCounted = 9;
constexpr int kCountedDeep = 18;

/// Calls `visit(records, result)` for every chunk side by side, and `take(result)` in order.
template <typename Result, typename Visit, typename Take>
void forEachChunk(const LasFeed& feed, const Visit& visit, const Take& take) {
  struct Slot {
    std::vector<std::byte> records;
    Result result;
  };
  std::array<Slot, kTogether> slots;
  feed.pass([&](std::size_t chunks, const LasFeed::Load& load) {
    for (std::size_t begin = 0; begin < chunks; begin += kTogether) {
      const std::size_t count = std::min(kTogether, chunks - begin);
      parallelFor(count, [&](std::size_t i) {
        load(begin + i, slots[i].records);
        slots[i].result = Result();
        visit(slots[i].records, slots[i].result);
      });
      throwIfInterrupted();
      for (std::size_t i = 0; i < count; ++i) take(slots[i].result);
      feed.forget();
    }
  });
}

/// Bits of a node's cell, one of each axis after the other, behind a one: a number for every node.
std::uint64_t codeOf(const CopcKey& key) {
  std::uint64_t code = 1;
  for (int bit = key.level - 1; bit >= 0; --bit) {
    code = code << 3 | static_cast<std::uint64_t>((key.x >> bit & 1) << 2 |
                                                  (key.y >> bit & 1) << 1 | (key.z >> bit & 1));
  }
  return code;
}

}  // namespace

CopcPlace CopcCube::place(const LasOutline& outline, const std::byte* record) const {
  constexpr double kParts = std::uint32_t{1} << kCopcBits;
  CopcPlace place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double at =
        outline.scale[i] * loadLe<std::int32_t>(record + 4 * axis) + outline.offset[i] - corner[i];
    place[axis] = static_cast<std::uint32_t>(std::clamp(at / size * kParts, 0.0, kParts - 1.0));
  }
  return place;
}

CopcKey keyOf(const CopcPlace& place, int level) {
  const int shift = kCopcBits - level;
  return {level, static_cast<std::int32_t>(place[0] >> shift),
          static_cast<std::int32_t>(place[1] >> shift),
          static_cast<std::int32_t>(place[2] >> shift)};
}

CopcExtent extentOf(const LasFeed& feed) {
  const LasLayout& layout = feed.outline().layout;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  struct Extent {
    LasTally tally;
    double first = kNever;
    double last = -kNever;
  };
  Extent all;
  forEachChunk<Extent>(
      feed,
      [&](const std::vector<std::byte>& records, Extent& extent) {
        extent.tally.add(records.data(), records.size() / layout.length, layout);
        for (std::size_t at = *layout.gps_time; at < records.size(); at += layout.length) {
          const auto time = loadLe<double>(&records[at]);
          if (!std::isfinite(time)) continue;
          extent.first = std::min(extent.first, time);
          extent.last = std::max(extent.last, time);
        }
      },
      [&](const Extent& extent) {
        all.tally += extent.tally;
        all.first = std::min(all.first, extent.first);
        all.last = std::max(all.last, extent.last);
      });
  const bool timed = all.first <= all.last;
  return {all.tally, timed ? all.first : 0.0, timed ? all.last : 0.0};
}

CopcCube cubeOf(const LasFeed& feed, const CopcExtent& extent) {
  CopcCube cube;
  if (extent.tally.points == 0) return cube;
  const LasOutline& outline = feed.outline();
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const double a = outline.scale[i] * extent.tally.low[axis] + outline.offset[i];
    const double b = outline.scale[i] * extent.tally.high[axis] + outline.offset[i];
    low[i] = std::min(a, b);
    high[i] = std::max(a, b);
  }
  // The last point lies within the cube, not on its face.
  const double step = outline.scale.cwiseAbs().maxCoeff();
  cube.size = (high - low).maxCoeff() * (1.0 + 1e-9) + 2.0 * step;
  // A field is flat: it lies at the bottom, so that no level cuts it at half its height.
  cube.corner = 0.5 * (low + high).array() - 0.5 * cube.size;
  cube.corner.z() = low.z() - step;
  return cube;
}

CopcParts::CopcParts(const LasFeed& feed, const CopcCube& cube, std::uint64_t most) {
  deepest_ = kCounted;
  count(feed, cube, 0, kCounted);
  const bool crowded = std::any_of(counts_.begin(), counts_.end(), [&](const auto& node) {
    return node.first >> (3 * kCounted) == 1 && node.second > most;
  });
  if (crowded) {
    deepest_ = kCountedDeep;
    count(feed, cube, kCounted + 1, kCountedDeep);
  }
  if (!counts_.empty()) cut({}, most);
  counts_.clear();
}

void CopcParts::count(const LasFeed& feed, const CopcCube& cube, int from, int to) {
  const std::size_t length = feed.outline().layout.length;
  using Codes = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  forEachChunk<Codes>(
      feed,
      [&](const std::vector<std::byte>& records, Codes& codes) {
        std::vector<std::uint64_t> all;
        all.reserve(records.size() / length);
        for (std::size_t at = 0; at < records.size(); at += length) {
          all.push_back(codeOf(keyOf(cube.place(feed.outline(), &records[at]), to)));
        }
        std::sort(all.begin(), all.end());
        for (const std::uint64_t code : all) {
          if (codes.empty() || codes.back().first != code) codes.emplace_back(code, 0);
          ++codes.back().second;
        }
      },
      [&](const Codes& codes) {
        for (const auto& [code, points] : codes) {
          for (int level = to; level >= from; --level) {
            counts_[code >> (3 * (to - level))] += points;
          }
        }
      });
}

void CopcParts::cut(const CopcKey& key, std::uint64_t most) {
  const auto found = counts_.find(codeOf(key));
  if (found == counts_.end()) return;
  if (found->second <= most || key.level == deepest_) {
    index_[codeOf(key)] = parts_.size();
    const std::uint64_t first = parts_.empty() ? 0 : parts_.back().first + parts_.back().points;
    parts_.push_back({key, found->second, first});
    return;
  }
  for (int child = 0; child < 8; ++child) {
    cut({key.level + 1, 2 * key.x + (child >> 2 & 1), 2 * key.y + (child >> 1 & 1),
         2 * key.z + (child & 1)},
        most);
  }
}

std::size_t CopcParts::partOf(const CopcPlace& place) const {
  for (int level = 0; level < deepest_; ++level) {
    if (const auto found = index_.find(codeOf(keyOf(place, level))); found != index_.end()) {
      return found->second;
    }
  }
  return index_.at(codeOf(keyOf(place, deepest_)));
}

}  // namespace agricolmap::io
