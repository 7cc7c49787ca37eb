// Sums over parts of a field.
#pragma once

#include <cstdint>
#include <vector>

#include "agricolmap/crop/facts.hpp"

namespace agricolmap::crop {

/// Which part each cell of a frame belongs to; −1: none.
using Zones = Raster<std::int32_t>;

/// The squares of side `side`, on its multiples in `origin` + frame, and where they lie.
Zones squareZones(const GridFrame& frame, const Eigen::Vector2d& origin, double side,
                  std::vector<GridSquare>& squares);
/// The plots; where they overlap, the later one.
Zones plotZones(const GridFrame& frame, const std::vector<Plot>& plots);

/// A height that stands for a plant, or for a spacing of a row where plants touch.
struct PlantTop {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double height = 0.0;
};

/// The facts of `count` parts.
std::vector<StandFacts> zoneFacts(const GridFrame& frame, const Zones& zones, std::size_t count,
                                  const FieldFacts& field, const RowBands& bands,
                                  const std::vector<PlantTop>& tops);

}  // namespace agricolmap::crop
