// What grows along a row, as a curve.
#pragma once

#include <vector>

#include "agricolmap/crop/row_line.hpp"
#include "agricolmap/crop/view.hpp"

namespace agricolmap::crop {

/// Greenness summed across a row, along it.
struct RowProfile {
  double step = 0.0;          ///< of the samples, the first in the middle of the first step [m]
  double length = 0.0;        ///< of the row [m]
  std::vector<double> green;  ///< width that is green [m]; 0 where nothing is known
  std::vector<double> known;  ///< share of the width that the map shows
  std::vector<double> leafy;  ///< of `green`, what is clearly so [m] …
  std::vector<double> lean;   ///< … times how far to the left of the line it is [m²]
  double noise = 0.0;         ///< deviation of `green` over what is no row [m]

  int size() const { return static_cast<int>(green.size()); }
  double along(int i) const { return (i + 0.5) * step; }
  int indexAt(double s) const;
};

/// Of the cells within `half` of the line; the noise is that of the ground between this row and
/// the next, `spacing` away.
RowProfile profileOf(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                     double half, double spacing);

/// A copy with `green` under a Gaussian of this deviation [m]; the noise is the smoothed curve's.
RowProfile smoothed(const RowProfile& profile, double sigma);

/// How far apart plants stand along the rows, and how clearly the rows say so.
struct PlantSpacing {
  double distance = 0.0;  ///< [m]; 0: none found
  /// Of the curves' correlation with themselves: by how much it rises again to this distance, over
  /// its value at 0.
  double clearness = 0.0;
};

/// From the curves of all rows. None where plants do not stand apart in a rhythm: what is drilled
/// close, or has closed.
PlantSpacing plantSpacing(const std::vector<RowProfile>& rows);

}  // namespace agricolmap::crop
