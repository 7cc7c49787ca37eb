#include "agricolmap/pipeline/maps.hpp"

#include <algorithm>

#include "agricolmap/map/soil_texture.hpp"

namespace agricolmap::pipeline {
namespace {

void levelAndBound(const CloudFacts& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                   const RegistrationOptions& options, PairMaps& maps) {
  levelMoving(fixed, moving, guess, options.level, maps.frames);
  maps.moving_box = maps.frames.moving_footprint.box;
  maps.space = searchSpace(maps.moving_box, maps.frames, options.prior);
}

/// Cells that both clouds fill.
map::GridOptions cellsFor(const PairFrames& frames, const RegistrationOptions& options) {
  double spacing = frames.fixed_footprint.spacing();
  if (!options.prior.scale_unknown) {
    spacing = std::max(spacing, frames.moving_footprint.spacing());
  }
  return map::coarsened(options.grid, spacing);
}

void gridFixed(const PointStream& fixed, const RegistrationOptions& options, PairMaps& maps) {
  // Room for the high-pass.
  const map::Box2 window =
      options.prior.scale_unknown
          ? maps.fixed_box
          : reachableWindow(maps.moving_box, maps.space, 2.0 * options.signal.high_pass);
  maps.fixed = map::makeGridMap(fixed, maps.frames.levelled_from_fixed,
                                window.intersection(maps.fixed_box), maps.grid);
  maps.fixed.ground_deviation = maps.frames.fixed.roughness;
}

void gridMoving(const Cloud& moving, PairMaps& maps) {
  maps.moving =
      map::makeGridMap(moving, maps.frames.levelled_from_moving, maps.moving_box, maps.grid);
  maps.moving.ground_deviation = maps.frames.moving.roughness;
}

}  // namespace

PairMaps mapPair(const FixedCloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const RegistrationOptions& options, Monitor& monitor) {
  PairMaps maps;
  monitor.run(Stage::kLevel, [&] {
    const Eigen::Affine3d centred = centredGuess(fixed, moving, guess, options.prior);
    if (placesByPieces(options)) {
      maps.frames.turn =
          turnAlong(fixed.facts(), moving, centred, options.prior, options.pieces.from);
    }
    levelFixed(fixed, options.level, maps.frames);
    maps.fixed_box = maps.frames.fixed_footprint.box;
    levelAndBound(fixed.facts(), moving, centred, options, maps);
  });
  if (!options.prior.scale_unknown) {
    requirePlausibleExtents(fixed.facts(), moving, maps.fixed_box, maps.moving_box);
  }
  monitor.run(Stage::kGrid, [&] {
    maps.grid = cellsFor(maps.frames, options);
    gridFixed(fixed.points(), options, maps);
    if (options.prior.scale_unknown) return;
    gridMoving(moving, maps);
    map::tellSoil(maps.fixed, maps.moving);
  });
  return maps;
}

void mapMoving(const CloudFacts& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
               const RegistrationOptions& options, Monitor& monitor, PairMaps& maps) {
  monitor.run(Stage::kLevel, [&] { levelAndBound(fixed, moving, guess, options, maps); });
  monitor.run(Stage::kGrid, [&] { gridMoving(moving, maps); });
}

map::GridMap straightMap(const Cloud& moving, const pieces::Bend& bend, const PairMaps& maps,
                         Monitor& monitor) {
  return monitor.run(Stage::kGrid, [&] {
    const Cloud bent = pieces::bentCloud(moving, maps.frames.levelled_from_moving, bend);
    const map::Box2 box = map::footprintOf(bent, maps.frames.levelled_from_moving).box;
    map::GridMap straight =
        map::makeGridMap(bent, maps.frames.levelled_from_moving, box, maps.grid);
    straight.ground_deviation = maps.moving.ground_deviation;
    straight.soil_below = maps.moving.soil_below;
    return straight;
  });
}

}  // namespace agricolmap::pipeline
