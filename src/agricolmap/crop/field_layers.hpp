// The layers that crop facts look at, of a cloud that is no map yet.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/crop/view.hpp"

namespace agricolmap::crop {

struct FieldLayers {
  GridFrame frame;                                   ///< file coordinates less `origin` [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< whole metres
  Raster<float> exg;                                 ///< chromatic, NaN where there is none
  Raster<float> height;           ///< above ground, or above the field's plane; empty: not known
  bool above_ground = false;      ///< which of them `height` is
  Raster<Rgb> colour;             ///< means of the points where there are some; empty: not known
  Raster<std::uint8_t> coloured;  ///< 1 there; as large as `colour`

  View view() const { return {frame, exg, height}; }
};

/// A cloud gridded at the spacing of its points, which keep their places; heights are those above
/// the field's plane, none where the cloud has no relief. Throws InputError as map::levelCloud.
FieldLayers layersOf(const PointStream& cloud);

/// Heights above the soil that the layers show, unless they are that already, there are none, or
/// plants do not stand out from soil.
void bringToGround(FieldLayers& layers, const map::VegetationOptions& options);

}  // namespace agricolmap::crop
