#include "agricolmap/change/height_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::change {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
/// Cells: no step is taken farther than this, however large the plane error.
constexpr int kFarthest = 256;

/// Mean square of the steps from a cell to the known ones of the four cells `lag` away.
double meanSquareStep(const Raster<float>& surface, int row, int col, int lag) {
  const float here = surface(row, col);
  double sum = 0.0;
  int count = 0;
  const std::array<std::array<int, 2>, 4> others = {
      {{row - lag, col}, {row + lag, col}, {row, col - lag}, {row, col + lag}}};
  for (const auto& [r, c] : others) {
    if (!surface.contains(r, c) || std::isnan(surface(r, c))) continue;
    const auto step = static_cast<double>(surface(r, c) - here);
    sum += step * step;
    ++count;
  }
  return count > 0 ? sum / count : static_cast<double>(kNone);
}

/// Adds the square of `extra` to each error.
Raster<float> widened(const Raster<float>& error, double extra) {
  if (extra == 0.0) return error;
  Raster<float> wide = error;
  for (float& value : wide) value = std::hypot(value, static_cast<float>(extra));
  return wide;
}

}  // namespace

Raster<float> slopeError(const Raster<float>& surface, const Raster<float>& plane_error,
                         double cell) {
  Raster<float> error(surface.rows(), surface.cols(), kNone);
  parallelFor(static_cast<std::size_t>(surface.rows()), [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int col = 0; col < surface.cols(); ++col) {
      const auto plane = static_cast<double>(plane_error(row, col));
      if (std::isnan(surface(row, col)) || std::isnan(plane)) continue;
      const int lag = static_cast<int>(std::clamp(std::round(plane / cell), 1.0, 1.0 * kFarthest));
      double square = plane > 0.0 ? meanSquareStep(surface, row, col, lag) : 0.0;
      // Where the field ends before the step does, what the next cells say is the best there is.
      if (std::isnan(square)) square = meanSquareStep(surface, row, col, 1);
      error(row, col) = static_cast<float>(std::sqrt(square) * plane / (lag * cell));
    }
  });
  return error;
}

HeightChange heightChange(const MapHeights& a, const MapHeights& b, double cell,
                          const FrameError& frames) {
  const int rows = a.surface.rows();
  const int cols = a.surface.cols();
  const Raster<float> slope_a = slopeError(a.surface, a.plane_error, cell);
  const Raster<float> slope_b = slopeError(b.surface, widened(b.plane_error, frames.plane), cell);
  HeightChange result{Raster<float>(rows, cols, kNone), Raster<float>(rows, cols, kNone),
                      Raster<float>(rows, cols, kNone)};
  parallelFor(static_cast<std::size_t>(rows), [&](std::size_t r) {
    const std::size_t begin = a.surface.index(static_cast<int>(r), 0);
    for (std::size_t i = begin; i < begin + static_cast<std::size_t>(cols); ++i) {
      const auto change = static_cast<double>(b.surface[i]) - static_cast<double>(a.surface[i]);
      double square = frames.height * frames.height;
      for (const float error : {a.height_error[i], b.height_error[i], slope_a[i], slope_b[i]}) {
        square += static_cast<double>(error) * static_cast<double>(error);
      }
      if (std::isnan(change) || std::isnan(square)) continue;
      const double detection = kLevel95 * std::sqrt(square);
      result.change[i] = static_cast<float>(change);
      result.detection[i] = static_cast<float>(detection);
      result.significant[i] = std::abs(change) > detection ? 1.0F : 0.0F;
    }
  });
  return result;
}

}  // namespace agricolmap::change
