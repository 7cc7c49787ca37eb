#include "agricolmap/fuse/owners.hpp"

#include <algorithm>
#include <tuple>

namespace agricolmap::fuse {
namespace {

/// A cell as deep inside a strip is as good as any [m].
constexpr float kDeep = 0.3F;

}  // namespace

Raster<std::uint16_t> ownersOf(const map::GridMap& fixed, const std::vector<Claim>& claims) {
  Raster<std::uint16_t> owners(fixed.frame.rows, fixed.frame.cols, kNoSource);
  for (std::size_t i = 0; i < owners.size(); ++i) {
    if (fixed.valid(i)) owners[i] = kFixedSource;
  }
  std::vector<const Claim*> ordered;
  for (const Claim& claim : claims) ordered.push_back(&claim);
  // The better come later and take from those before; depth alone differs from cell to cell.
  std::sort(ordered.begin(), ordered.end(), [](const Claim* a, const Claim* b) {
    return std::tuple(a->date, b->error, b->code) < std::tuple(b->date, a->error, a->code);
  });
  Raster<float> depth(owners.rows(), owners.cols(), 0.0F);
  Raster<std::int32_t> dates(owners.rows(), owners.cols(), -1);
  for (const Claim* claim : ordered) {
    const StripCells& cells = *claim->cells;
    for (int r = 0; r < cells.depth.rows(); ++r) {
      for (int c = 0; c < cells.depth.cols(); ++c) {
        const float own = std::min(cells.depth(r, c), kDeep);
        const std::size_t i = owners.index(cells.row + r, cells.col + c);
        if (own <= 0.0F || (claim->date == dates[i] && own < depth[i])) continue;
        owners[i] = claim->code;
        depth[i] = own;
        dates[i] = claim->date;
      }
    }
  }
  return owners;
}

}  // namespace agricolmap::fuse
