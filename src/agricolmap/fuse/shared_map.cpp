#include "agricolmap/fuse/shared_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/fuse/owners.hpp"
#include "agricolmap/fuse/seam.hpp"
#include "agricolmap/fuse/surface_map.hpp"
#include "agricolmap/map/footprint.hpp"
#include "agricolmap/map/soil_ground.hpp"

namespace agricolmap::fuse {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
/// Cells of the layers at most: about 3 GiB.
constexpr double kMostCells = 4e7;
/// A strip that moves less is not drawn anew [m].
constexpr double kLeastMove = 5e-4;

struct Extent {
  map::Box2 box;  ///< in the map's frame
  double spacing = 0.0;
};

Eigen::Vector3d shiftOf(const PointStream& cloud, const Eigen::Vector3d& origin) {
  return cloud.facts().origin - origin;
}

Extent extentOf(const PointStream& cloud, const Eigen::Vector3d& origin) {
  Eigen::Affine3d moved = Eigen::Affine3d::Identity();
  moved.translation() = shiftOf(cloud, origin);
  const map::Footprint footprint = map::footprintOf(cloud, moved);
  return {footprint.box, footprint.spacing()};
}

GridFrame frameOf(const map::Box2& box, double cell) {
  GridFrame frame;
  frame.cell = cell;
  const Eigen::Array2d low = (box.min().array() / cell).floor();
  const Eigen::Array2d high = (box.max().array() / cell).ceil().max(low + 1.0);
  frame.corner = (low * cell).matrix();
  frame.cols = static_cast<int>(high.x() - low.x());
  frame.rows = static_cast<int>(high.y() - low.y());
  return frame;
}

/// Cells that the fixed cloud fills, those of strips that the densest of them fill.
Lattice latticeOf(const PointStream& fixed, const std::vector<StripInput>& strips,
                  const FuseOptions& options, std::vector<std::string>& warnings) {
  const Eigen::Vector3d origin = fixed.facts().origin;
  Extent all = extentOf(fixed, origin);
  double spacing = std::numeric_limits<double>::infinity();
  std::vector<map::Box2> boxes;
  for (const StripInput& strip : strips) {
    const Extent own = extentOf(*strip.points, origin);
    if (!all.box.intersects(own.box)) {
      throw InputError(fmt::format(
          "{}: does not touch the fixed cloud; was it registered to another one?", strip.id));
    }
    spacing = std::min(spacing, own.spacing);
    boxes.push_back(own.box);
  }
  for (const map::Box2& box : boxes) all.box.extend(box);
  double cell = options.cell > 0.0 ? options.cell : cellFor(all.spacing);
  const double area = all.box.volume();
  if (area / (cell * cell) > kMostCells) {
    const double least = cellFor(std::sqrt(area / kMostCells));
    warnings.push_back(fmt::format(
        "the layers have cells of {:.3g} m instead of {:.3g} m: finer ones of {:.0f} x {:.0f} m "
        "take more memory than a map may",
        least, cell, all.box.sizes().x(), all.box.sizes().y()));
    cell = least;
  }
  const int factor = static_cast<int>(std::floor(cell / cellFor(spacing) + 1e-6));
  return {frameOf(all.box, cell), std::max(1, factor)};
}

/// Those that have heights, of a map that has them.
std::vector<const StripCells*> raisedOf(const SharedMap& map) {
  std::vector<const StripCells*> cells;
  for (const FusedStrip& strip : map.strips) {
    if (!strip.flat && !map.flat) cells.push_back(&strip.cells);
  }
  return cells;
}

std::vector<const StripCells*> cellsOf(const std::vector<FusedStrip>& strips) {
  std::vector<const StripCells*> cells;
  for (const FusedStrip& strip : strips) cells.push_back(&strip.cells);
  return cells;
}

/// Those whose heights were measured: others were laid on what they are to correct.
std::vector<const StripCells*> measuredOf(const std::vector<StripInput>& inputs,
                                          const std::vector<FusedStrip>& strips) {
  std::vector<const StripCells*> cells;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    if (!inputs[i].heights_limited && !strips[i].flat) cells.push_back(&strips[i].cells);
  }
  return cells;
}

