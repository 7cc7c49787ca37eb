#include "agricolmap/crop/field_layers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "agricolmap/map/footprint.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/level.hpp"
#include "agricolmap/map/soil_ground.hpp"

namespace agricolmap::crop {
namespace {

constexpr double kSigmaCells = 0.6;   // of the mean of a cell's points
constexpr double kLeastCell = 0.004;  // finer ones show a leaf's veins [m]

/// Heights become those above the field's plane, places stay.
Eigen::Affine3d flattened(const map::Levelling& levelling) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.matrix().row(2) = levelling.levelled_from_guess.matrix().row(2);
  return result;
}

/// Points of a cloud leave cells empty that lie between seen ones: these take their neighbours'
/// mean.
void fillBetween(Raster<float>& values) {
  constexpr int kLeastNeighbours = 3;
  const Raster<float> before = values;
  for (int row = 1; row + 1 < values.rows(); ++row) {
    for (int col = 1; col + 1 < values.cols(); ++col) {
      if (std::isfinite(before(row, col))) continue;
      float sum = 0.0F;
      int count = 0;
      for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
          if (!std::isfinite(before(r, c))) continue;
          sum += before(r, c);
          ++count;
        }
      }
      if (count >= kLeastNeighbours) values(row, col) = sum / static_cast<float>(count);
    }
  }
}

/// The same for colours.
void fillColours(Raster<Rgb>& colours, Raster<std::uint8_t>& known) {
  constexpr int kLeastNeighbours = 3;
  const Raster<std::uint8_t> before = known;
  for (int row = 1; row + 1 < known.rows(); ++row) {
    for (int col = 1; col + 1 < known.cols(); ++col) {
      if (before(row, col) != 0) continue;
      int red = 0, green = 0, blue = 0, count = 0;
      for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
          if (before(r, c) == 0) continue;
          red += colours(r, c).r;
          green += colours(r, c).g;
          blue += colours(r, c).b;
          ++count;
        }
      }
      if (count < kLeastNeighbours) continue;
      colours(row, col) = {static_cast<std::uint8_t>(red / count),
                           static_cast<std::uint8_t>(green / count),
                           static_cast<std::uint8_t>(blue / count)};
      known(row, col) = 1;
    }
  }
}

}  // namespace

FieldLayers layersOf(const PointStream& cloud) {
  const map::Levelling levelling =
      map::levelCloud(cloud, Eigen::Affine3d::Identity(), map::LevelOptions());
  const Eigen::Affine3d flat = flattened(levelling);
  const map::Footprint footprint = map::footprintOf(cloud, flat);
  map::GridOptions grid;
  grid.cell = std::max(kLeastCell, footprint.spacing());
  grid.sigma = kSigmaCells * grid.cell;
  grid.coarsen = false;
  map::GridMap gridded = map::makeGridMap(cloud, flat, footprint.box, grid);
  FieldLayers layers;
  layers.frame = gridded.frame;
  layers.origin = cloud.facts().origin.head<2>();
  layers.coloured = Raster<std::uint8_t>(gridded.exg.rows(), gridded.exg.cols(), 1);
  for (std::size_t i = 0; i < gridded.exg.size(); ++i) {
    if (gridded.valid(i)) continue;
    layers.coloured[i] = 0;
    gridded.exg[i] = kUnknown;
    gridded.height[i] = kUnknown;
  }
  // An orthomosaic without a surface model is laid flat: that is no plants of no height.
  if (map::hasRelief(gridded)) {
    fillBetween(gridded.height);
    layers.height = std::move(gridded.height);
  }
  fillBetween(gridded.exg);
  layers.exg = std::move(gridded.exg);
  layers.colour = std::move(gridded.colour);
  fillColours(layers.colour, layers.coloured);
  return layers;
}

void bringToGround(FieldLayers& layers, const map::VegetationOptions& options) {
  if (layers.above_ground || layers.height.empty()) return;
  const Greenness greenness = greennessOf(layers.view(), options);
  if (!greenness.known()) return;
  const Raster<float> ground = map::soilGround(layers.frame, layers.height, greenness.green);
  for (std::size_t i = 0; i < ground.size(); ++i) layers.height[i] -= ground[i];
}

}  // namespace agricolmap::crop
