// Which cells belong to rows, and what grows between them.
#pragma once

#include <cstdint>
#include <vector>

#include "agricolmap/crop/field_rows.hpp"

namespace agricolmap::crop {

enum class Band : std::uint8_t {
  kOutside,  ///< farther from any row than the middle between two
  kBetween,  ///< between rows
  kRow,      ///< within FieldRows::half_width of a row
  kCore,     ///< about its line: what reaches here is of the crop
};

/// A row of each cell and how far it is from it.
struct RowBands {
  Raster<Band> band;
  Raster<std::int32_t> row;  ///< index of the nearest row; −1 outside
};
RowBands rowBands(const GridFrame& frame, const FieldRows& field);

/// Green that reaches no row: weeds between the rows.
struct WeedPatch {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< its middle [m]
  double area = 0.0;                                ///< [m²]
};
struct Weeds {
  Raster<std::uint8_t> mask;  ///< 1 where weeds are
  std::vector<WeedPatch> patches;
};

/// Patches of leaf, joined over edges and corners, that touch no row's core and have their middle
/// between rows. Smaller than kLeastPatchCells cells is noise. Weeds within the rows, and those
/// that touch the crop, are not told from it.
Weeds findWeeds(const GridFrame& frame, const Greenness& greenness, const RowBands& bands);

inline constexpr std::size_t kLeastPatchCells = 4;

}  // namespace agricolmap::crop
