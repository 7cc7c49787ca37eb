#include "agricolmap/map/warp.hpp"

#include <array>
#include <cmath>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::map {

namespace {

/// Lattice-aligned frame around the moved corners of another.
GridFrame frameAround(const GridFrame& frame, const Eigen::Affine2d& warped_from_map) {
  Box2 box;
  for (const double row : {-0.5, frame.rows - 0.5}) {
    for (const double col : {-0.5, frame.cols - 0.5}) {
      box.extend(warped_from_map * frame.centre(row, col));
    }
  }
  const Eigen::Array2d low = (box.min().array() / frame.cell).floor();
  const Eigen::Array2d count = (box.max().array() / frame.cell).ceil() - low;
  GridFrame result;
  result.cell = frame.cell;
  result.corner = (low * frame.cell).matrix();
  result.cols = static_cast<int>(count.x());
  result.rows = static_cast<int>(count.y());
  return result;
}

/// Writes cell `to` of `out` from around `place` (continuous column, row) of `map`.
void sampleCell(const GridMap& map, const Eigen::Vector2d& place, GridMap& out, std::size_t to) {
  const auto cells = cellsAround<double>(place.x(), place.y());
  const std::array<double, 4> shares = cells.shares();
  float known = 0.0F;
  float heaviest = 0.0F;
  float weight = 0.0F;
  float height = 0.0F;
  float exg = 0.0F;
  for (int k = 0; k < 4; ++k) {
    const int row = cells.row + (k >> 1);
    const int col = cells.col + (k & 1);
    if (!map.weight.contains(row, col) || !map.valid(row, col)) continue;
    const std::size_t i = map.weight.index(row, col);
    const auto share = static_cast<float>(shares[static_cast<std::size_t>(k)]);
    known += share;
    weight += share * map.weight[i];
    height += share * map.height[i];
    exg += share * map.exg[i];
    if (share > heaviest) {
      heaviest = share;
      out.colour[to] = map.colour[i];
    }
  }
  if (known < 0.5F) return;
  out.weight[to] = weight / known;
  out.height[to] = height / known;
  out.exg[to] = exg / known;
}

}  // namespace

GridMap warped(const GridMap& map, const Eigen::Affine2d& warped_from_map) {
  GridMap out;
  out.frame = frameAround(map.frame, warped_from_map);
  out.points = map.points;
  const int rows = out.frame.rows;
  const int cols = out.frame.cols;
  out.weight = Raster<float>(rows, cols);
  out.height = Raster<float>(rows, cols);
  out.exg = Raster<float>(rows, cols);
  out.colour = Raster<Rgb>(rows, cols);
  const Eigen::Affine2d map_from_warped = warped_from_map.inverse();
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        for (int col = 0; col < cols; ++col) {
          const Eigen::Vector2d place =
              map.frame.cellOf(map_from_warped * out.frame.centre(row, col));
          sampleCell(map, place, out, out.weight.index(row, col));
        }
      },
      8);
  for (std::size_t i = 0; i < out.weight.size(); ++i) out.filled += out.valid(i) ? 1 : 0;
  return out;
}

}  // namespace agricolmap::map
