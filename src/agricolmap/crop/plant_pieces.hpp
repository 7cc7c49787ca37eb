// The hills of a row's curve: what plants are put together from.
#pragma once

#include <vector>

#include "agricolmap/crop/row_profile.hpp"

namespace agricolmap::crop {

/// A hill between two valleys: a plant, a leaf of one, several in one, or a weed.
struct Piece {
  double from = 0.0;  ///< its valleys, along the row [m]
  double to = 0.0;
  double top = 0.0;     ///< along the row [m]
  double height = 0.0;  ///< of the top, in the sharpened curve [m]
  double area = 0.0;    ///< green [m²]
  double middle = 0.0;  ///< of what is green, along the row [m]
  double aside = 0.0;   ///< and to the left of it [m]
  double length = 0.0;  ///< of what is green [m]
  double parted = 1.0;  ///< how deep the valley to the next piece is, of the lower top
};

/// All hills of a curve that stand out of the soil's noise, more of them than there are plants.
/// Plants stand about `distance` apart, a usual one is a top of height `usual` (usualTop).
std::vector<Piece> piecesOf(const RowProfile& profile, double distance, double usual);

/// Median height of the tops of all rows' curves, smoothed for this distance of plants [m].
double usualTop(const std::vector<RowProfile>& rows, double distance);

}  // namespace agricolmap::crop
