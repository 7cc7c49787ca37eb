#include "agricolmap/map/footprint.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::map {
namespace {

constexpr double kBin = 0.5;  ///< [m]; coarse enough to hold some points of any map worth the name
/// 2 × 2 km; of larger clouds the bins are larger, until what lies far away is left out.
constexpr double kMostBins = 16e6;
/// Bins that are no farther apart than this, in columns and in rows, are of one group.
constexpr int kReach = 2;
constexpr double kFew = 1e-3;       ///< a group with a smaller share of the points may be left out
constexpr double kFewInAll = 1e-2;  ///< if all such groups together have no more than this

/// The cloud's points seen from above, chunk by chunk.
class Places {
 public:
  using Chunk = std::vector<Eigen::Vector2d>;

  Places(const PointStream& cloud, const Eigen::Affine3d& levelled_from_local)
      : cloud_(cloud), levelled_from_local_(levelled_from_local) {}

  /// `visit(part, chunk)` adds a chunk of places to what is summed. One pass.
  template <typename T, typename Visit>
  T sum(const T& zero, const Visit& visit) const {
    T total = zero;
    cloud_.pass([&](const PointBatch& batch) {
      total += parallelSum<T>(batch.size(), kChunk, zero, [&](std::size_t begin, std::size_t end) {
        T part = zero;
        Chunk chunk(end - begin);
        load(batch.xyz.subspan(begin), chunk);
        visit(part, chunk);
        return part;
      });
    });
    return total;
  }
  std::size_t size() const { return cloud_.facts().points; }

 private:
  static constexpr std::size_t kChunk = 1U << 14;

  /// Compiled once: a point on the border of a box must be there again when it is asked next.
#if defined(__clang__)
  [[gnu::noinline]]
#else
  [[gnu::noipa]]
#endif
  void
  load(std::span<const Eigen::Vector3f> points, Chunk& chunk) const {
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      chunk[i] = (levelled_from_local_ * points[i].cast<double>()).head<2>();
    }
  }

  const PointStream& cloud_;
  const Eigen::Affine3d levelled_from_local_;
};

struct BoxSum {
  Box2 box;
  BoxSum& operator+=(const BoxSum& other) {
    box.extend(other.box);
    return *this;
  }
};

/// Bounds of the places that `wanted` takes.
template <typename Wanted>
Box2 boundsOf(const Places& places, const Wanted& wanted) {
  return places
      .sum(BoxSum{},
           [&](BoxSum& sum, const Places::Chunk& chunk) {
             for (const Eigen::Vector2d& place : chunk) {
               if (wanted(place)) sum.box.extend(place);
             }
           })
      .box;
}

/// Points per bin of a box.
struct Bins {
  GridFrame frame;
  std::vector<std::uint32_t> counts;
  std::size_t points = 0;

  std::size_t of(const Eigen::Vector2d& place) const {
    // A cell is a power of two, so that this is the division to the bit; nothing lies below 0.
    const double inverse = 1.0 / frame.cell;
    const Eigen::Vector2d at = place - frame.corner;
    return static_cast<std::size_t>(at.y() * inverse) * static_cast<std::size_t>(frame.cols) +
           static_cast<std::size_t>(at.x() * inverse);
  }
};

Bins countPoints(const Places& places, const Box2& box) {
  Bins bins;
  bins.frame.corner = box.min();
  bins.frame.cell = kBin;
  const auto count = [&]() -> Eigen::Array2d {
    return (box.sizes() / bins.frame.cell).array().floor() + 1.0;
  };
  while (count().prod() > kMostBins) bins.frame.cell *= 2.0;
  bins.frame.cols = static_cast<int>(count().x());
  bins.frame.rows = static_cast<int>(count().y());
  bins.counts.resize(static_cast<std::size_t>(count().prod()));
  bins.points = places.sum(std::size_t{0}, [&](std::size_t& sum, const Places::Chunk& chunk) {
    // Neighbours in a file mostly lie in one bin. Whole numbers: the order does not matter.
    std::size_t bin = 0;
    std::uint32_t run = 0;
    const auto add = [&] {
      std::atomic_ref(bins.counts[bin]).fetch_add(run, std::memory_order_relaxed);
      sum += run;
    };
    for (const Eigen::Vector2d& place : chunk) {
      if (!box.contains(place)) continue;
      const std::size_t next = bins.of(place);
      if (next != bin) {
        add();
        bin = next;
        run = 0;
      }
      ++run;
    }
    add();
  });
  return bins;
}

