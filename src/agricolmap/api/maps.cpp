#include "agricolmap/maps.hpp"

#include <limits>

#include "agricolmap/api/checks.hpp"
#include "agricolmap/api/compared.hpp"
#include "agricolmap/api/record.hpp"
#include "agricolmap/api/values.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/map/footprint.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/level.hpp"

namespace agricolmap {
namespace {

CellMap cellMap(const map::GridMap& grid, bool coloured,
                const Eigen::Affine3d& file_from_levelled) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  CellMap cells;
  cells.rows = grid.frame.rows;
  cells.cols = grid.frame.cols;
  cells.cell_m = grid.frame.cell;
  cells.file_from_cell = file_from_levelled *
                         Eigen::Translation3d(grid.frame.corner.x(), grid.frame.corner.y(), 0.0) *
                         Eigen::Scaling(grid.frame.cell, grid.frame.cell, 1.0);
  const std::size_t count = grid.weight.size();
  cells.height_m.assign(count, kNothing);
  cells.excess_green.assign(count, kNothing);
  cells.weight.assign(count, 0.0F);
  cells.colour.assign(count, Rgb{});
  for (std::size_t i = 0; i < count; ++i) {
    if (!grid.valid(i)) continue;
    cells.weight[i] = grid.weight[i];
    cells.height_m[i] = grid.height[i];
    if (!coloured) continue;
    cells.excess_green[i] = grid.exg[i];
    cells.colour[i] = grid.colour[i];
  }
  return cells;
}

}  // namespace

ComparedMaps comparedMaps(const pipeline::PairMaps& maps,
                          const std::optional<Eigen::Affine3d>& local_fixed_from_moving,
                          const Eigen::Vector3d& fixed_origin, const Coloured& coloured) {
  const Eigen::Translation3d file_from_local(fixed_origin);
  const Eigen::Affine3d fixed = file_from_local * maps.frames.levelled_from_fixed.inverse();
  const Eigen::Affine3d moving =
      local_fixed_from_moving
          ? file_from_local * *local_fixed_from_moving * maps.frames.levelled_from_moving.inverse()
          : fixed;
  ComparedMaps both;
  both.fixed = cellMap(maps.fixed, coloured.fixed, fixed);
  both.moving = cellMap(maps.moving, coloured.moving, moving);
  return both;
}

ComparedMaps comparedMaps(const Registration& registration) {
  if (!registration.record) {
    throw UsageError("maps can only be had of what registerClouds returned");
  }
  const Registration::Record& record = *registration.record;
  std::optional<Eigen::Affine3d> laid;
  if (record.found.transform) laid = record.found.transform->local_fixed_from_moving;
  return comparedMaps(record.found.maps, laid, record.fixed_origin,
                      {record.fixed_coloured, record.moving_coloured});
}

CellMap mapCloud(const Cloud& cloud, const Options& options, const Control& control) {
  requireProcessor();
  requireWhole(cloud);
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  const pipeline::RegistrationOptions in_force = pipeline::resolved(options.values().options);
  const CloudStream points(cloud);
  const map::Levelling level = map::levelCloud(points, Eigen::Affine3d::Identity(), in_force.level);
  const Eigen::Affine3d& levelled_from_local = level.levelled_from_guess;
  const map::Footprint footprint = map::footprintOf(points, levelled_from_local);
  const map::GridMap grid = map::makeGridMap(points, levelled_from_local, footprint.box,
                                             map::coarsened(in_force.grid, footprint.spacing()));
  return cellMap(grid, cloud.hasColour(),
                 Eigen::Translation3d(cloud.origin) * levelled_from_local.inverse());
}

}  // namespace agricolmap
