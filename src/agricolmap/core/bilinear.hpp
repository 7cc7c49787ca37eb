// Reading a raster between its cells' centres.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace agricolmap {

/// The four cells whose centres lie around a place, and where between them it lies. Places are
/// continuous columns and rows, 0 at the centre of the first cell, as GridFrame::cellOf gives them.
template <typename Real>
struct CellsAround {
  int row = 0;  ///< of the lower two
  int col = 0;  ///< of the left two
  Real u = 0;   ///< share of the right two, 0…1
  Real v = 0;   ///< share of the upper two, 0…1
  int up = 1;   ///< from the lower row to the upper one; 0 in a raster of one row
  int right = 1;

  /// Shares of the lower left, lower right, upper left and upper right cell; their sum is 1.
  std::array<Real, 4> shares() const {
    return {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  }
  /// Bilinear mean of the cells' values, `value(row, col)`.
  template <typename Value>
  Real mean(const Value& value) const {
    const Real low = value(row, col) * (1 - u) + value(row, col + right) * u;
    const Real high = value(row + up, col) * (1 - u) + value(row + up, col + right) * u;
    return low * (1 - v) + high * v;
  }
};

/// Around any place; the cells need not exist.
template <typename Real, typename Place>
CellsAround<Real> cellsAround(Place col, Place row) {
  const Place left = std::floor(col), low = std::floor(row);
  return {static_cast<int>(low), static_cast<int>(left), static_cast<Real>(col - left),
          static_cast<Real>(row - low)};
}

/// Nothing unless all four cells exist and the place is not NaN.
template <typename Real, typename Place>
std::optional<CellsAround<Real>> cellsWithin(int rows, int cols, Place col, Place row) {
  // What lies before the last centre has a cell to its right.
  if (!(col >= 0 && row >= 0 && col < static_cast<Place>(cols - 1) &&
        row < static_cast<Place>(rows - 1))) {
    return std::nullopt;
  }
  // As cellsAround: nothing is negative here, and to cut off costs less than to round down.
  const int left = static_cast<int>(col), low = static_cast<int>(row);
  return CellsAround<Real>{low, left, static_cast<Real>(col - static_cast<Place>(left)),
                           static_cast<Real>(row - static_cast<Place>(low))};
}

/// Beyond the outer centres it is read as at the nearest place between them.
template <typename Real, typename Place>
CellsAround<Real> cellsClamped(int rows, int cols, Place col, Place row) {
  const Place c = std::clamp(col, Place{0}, static_cast<Place>(cols - 1));
  const Place r = std::clamp(row, Place{0}, static_cast<Place>(rows - 1));
  const int left = std::min(static_cast<int>(c), std::max(0, cols - 2));
  const int low = std::min(static_cast<int>(r), std::max(0, rows - 2));
  return {low,
          left,
          static_cast<Real>(c - static_cast<Place>(left)),
          static_cast<Real>(r - static_cast<Place>(low)),
          std::min(1, rows - 1),
          std::min(1, cols - 1)};
}

}  // namespace agricolmap
