#include "agricolmap/io/las/copc_nodes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "agricolmap/core/interrupt.hpp"

namespace agricolmap::io {
namespace {

/// Points that a node keeps without handing any down.
constexpr std::size_t kFew = 20000;
/// At this level cells are as small as places can be told apart.
constexpr int kDeepest = kCopcBits - kCopcGridBits;

using Indices = std::vector<std::uint32_t>;

class Thinning {
 public:
  Thinning(const std::vector<std::byte>& records, const LasOutline& outline, const CopcCube& cube)
      : records_(records),
        length_(outline.layout.length),
        nearest_(std::size_t{1} << (3 * kCopcGridBits), kNone) {
    places_.reserve(records.size() / length_);
    for (std::size_t at = 0; at < records.size(); at += length_) {
      places_.push_back(cube.place(outline, &records[at]));
    }
  }

  std::vector<CopcNode> nodes(const CopcKey& part) {
    Indices rest(places_.size());
    for (std::uint32_t i = 0; i < rest.size(); ++i) rest[i] = i;
    for (int level = 0; level < part.level && !rest.empty(); ++level) {
      keep(part.parent(part.level - level), take(level, rest));
    }
    build(part, std::move(rest));
    return std::move(nodes_);
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Which cell of the grid of its node a point is in.
  std::size_t cellOf(const CopcPlace& place, int level) const {
    const int shift = kCopcBits - level - kCopcGridBits;
    constexpr std::uint32_t kMask = (1U << kCopcGridBits) - 1;
    std::size_t cell = 0;
    for (const std::uint32_t part : place) cell = cell << kCopcGridBits | (part >> shift & kMask);
    return cell;
  }
  /// Squared distance from the middle of that cell.
  double offCentre(const CopcPlace& place, int level) const {
    const std::uint32_t cell = 1U << (kCopcBits - level - kCopcGridBits);
    double sum = 0.0;
    for (const std::uint32_t part : place) {
      const double off = static_cast<double>(part & (cell - 1)) - 0.5 * cell;
      sum += off * off;
    }
    return sum;
  }

  /// Takes one point of each cell off `rest`.
  Indices take(int level, Indices& rest) {
    for (const std::uint32_t i : rest) {
      std::uint32_t& nearest = nearest_[cellOf(places_[i], level)];
      if (nearest == kNone || offCentre(places_[i], level) < offCentre(places_[nearest], level)) {
        nearest = i;
      }
    }
    Indices taken;
    Indices left;
    for (const std::uint32_t i : rest) {
      (nearest_[cellOf(places_[i], level)] == i ? taken : left).push_back(i);
    }
    for (const std::uint32_t i : taken) nearest_[cellOf(places_[i], level)] = kNone;
    rest = std::move(left);
    return taken;
  }

  void keep(const CopcKey& key, const Indices& points) {
    CopcNode& node = nodes_.emplace_back();
    node.key = key;
    node.records.resize(points.size() * length_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::copy_n(&records_[points[i] * length_], length_, &node.records[i * length_]);
    }
  }

  void build(const CopcKey& key, Indices points) {
    throwIfInterrupted();
    if (points.empty()) return;
    if (points.size() <= kFew || key.level == kDeepest) return keep(key, points);
    keep(key, take(key.level, points));
    std::array<Indices, 8> children;
    for (const std::uint32_t i : points) {
      const CopcKey child = keyOf(places_[i], key.level + 1);
      children[static_cast<std::size_t>((child.x & 1) << 2 | (child.y & 1) << 1 | (child.z & 1))]
          .push_back(i);
    }
    points = {};
    for (Indices& child : children) {
      if (child.empty()) continue;
      const CopcKey below = keyOf(places_[child.front()], key.level + 1);
      build(below, std::move(child));
    }
  }

  const std::vector<std::byte>& records_;
  std::size_t length_;
  std::vector<CopcPlace> places_;
  std::vector<std::uint32_t> nearest_;  ///< by cell, while a node takes its points
  std::vector<CopcNode> nodes_;
};

}  // namespace

std::vector<CopcNode> copcNodes(const std::vector<std::byte>& records, const LasOutline& outline,
                                const CopcCube& cube, const CopcKey& part) {
  return Thinning(records, outline, cube).nodes(part);
}

}  // namespace agricolmap::io