/// Strips that overlap are moved to each other, and drawn anew where they moved.
void adjust(const std::vector<StripInput>& inputs, const Eigen::Vector3d& origin,
            const FuseOptions& options, SharedMap& map) {
  std::vector<StripErrors> errors;
  for (const FusedStrip& strip : map.strips) errors.push_back(strip.errors);
  const FineStrips fine{map.lattice.factor, [&](std::size_t i) {
                          return fineCells(*inputs[i].points, shiftOf(*inputs[i].points, origin),
                                           map.lattice);
                        }};
  map.overlaps = compareStrips(cellsOf(map.strips), fine, errors);
  for (const Disagreement& pair : map.overlaps) {
    if (pair.plausible()) continue;
    map.warnings.push_back(fmt::format(
        "{} and {} lie {:.0f} cm apart in the plane and {:.0f} cm in height where they overlap, "
        "{:.1f} times what their errors allow: one of them is wrong",
        map.strips[pair.first].id, map.strips[pair.second].id, 100.0 * pair.offset.head<2>().norm(),
        100.0 * std::abs(pair.offset.z()), pair.sigmas));
  }
  if (!options.adjust) return;
  const std::vector<Eigen::Vector3d> shifts = adjustedShifts(map.overlaps, errors);
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    if (shifts[i].norm() < kLeastMove) continue;
    map.strips[i].moved = shifts[i];
    map.strips[i].cells =
        stripCells(*inputs[i].points, shiftOf(*inputs[i].points, origin) + shifts[i], map.lattice,
                   options.least_seen);
  }
}

Raster<float> coverOf(const map::GridMap& map, const Greenness& greenness) {
  Raster<float> cover(map.frame.rows, map.frame.cols, kNone);
  for (std::size_t i = 0; i < cover.size(); ++i) {
    if (map.valid(i)) cover[i] = greenness.cover(map.exg[i]);
  }
  return cover;
}

/// The layers that are filled source by source.
void allocate(Layers& layers) {
  const GridFrame& frame = layers.frame;
  for (Raster<float>* raster : {&layers.surface, &layers.exg, &layers.cover, &layers.density,
                                &layers.plane_error, &layers.height_error}) {
    *raster = Raster<float>(frame.rows, frame.cols, kNone);
  }
  layers.colour = Raster<Rgb>(frame.rows, frame.cols);
  layers.date = Raster<std::int32_t>(frame.rows, frame.cols);
}

void takeFixed(const FixedHeights& fixed, std::int32_t date, const SharedMap& map, Layers& layers) {
  const auto per_area = static_cast<float>(1.0 / (fixed.map.frame.cell * fixed.map.frame.cell));
  parallelFor(
      layers.source.size(),
      [&](std::size_t i) {
        if (!fixed.map.valid(i)) return;
        layers.surface[i] = fixed.map.height[i] + map.correction[i];
        layers.exg[i] = fixed.map.exg[i];
        layers.cover[i] = fixed.cover[i];
        layers.density[i] = std::floor(fixed.map.weight[i]) * per_area;
        layers.colour[i] = fixed.map.colour[i];
        layers.date[i] = date;
        layers.plane_error[i] = 0.0F;
        const std::optional<HeightShift> shift = map.bias ? map.bias->at(fixed, i) : std::nullopt;
        if (shift) layers.height_error[i] = static_cast<float>(shift->deviation);
      },
      1U << 14);
}

void takeStrip(FusedStrip& strip, bool match_colours, Layers& layers) {
  const double area = layers.frame.cell * layers.frame.cell;
  const StripCells& cells = strip.cells;
  for (int r = 0; r < cells.depth.rows(); ++r) {
    for (int c = 0; c < cells.depth.cols(); ++c) {
      if (cells.depth(r, c) <= 0.0F) continue;
      strip.seen_area += area;
      const std::size_t i = layers.source.index(cells.row + r, cells.col + c);
      if (layers.source[i] != strip.code) continue;
      strip.owned_area += area;
      if (!strip.flat) layers.surface[i] = cells.coarse.height(r, c);
      layers.cover[i] = strip.greenness.cover(cells.coarse.exg(r, c));
      layers.exg[i] = cells.coarse.exg(r, c);
      layers.colour[i] = cells.coarse.colour(r, c);
      if (match_colours) {
        layers.colour[i] = strip.tone(layers.colour[i]);
        layers.exg[i] = map::excessGreen(layers.colour[i], map::ExgKind::kChromatic);
      }
      layers.density[i] = cells.coarse.weight(r, c) / static_cast<float>(area);
      layers.date[i] = strip.date;
      layers.plane_error[i] = static_cast<float>(strip.errors.plane);
      if (!strip.flat) layers.height_error[i] = static_cast<float>(strip.errors.height);
    }
  }
}

/// Strips by their ids, so that nothing depends on the order in which they were named.
std::vector<StripInput> sorted(std::vector<StripInput> strips) {
  std::sort(strips.begin(), strips.end(),
            [](const StripInput& a, const StripInput& b) { return a.id < b.id; });
  for (std::size_t i = 1; i < strips.size(); ++i) {
    if (strips[i].id == strips[i - 1].id) {
      throw UsageError(fmt::format("two strips are called {}", strips[i].id));
    }
  }
  return strips;
}

