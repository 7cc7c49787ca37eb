#include "agricolmap/api/field_rasters.hpp"

namespace agricolmap {

GridFrame frameOf(const FieldMap& map, const Eigen::Vector2d& origin) {
  if (map.rows <= 0 || map.cols <= 0 || !(map.cell_m > 0.0)) {
    throw UsageError("the map has no cells; give one that fuseClouds or readFieldMap returned");
  }
  const Eigen::Vector2d corner = map.file_from_cell.translation().head<2>();
  return {corner - origin, map.cell_m, map.rows, map.cols};
}

Transform fileFromCell(const GridFrame& frame, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d corner = origin + Eigen::Vector3d(frame.corner.x(), frame.corner.y(), 0.0);
  return Eigen::Translation3d(corner) * Eigen::Scaling(frame.cell, frame.cell, 1.0);
}

Eigen::Vector2d originOf(const FieldMap& map) {
  return map.file_from_cell.translation().head<2>().array().floor();
}

std::vector<crop::Plot> plotsAbout(const Eigen::Vector2d& origin, const std::vector<Plot>& plots) {
  std::vector<crop::Plot> moved;
  for (const Plot& plot : plots) {
    if (plot.corners.size() < 3) {
      throw UsageError(fmt::format("plot {}: has {} corners; give three or more", plot.name,
                                   plot.corners.size()));
    }
    for (const Eigen::Vector2d& corner : plot.corners) {
      if (!corner.allFinite()) {
        throw UsageError(fmt::format("plot {}: has a corner at {:g}, {:g}; give finite numbers",
                                     plot.name, corner.x(), corner.y()));
      }
    }
    crop::Plot& added = moved.emplace_back(crop::Plot{plot.name, plot.corners});
    for (Eigen::Vector2d& corner : added.corners) corner -= origin;
  }
  return moved;
}

}  // namespace agricolmap
