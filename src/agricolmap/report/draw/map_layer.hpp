// One value of a grid map, made ready for drawing at any size.
#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/report/draw/view.hpp"

namespace agricolmap::report {

/// What of the maps is drawn.
enum class PictureValue { kExg, kHeight };

/// A cell to draw: what is known of it, and its value times that.
struct LayerCell {
  float weighted = 0.0F;
  float known = 0.0F;  ///< 0…1
};

/// A raster to draw.
struct LayerLevel {
  GridFrame frame;
  Raster<LayerCell> cells;
};

/// A map's value at its own and at coarser cell sizes, so that a picture touches about as many
/// cells as it has pixels, and small pictures show means instead of every seventh cell. Gaps of a
/// few cells are filled from the coarser sizes: sparse clouds make maps and not speckle.
class MapLayer {
 public:
  /// Refers to `map`, which must outlive the layer.
  MapLayer(const map::GridMap& map, PictureValue value);

  /// The coarsest level whose cells are no larger than `pixel` [m], or the one of the map's cells.
  const LayerLevel& level(double pixel) const;
  /// The value below which `share` of the filled cells lie.
  double quantile(double share) const;
  const map::GridMap& map() const { return map_; }

 private:
  const map::GridMap& map_;
  std::vector<LayerLevel> levels_;  ///< finest first
  std::vector<float> sorted_;       ///< a sample of the filled cells' values
};

/// The values of a layer along one row of pixels.
class LayerRow {
 public:
  /// `layer_from_ground`: the ground of the view → the frame of the layer.
  LayerRow(const MapLayer& layer, const Eigen::Affine2d& layer_from_ground, const View& view);

  /// Bilinear samples for the pixels of row `y`, read by `seen` and `value` afterwards.
  void sample(int y);
  /// Share of the cells around pixel i (from the view's left) that are known, by nearness.
  float seen(int i) const { return seen_[static_cast<std::size_t>(i)]; }
  float value(int i) const { return value_[static_cast<std::size_t>(i)]; }

 private:
  /// The pixels [begin, end) of a row that lie between the centres of the level's outer cells.
  std::pair<int, int> inside(const Eigen::Vector2f& start, const Eigen::Vector2f& step) const;

  const LayerLevel& level_;
  Eigen::Affine2d cell_from_pixel_;
  int left_;
  std::vector<float> seen_;
  std::vector<float> value_;
};

}  // namespace agricolmap::report