/// Every strip on the lattice, as it was laid.
void takeStrips(const std::vector<StripInput>& inputs, const Eigen::Vector3d& origin,
                const FuseOptions& options, SharedMap& map) {
  map.strips.resize(inputs.size());
  parallelFor(inputs.size(), [&](std::size_t i) {
    FusedStrip& strip = map.strips[i];
    strip.id = inputs[i].id;
    strip.code = static_cast<std::uint16_t>(kFixedSource + 1 + i);
    strip.date = inputs[i].date;
    strip.errors = inputs[i].errors;
    strip.cells = stripCells(*inputs[i].points, shiftOf(*inputs[i].points, origin), map.lattice,
                             options.least_seen);
  });
}

/// What each strip's colours and heights are worth beside the fixed cloud's.
void compareWithFixed(const map::GridMap& fixed, std::int32_t fixed_date, SharedMap& map) {
  for (FusedStrip& strip : map.strips) {
    strip.greenness = greennessOf(strip.cells.coarse);
    const bool same_day = strip.date == 0 || fixed_date == 0 || strip.date == fixed_date;
    strip.tone = toneOf(strip.cells, strip.greenness, fixed, map.fixed_greenness, same_day);
    strip.flat = !map::hasRelief(strip.cells.coarse);
    if (strip.flat && !map.flat) {
      map.warnings.push_back(strip.id +
                             ": has no heights; those of its cells are the fixed cloud's");
    }
  }
}

Raster<float> surfaceOf(const map::GridMap& map) {
  Raster<float> surface = map.height;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (!map.valid(i)) surface[i] = kNone;
  }
  return surface;
}

/// What the fixed cloud shows, and what is known of it.
struct Drone {
  map::GridMap map;
  Raster<float> ground;
  Raster<float> cover;

  FixedHeights heights() const { return {map, ground, cover}; }
};

/// `drone` is given up as soon as the layers have it: it is half as large as they are.
void composeLayers(Drone drone, std::int32_t fixed_date, bool match_colours, SharedMap& map) {
  std::vector<Claim> claims;
  for (const FusedStrip& strip : map.strips) {
    claims.push_back({&strip.cells, strip.code, strip.date,
                      std::hypot(strip.errors.plane, strip.errors.height)});
  }
  Layers& layers = map.layers;
  layers.source = ownersOf(drone.map, claims);
  allocate(layers);
  takeFixed(drone.heights(), fixed_date, map, layers);
  drone = {};
  for (FusedStrip& strip : map.strips) takeStrip(strip, match_colours, layers);
  layers.ground = map::soilGround(layers.frame, layers.surface, layers.cover);
  layers.plant_height = layers.surface;
  for (std::size_t i = 0; i < layers.ground.size(); ++i) {
    layers.plant_height[i] -= layers.ground[i];
  }
}

}  // namespace

SharedMap shareMap(const PointStream& fixed, std::int32_t fixed_date,
                   std::vector<StripInput> strips, const FuseOptions& options,
                   const StepListener& on_step) {
  checkOptions(options);
  const auto step = [&](std::string_view what) {
    throwIfInterrupted();
    if (on_step) on_step(what);
  };
  const std::vector<StripInput> inputs = sorted(std::move(strips));
  const Eigen::Vector3d origin = fixed.facts().origin;
  SharedMap map;
  step("extents");
  map.lattice = latticeOf(fixed, inputs, options, map.warnings);
  map.layers.frame = map.lattice.frame;
  map.layers.origin = origin;

  step("fixed cloud");
  Drone drone{surfaceMap(fixed, Eigen::Vector3d::Zero(), map.lattice.frame), {}, {}};
  fillBetween(drone.map);
  map.fixed_greenness = greennessOf(drone.map);
  map.flat = !map::hasRelief(drone.map);

  step("strips");
  takeStrips(inputs, origin, options, map);
  adjust(inputs, origin, options, map);
  compareWithFixed(drone.map, fixed_date, map);

  step("heights");
  drone.cover = coverOf(drone.map, map.fixed_greenness);
  drone.ground = map::soilGround(map.lattice.frame, surfaceOf(drone.map), drone.cover);
  if (options.correct_heights && !map.flat) {
    map.bias = heightBiasOf(drone.heights(), measuredOf(inputs, map.strips));
  }
  map.correction = heightCorrection(drone.heights(), map.bias, raisedOf(map), options.seam);

  step("layers");
  composeLayers(std::move(drone), fixed_date, options.match_colours, map);
  return map;
}

map::GridMap fineMap(const SharedMap& map, std::size_t strip, const PointStream& points) {
  return fineCells(points, shiftOf(points, map.layers.origin) + map.strips[strip].moved,
                   map.lattice);
}

}  // namespace agricolmap::fuse
