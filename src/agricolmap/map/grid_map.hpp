// Stage grid: the multimodal grid map (paper Sec. III-A): per cell a surface height and an Excess
// Green index, both Gaussian-weighted means of the cell's points.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::map {

/// How greenness is computed from sensor colours r, g, b.
enum class ExgKind {
  kPlain,      ///< (2g − r − b)/255, the paper's: −2…2, follows brightness
  kChromatic,  ///< (2g − r − b)/(r + g + b): −1…2, the same in sun and shade
};

struct GridOptions {
  double cell = 0.02;   ///< s (Tab. III) [m]
  double sigma = 0.04;  ///< σ_avg (Tab. III) [m]
  ExgKind exg = ExgKind::kChromatic;
  /// Larger cells, and σ with them, where a cloud has fewer points than cells.
  bool coarsen = true;
};
void listOptions(OptionTable& table, GridOptions& options);

/// Excess Green of one colour.
float excessGreen(Rgb colour, ExgKind kind);
/// How bright a colour is, 0…1 (ITU-R BT.601).
inline float luminance(Rgb colour) {
  return (0.299F * colour.r + 0.587F * colour.g + 0.114F * colour.b) / 255.0F;
}

/// All rasters have the frame's size; where `weight` is 0 the cell is empty and the other values
/// mean nothing. Coordinates are those of the levelled frame.
struct GridMap {
  GridFrame frame;
  Raster<float> weight;    ///< points that the cell's values rest on, 0 = empty
  Raster<float> height;    ///< mean height above the levelled ground plane [m]
  Raster<float> exg;       ///< mean Excess Green
  Raster<Rgb> colour;      ///< mean colour
  std::size_t points = 0;  ///< points that fell into the map
  std::size_t filled = 0;  ///< cells that are not empty
  /// Robust deviation of the ground from height 0 where the cloud shows it [m]; infinite: unknown.
  double ground_deviation = std::numeric_limits<double>::infinity();
  /// Excess Green below which a cell is soil; nothing unless this map and the one that it is
  /// compared with both tell it from plants (`tellSoil`).
  std::optional<float> soil_below;

  bool valid(int row, int col) const { return weight(row, col) > 0.0F; }
  bool valid(std::size_t i) const { return weight[i] > 0.0F; }
};

/// Horizontal window of the levelled frame [m].
using Box2 = Eigen::AlignedBox2d;

/// The options for clouds with points this far apart [m]: as they are, or, if they may be, coarser.
GridOptions coarsened(const GridOptions& options, double spacing);

/// Grids the points of `cloud` that lie in `window` after `levelled_from_local`. Cell borders lie
/// on multiples of the cell size, so maps of one frame share their lattice. One pass, in which each
/// cell takes 43 bytes; the map's take 15. Throws InputError when no point lies in the window.
GridMap makeGridMap(const PointStream& cloud, const Eigen::Affine3d& levelled_from_local,
                    const Box2& window, const GridOptions& options);
GridMap makeGridMap(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local,
                    const Box2& window, const GridOptions& options);

/// How tall the plants are [m]: height above the ground that a tenth of the seen cells surpass.
double canopyHeight(const GridMap& map);

/// Whether heights of the map differ by more than what rounding makes of a flat cloud's.
bool hasRelief(const GridMap& map);

/// The part of a map whose cells touch `window`; `points` stays the whole map's.
GridMap croppedMap(const GridMap& map, const Box2& window);

}  // namespace agricolmap::map