/// Bins that are near one another, and the points in them.
struct Group {
  std::vector<std::size_t> bins;
  std::size_t points = 0;
};

/// All bins with points that hang together with `seed`, which are marked in `seen`.
Group groupFrom(std::size_t seed, const Bins& bins, std::vector<char>& seen) {
  const auto cols = static_cast<std::size_t>(bins.frame.cols);
  Group group;
  group.bins = {seed};
  seen[seed] = 1;
  for (std::size_t next = 0; next < group.bins.size(); ++next) {
    const std::size_t bin = group.bins[next];
    group.points += bins.counts[bin];
    const int row = static_cast<int>(bin / cols);
    const int col = static_cast<int>(bin % cols);
    for (int r = std::max(0, row - kReach); r <= std::min(bins.frame.rows - 1, row + kReach); ++r) {
      for (int c = std::max(0, col - kReach); c <= std::min(bins.frame.cols - 1, col + kReach);
           ++c) {
        const std::size_t other = static_cast<std::size_t>(r) * cols + static_cast<std::size_t>(c);
        if (bins.counts[other] == 0 || seen[other] != 0) continue;
        seen[other] = 1;
        group.bins.push_back(other);
      }
    }
  }
  return group;
}

/// Empties the bins of groups that are to be left out; whether there are any.
bool emptyFewPoints(Bins& bins) {
  const auto total = static_cast<double>(bins.points);
  std::vector<char> seen(bins.counts.size(), 0);
  std::vector<Group> few;
  std::size_t points = 0;
  for (std::size_t bin = 0; bin < seen.size(); ++bin) {
    if (bins.counts[bin] == 0 || seen[bin] != 0) continue;
    Group group = groupFrom(bin, bins, seen);
    if (static_cast<double>(group.points) >= kFew * total) continue;
    points += group.points;
    if (static_cast<double>(points) > kFewInAll * total) return false;
    few.push_back(std::move(group));
  }
  for (const Group& group : few) {
    for (const std::size_t bin : group.bins) bins.counts[bin] = 0;
  }
  return !few.empty();
}

}  // namespace

double Footprint::spacing() const {
  return points == 0 ? 0.0 : std::sqrt(area / static_cast<double>(points));
}

Footprint footprintOf(const PointStream& cloud, const Eigen::Affine3d& levelled_from_local) {
  Footprint result;
  if (cloud.facts().points == 0) return result;
  const Places places(cloud, levelled_from_local);
  result.box = boundsOf(places, [](const Eigen::Vector2d&) { return true; });
  double cell = 0.0;
  bool again = true;
  while (again) {
    Bins bins = countPoints(places, result.box);
    result.points = bins.points;
    // What is left out may have hidden what else is to be, behind bins that were too large.
    again = bins.frame.cell != cell && emptyFewPoints(bins);
    cell = bins.frame.cell;
    const auto filled = std::count_if(bins.counts.begin(), bins.counts.end(),
                                      [](std::uint32_t count) { return count > 0; });
    result.area = static_cast<double>(filled) * cell * cell;
    if (!again) continue;
    const Box2 box = result.box;
    result.box = boundsOf(places, [&](const Eigen::Vector2d& place) {
      return box.contains(place) && bins.counts[bins.of(place)] > 0;
    });
  }
  result.left_out = places.size() - result.points;
  return result;
}

Footprint footprintOf(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local) {
  return footprintOf(CloudStream(cloud), levelled_from_local);
}

}  // namespace agricolmap::map
