// Pairs of two flights over one real field: strips of one date on the map of another.
#pragma once

#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/simulate/geotag.hpp"

namespace agricolmap::experiments {

/// Two dates of the soybean trial and the part of it that strips come from, so that what a method
/// is improved on is not what is reported.
struct DatePair {
  std::string fixed;         ///< day of August 2018
  std::string moving;        ///< likewise
  double begin = 0.0;        ///< of the part, share of the field's length from its west end
  double end = 1.0;          ///< likewise
  bool end_for_end = false;  ///< of mirrored strips: first and last are swapped, not left and right
};

/// The day's mosaic, below the folder of shared data.
std::string dateFile(const std::string& day);

/// An orthomosaic without heights as a cloud: one point a valid pixel, z = 0.
Cloud layFlat(const io::RasterImage& image);

/// A strip of a flight in a file of its own.
struct FlatStrip {
  Cloud cloud;
  simulate::Geotag geotag;  ///< strip's file → the mosaic's coordinates
};

/// Cuts the strip of this seed out of a mosaic: at a random place of the part, along its plots or
/// up to 3 degrees askew, in the size and with the error of the guess that the options say,
/// mirrored if they say so. Pixels are not resampled. Throws InputError when no place has data.
FlatStrip cutStrip(const io::RasterImage& image, const DatePair& dates,
                   const simulate::SimulationOptions& options);

}  // namespace agricolmap::experiments
