#include "agricolmap/verdict/sides.hpp"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::verdict {
namespace {

constexpr std::size_t kLeastPairs = 6;
/// What sides must lie apart by: so much, and so many times what neighbours do [m].
constexpr double kLeastApart = 0.03;
constexpr double kBeyondNeighbours = 1.8;

}  // namespace

std::optional<double> sidesApart(const Evidence& evidence) {
  if (evidence.block_size.minCoeff() <= 0.0) return std::nullopt;
  const long across = std::lround(2.0 * evidence.strip.half_extent.y() / evidence.block_size.y());
  if (across < 2) return std::nullopt;
  // The outermost blocks of either side, by their number along the strip.
  std::map<long, Eigen::Vector2d> sides[2];
  for (const BlockEvidence& block : evidence.blocks) {
    const Eigen::Vector2d at = (evidence.strip.local(block.moving) + evidence.strip.half_extent)
                                   .cwiseQuotient(evidence.block_size);
    const auto column = static_cast<long>(std::floor(at.y()));
    if (column != 0 && column != across - 1) continue;
    sides[column == 0 ? 0 : 1].emplace(static_cast<long>(std::floor(at.x())), block.offset);
  }
  std::vector<double> apart, along;
  for (const auto& [i, offset] : sides[0]) {
    const auto other = sides[1].find(i);
    if (other != sides[1].end()) apart.push_back((offset - other->second).norm());
  }
  for (const auto& side : sides) {
    for (const auto& [i, offset] : side) {
      const auto next = side.find(i + 1);
      if (next != side.end()) along.push_back((offset - next->second).norm());
    }
  }
  if (apart.size() < kLeastPairs || along.size() < kLeastPairs) return std::nullopt;
  const double usual = median(std::move(apart));
  if (usual < kLeastApart || usual < kBeyondNeighbours * median(std::move(along))) {
    return std::nullopt;
  }
  return usual;
}

}  // namespace agricolmap::verdict
