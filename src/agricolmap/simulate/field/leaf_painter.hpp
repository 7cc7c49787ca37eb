// Rasterises plants' leaves from above.
#pragma once

#include <array>

#include "agricolmap/simulate/field/canvas.hpp"
#include "agricolmap/simulate/field/plant.hpp"

namespace agricolmap::simulate {

/// Draws leaves into a rectangle of the canvas's cells, keeping the higher surface in each.
class LeafPainter {
 public:
  struct Tile {
    int row0 = 0;
    int row1 = 0;
    int col0 = 0;
    int col1 = 0;
  };
  LeafPainter(Canvas& canvas, const Tile& tile, const Eigen::Vector3f& sun_in_window);
  /// `soil` is the soil's height at the plant [m].
  void paint(const Plant& plant, const Foliage& foliage, float soil);

 private:
  struct Ribbon;
  void paintRibbon(const Ribbon& ribbon);
  void paintLeaf(const Leaf& leaf, const Eigen::Vector3f& base, const std::array<float, 3>& albedo);

  Canvas* canvas_;
  Tile tile_;
  Eigen::Vector3f sun_;
  float heading_;
  float cell_;
};

}  // namespace agricolmap::simulate
