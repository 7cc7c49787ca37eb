// What a shared map says of every cell of the field.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "agricolmap/cloud.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::fuse {

/// Number of a source in the layer `source`; strips follow.
inline constexpr std::uint16_t kNoSource = 0;
inline constexpr std::uint16_t kFixedSource = 1;

/// Floats are NaN where nothing is known. Row 0 is the southernmost.
struct Layers {
  GridFrame frame;                                   ///< about `origin` [m]
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< file coordinates of the local zero [m]
  Raster<float> surface;                             ///< above origin.z() [m]
  Raster<float> ground;                              ///< above origin.z() [m]
  Raster<float> plant_height;                        ///< surface − ground [m]
  Raster<float> exg;           ///< chromatic Excess Green, strips' brought to the fixed cloud's
  Raster<float> cover;         ///< share of the cell that is vegetation, 0…1
  Raster<float> density;       ///< points per m²
  Raster<float> plane_error;   ///< expected RMS in the plane, against the fixed cloud's frame [m]
  Raster<float> height_error;  ///< expected RMS of the surface [m]
  Raster<Rgb> colour;          ///< means nothing where `source` is kNoSource
  Raster<std::uint16_t> source;
  Raster<std::int32_t> date;  ///< YYYYMMDD; 0: nobody said
};

}  // namespace agricolmap::fuse
