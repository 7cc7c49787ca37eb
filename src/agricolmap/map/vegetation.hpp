// Vegetation points of a grid map: what the point refinement registers. The threshold on Excess
// Green comes from each map's own histogram, since it depends on camera, light and soil.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

/// Whether a map's Excess Green tells plants from soil.
enum class VegetationStatus {
  kOk,
  kTooFewCells,   ///< too few filled cells for a histogram
  kConstant,      ///< all cells have the same Excess Green: a map without colours
  kNoVegetation,  ///< one population, not green: bare soil
  kClosedCanopy,  ///< one population, green: no soil between the plants
  kExtremeShare,  ///< two populations, one of them a handful of cells
};
std::string_view toString(VegetationStatus status);

struct VegetationOptions {
  /// Least (mean of plants − mean of soil)/(robust deviation of soil). One normal population split
  /// in two has 2.7; real soil and meaningless colours had 2.7–3.1, real crops 4.4–24.
  double min_contrast = 3.1;
  double min_share = 0.005;  ///< of vegetation and of soil among the filled cells
};
void listOptions(OptionTable& table, VegetationOptions& options);

/// Excess Green above which a cell is vegetation, and what stands on either side of it.
struct VegetationThreshold {
  VegetationStatus status = VegetationStatus::kTooFewCells;
  double threshold = 0.0;
  double soil_mean = 0.0;
  double vegetation_mean = 0.0;
  double contrast = 0.0;  ///< see VegetationOptions::min_contrast
  double share = 0.0;     ///< cells above the threshold / filled cells
};

/// Fits the threshold to the filled cells. A map without contrast is a status, not an error.
VegetationThreshold vegetationThreshold(const GridMap& map, const VegetationOptions& options);

/// A plant's piece of the levelled frame.
struct VegetationPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m]
  double height = 0.0;                                 ///< [m]
  double weight = 0.0;  ///< greenness 0…1 (threshold … mean of vegetation), summed when thinned
  /// Distance to the nearest ground that the map does not show: nearer than a few kernel widths,
  /// the map shows only one side of the plants' surroundings [m].
  double margin = std::numeric_limits<double>::infinity();
};

struct Vegetation {
  VegetationThreshold threshold;
  Raster<unsigned char> mask;           ///< 1 where vegetation
  std::vector<VegetationPoint> points;  ///< one per vegetation cell, row by row
};

/// Mask and points of a map. With status kClosedCanopy they are the greener half of the canopy,
/// whose texture both maps may share (simulated wheat was refined to 6 mm by it); with any other
/// status but kOk both are empty.
Vegetation extractVegetation(const GridMap& map, const VegetationOptions& options);

/// One point per occupied square of side `voxel`: weighted mean of its points, sum of the weights,
/// least margin.
/// Squares are anchored at zero and come row by row, so the result depends on nothing else.
std::vector<VegetationPoint> thinVegetation(const std::vector<VegetationPoint>& points,
                                            double voxel);

/// Thins to at most `count` (≥ 4) points with about the smallest square that does it; returns
/// `points` themselves when they are few enough.
std::vector<VegetationPoint> thinToAtMost(const std::vector<VegetationPoint>& points,
                                          std::size_t count);

}  // namespace agricolmap::map
