// The octree of COPC 1.0 (copc.io): which node a point belongs to, and how a file's points are cut
// into parts that fit into memory.
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "agricolmap/io/las/las_feed.hpp"

namespace agricolmap::io {

/// A node: cell (x, y, z) of the cube cut into 2^level cells along each axis.
struct CopcKey {
  std::int32_t level = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  auto operator<=>(const CopcKey&) const = default;

  CopcKey parent(int above) const { return {level - above, x >> above, y >> above, z >> above}; }
  /// Whether it is `other`, or lies above it.
  bool holds(const CopcKey& other) const {
    return other.level >= level && other.parent(other.level - level) == *this;
  }
};

/// A point in the cube, in its 2^30th parts.
using CopcPlace = std::array<std::uint32_t, 3>;
inline constexpr int kCopcBits = 30;

/// The cube that all nodes are cut from.
struct CopcCube {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< least of all coordinates
  double size = 1.0;                                 ///< of its edges

  CopcPlace place(const LasOutline& outline, const std::byte* record) const;
};

/// The node of a level that a point lies in.
CopcKey keyOf(const CopcPlace& place, int level);

/// A first look at all points.
struct CopcExtent {
  LasTally tally;
  double first_time = 0.0;  ///< GPS times; both 0 where there are none
  double last_time = 0.0;
};
CopcExtent extentOf(const LasFeed& feed);
CopcCube cubeOf(const LasFeed& feed, const CopcExtent& extent);

/// Nodes whose points, those in nodes below included, are few enough to be kept in memory; every
/// point is in one of them.
class CopcParts {
 public:
  /// Of at most `most` points each, as far as points that lie in one place allow.
  CopcParts(const LasFeed& feed, const CopcCube& cube, std::uint64_t most);

  struct Part {
    CopcKey key;
    std::uint64_t points = 0;
    std::uint64_t first = 0;  ///< points in the parts before it
  };
  /// Depth first: what lies below a node comes together.
  const std::vector<Part>& parts() const { return parts_; }
  /// Index of the part that a point belongs to.
  std::size_t partOf(const CopcPlace& place) const;

 private:
  void count(const LasFeed& feed, const CopcCube& cube, int from, int to);
  void cut(const CopcKey& key, std::uint64_t most);
  std::unordered_map<std::uint64_t, std::uint64_t> counts_;  ///< by code, of nodes at all levels
  std::unordered_map<std::uint64_t, std::size_t> index_;     ///< of parts, by code
  std::vector<Part> parts_;
  int deepest_ = 0;
};

}  // namespace agricolmap::io
