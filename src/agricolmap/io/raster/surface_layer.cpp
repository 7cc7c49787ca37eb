#include "agricolmap/io/raster/surface_layer.hpp"

#include <algorithm>
#include <utility>

namespace agricolmap::io {

RasterPlace placeOf(const LayerShape& shape) {
  const GridFrame& frame = shape.frame;
  Eigen::Affine2d world_from_pixel = Eigen::Affine2d::Identity();
  world_from_pixel.linear().diagonal() << frame.cell, -frame.cell;
  world_from_pixel.translation() =
      shape.origin.head<2>() + frame.corner + Eigen::Vector2d(0.0, frame.rows * frame.cell);
  return {world_from_pixel, shape.crs};
}

SurfaceLayer readSurfaceLayer(const std::filesystem::path& path, const LayerShape& shape,
                              const CellWindow& window) {
  const int top = shape.frame.rows - window.row - window.rows;
  RasterHeights heights =
      readHeights(path, {PixelWindow{window.col, top, window.cols, window.rows}, 1});
  Raster<float>& rows = heights.height;
  for (int low = 0, high = rows.rows() - 1; low < high; ++low, --high) {
    std::swap_ranges(rows.row(low), rows.row(low) + rows.cols(), rows.row(high));
  }
  return {std::move(rows), std::move(heights.warnings)};
}

SurfaceLayer readSurfaceLayer(const std::filesystem::path& path, const LayerShape& shape) {
  return readSurfaceLayer(path, shape, {0, 0, shape.frame.rows, shape.frame.cols});
}

}  // namespace agricolmap::io
