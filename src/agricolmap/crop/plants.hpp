// Plants along rows, where they can be told apart, and the gaps between them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/crop/row_profile.hpp"

namespace agricolmap::crop {

struct CropPlant {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< middle of what is green [m]
  double along = 0.0;                               ///< of the row [m]
  double area = 0.0;                                ///< green [m²]
  double height = 0.0;     ///< of its highest tenth above the ground [m]; NaN where not known
  double certainty = 1.0;  ///< that it is one plant, and no less than one
};

/// A piece of a row.
struct Stretch {
  double from = 0.0;  ///< along the row [m]
  double to = 0.0;
  double length() const { return to - from; }
};

struct RowPlants {
  std::vector<CropPlant> plants;  ///< in order along the row
  std::vector<Stretch> touching;  ///< where plants cannot be told apart
  std::vector<Stretch> gaps;      ///< from stem to stem, of 1.5 spacings and more
  double unseen = 0.0;            ///< plants' worth of what may hide among what was left out
};

/// Finds the plants of a row that stand about `distance` apart. `usual`: the height of the curve at
/// a usual plant, as usualTop gives it.
RowPlants findPlants(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                     const RowProfile& profile, double half, double distance, double usual);

/// Median height of the tops of all rows' curves, smoothed for this distance of plants [m].
double usualTop(const std::vector<RowProfile>& rows, double distance);

inline constexpr double kGapSpacings = 1.5;

}  // namespace agricolmap::crop
