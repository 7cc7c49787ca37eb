#include "agricolmap/fuse/strip_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/fuse/chamfer.hpp"
#include "agricolmap/fuse/surface_map.hpp"

namespace agricolmap::fuse {
namespace {

using Mask = Raster<std::uint8_t>;

/// The window of the map's frame that holds the cloud, and a cell around it.
std::pair<GridFrame, Eigen::Vector2i> windowOf(const PointStream& cloud,
                                               const Eigen::Vector3d& shift, const GridFrame& map) {
  const Box3 box = cloud.box();
  const auto cellAt = [&](const Eigen::Vector3f& corner, int axis) {
    const double at = static_cast<double>(corner[axis]) + shift[axis];
    return static_cast<int>(std::floor((at - map.corner[axis]) / map.cell));
  };
  const int left = std::max(0, cellAt(box.min, 0) - 1);
  const int low = std::max(0, cellAt(box.min, 1) - 1);
  const int right = std::min(map.cols, cellAt(box.max, 0) + 2);
  const int high = std::min(map.rows, cellAt(box.max, 1) + 2);
  GridFrame window = map;
  window.corner += map.cell * Eigen::Vector2d(left, low);
  window.cols = std::max(0, right - left);
  window.rows = std::max(0, high - low);
  return {window, {low, left}};
}

/// What most of the nine cells around each cell say: closes single holes, drops single cells.
Mask majority(const Mask& mask) {
  Mask out(mask.rows(), mask.cols());
  for (int row = 0; row < mask.rows(); ++row) {
    for (int col = 0; col < mask.cols(); ++col) {
      int set = 0;
      for (int r = std::max(0, row - 1); r <= std::min(mask.rows() - 1, row + 1); ++r) {
        for (int c = std::max(0, col - 1); c <= std::min(mask.cols() - 1, col + 1); ++c) {
          set += mask(r, c);
        }
      }
      out(row, col) = set >= 5 ? 1 : 0;
    }
  }
  return out;
}

Mask seenCells(const map::GridMap& coarse, double least_seen) {
  std::vector<float> counts;
  for (std::size_t i = 0; i < coarse.weight.size(); ++i) {
    if (coarse.valid(i)) counts.push_back(coarse.weight[i]);
  }
  Mask mask(coarse.frame.rows, coarse.frame.cols);
  if (counts.empty()) return mask;
  const float least = static_cast<float>(least_seen) * median(counts);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = coarse.weight[i] >= least ? 1 : 0;
  Mask seen = majority(mask);
  // A closed hole without any point has nothing to show.
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!coarse.valid(i)) seen[i] = 0;
  }
  return seen;
}

Mask inverted(const Mask& mask) {
  Mask out(mask.rows(), mask.cols());
  for (std::size_t i = 0; i < mask.size(); ++i) out[i] = mask[i] == 0 ? 1 : 0;
  return out;
}

}  // namespace

map::GridMap fineCells(const PointStream& cloud, const Eigen::Vector3d& shift,
                       const Lattice& lattice) {
  GridFrame fine = windowOf(cloud, shift, lattice.frame).first;
  fine.cell /= lattice.factor;
  fine.rows *= lattice.factor;
  fine.cols *= lattice.factor;
  return surfaceMap(cloud, shift, fine);
}

StripCells stripCells(const PointStream& cloud, const Eigen::Vector3d& shift,
                      const Lattice& lattice, double least_seen) {
  const Eigen::Vector2i begin = windowOf(cloud, shift, lattice.frame).second;
  StripCells cells;
  cells.row = begin[0];
  cells.col = begin[1];
  cells.coarse = coarsened(fineCells(cloud, shift, lattice), lattice.factor);
  cells.depth =
      chamferDistance(inverted(seenCells(cells.coarse, least_seen)), lattice.frame.cell, 0.0F);
  return cells;
}

}  // namespace agricolmap::fuse
