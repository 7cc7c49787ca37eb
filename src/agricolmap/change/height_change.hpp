// Which differences between two surfaces are more than their errors. The idea is M3C2's (Lague,
// Brodu, Leroux 2013, ISPRS J. Photogramm. 82): each place has a level of detection of its own,
// from what is known of the errors there, and not one threshold for all.
#pragma once

#include <cstdint>

#include "agricolmap/core/raster.hpp"

namespace agricolmap::change {

/// Deviations that 95 % of what is normal lies within.
inline constexpr double kLevel95 = 1.96;

/// One map on the common grid. All rasters are of one size.
struct MapHeights {
  Raster<float> surface;         ///< [m], NaN where there is none
  Raster<float> plane_error;     ///< expected RMS of the place, both axes together [m]
  Raster<float> height_error;    ///< expected RMS of the surface [m]
  Raster<std::uint16_t> source;  ///< what each cell comes from; 0 where it is not said
};

/// Expected RMS between the frames of the two maps, which no map knows alone: what two flights of
/// a drone lie apart [m].
struct FrameError {
  double plane = 0.0;
  double height = 0.0;
};

/// NaN where one of the maps has no surface or no errors.
struct HeightChange {
  Raster<float> change;       ///< b − a [m]
  Raster<float> detection;    ///< what |change| exceeds at 5 % of unchanged cells [m]
  Raster<float> significant;  ///< 1 where it does, else 0
};

/// Expected RMS of heights that are read `plane_error` [m] beside their place: by the mean square
/// of the steps to the four cells that far away, at least to the next ones, in proportion. NaN
/// where none of these has a height.
Raster<float> slopeError(const Raster<float>& surface, const Raster<float>& plane_error,
                         double cell);

/// The level of detection is 1.96 times the root of the sum of squares of both height errors, of
/// what both plane errors make of the surfaces, and of the frames'.
HeightChange heightChange(const MapHeights& a, const MapHeights& b, double cell,
                          const FrameError& frames = {});

}  // namespace agricolmap::change
