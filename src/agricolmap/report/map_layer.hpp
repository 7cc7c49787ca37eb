// One value of a grid map, made ready for drawing at any size.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/2_grid/grid_map.hpp"
#include "agricolmap/report/view.hpp"

namespace agricolmap {

/// What of the maps is drawn.
enum class PictureValue { kExg, kHeight };

/// A raster to draw: cells with weight 0 are empty. Refers to memory of the map or the layer.
struct LayerLevel {
  GridFrame frame;
  const float* value = nullptr;
  const float* weight = nullptr;
};

/// A map's value at its own and at coarser cell sizes, so that a picture touches about as many
/// cells as it has pixels, and small pictures show means instead of every seventh cell.
class MapLayer {
 public:
  /// Refers to `map`, which must outlive the layer.
  MapLayer(const GridMap& map, PictureValue value);

  /// The coarsest level whose cells are no larger than `pixel` [m], or the map's own.
  LayerLevel level(double pixel) const;
  /// The value below which `share` of the filled cells lie.
  double quantile(double share) const;
  const GridMap& map() const { return map_; }

 private:
  struct Coarse {
    GridFrame frame;
    Raster<float> value;
    Raster<float> weight;
  };
  static Coarse halved(const LayerLevel& fine);

  const GridMap& map_;
  const Raster<float>& value_;
  std::vector<Coarse> coarse_;
  std::vector<float> sorted_;  ///< a sample of the filled cells' values
};

/// The values of a level along one row of pixels.
class LayerRow {
 public:
  /// `level_from_ground`: the ground of the view → the frame of the level.
  LayerRow(const LayerLevel& level, const Eigen::Affine2d& level_from_ground, const View& view);

  /// Bilinear samples for the pixels of row `y`, read by `seen` and `value` afterwards.
  void sample(int y);
  /// Share of the cells around pixel i (from the view's left) that are filled, by nearness.
  float seen(int i) const { return seen_[static_cast<std::size_t>(i)]; }
  float value(int i) const { return value_[static_cast<std::size_t>(i)]; }

 private:
  LayerLevel level_;
  Eigen::Affine2d cell_from_pixel_;
  int left_;
  std::vector<float> seen_;
  std::vector<float> value_;
};

}  // namespace agricolmap
