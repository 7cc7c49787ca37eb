#include "agricolmap/map/soil_ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::map {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kSquare = 0.25;        ///< side of the squares [m]
constexpr float kSoil = 0.2F;           ///< less cover than this is soil
constexpr double kSoilQuantile = 0.35;  ///< of soil: neighbours' leaves lift the rest of it
constexpr double kLowest = 0.03;        ///< of cells that nobody can tell from plants
constexpr double kLeastShare = 0.04;    ///< of a square's cells that must be soil
constexpr float kStep = 0.05F;          ///< a square this far above those around is no ground [m]

struct Squares {
  int step = 1;  ///< cells per square, along each axis
  Raster<float> height;
};

/// The ground that a square shows.
float heightIn(const Raster<float>& surface, const Raster<float>& cover, int row, int col,
               int step) {
  std::vector<float> soil, unknown;
  const int row_end = std::min(surface.rows(), row + step);
  const int col_end = std::min(surface.cols(), col + step);
  for (int r = row; r < row_end; ++r) {
    for (int c = col; c < col_end; ++c) {
      const float z = surface(r, c);
      if (std::isnan(z)) continue;
      if (std::isnan(cover(r, c))) {
        unknown.push_back(z);
      } else if (cover(r, c) < kSoil) {
        soil.push_back(z);
      }
    }
  }
  const auto least = std::max(2.0, kLeastShare * step * step);
  if (static_cast<double>(soil.size()) >= least) return quantile(soil, kSoilQuantile);
  if (static_cast<double>(unknown.size()) >= least) return quantile(unknown, kLowest);
  return kNone;
}

Squares squaresOf(const GridFrame& frame, const Raster<float>& surface,
                  const Raster<float>& cover) {
  Squares squares;
  squares.step = std::max(1, static_cast<int>(std::lround(kSquare / frame.cell)));
  const int rows = (frame.rows + squares.step - 1) / squares.step;
  const int cols = (frame.cols + squares.step - 1) / squares.step;
  squares.height = Raster<float>(rows, cols, kNone);
  parallelFor(static_cast<std::size_t>(rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < cols; ++c) {
      squares.height(r, c) =
          heightIn(surface, cover, r * squares.step, c * squares.step, squares.step);
    }
  });
  return squares;
}

/// Without squares far above the median of those within `reach` squares.
Raster<float> withoutHigh(const Raster<float>& heights, int reach) {
  Raster<float> out = heights;
  std::vector<float> around;
  for (int row = 0; row < heights.rows(); ++row) {
    for (int col = 0; col < heights.cols(); ++col) {
      if (std::isnan(heights(row, col))) continue;
      around.clear();
      for (int r = std::max(0, row - reach); r <= std::min(heights.rows() - 1, row + reach); ++r) {
        for (int c = std::max(0, col - reach); c <= std::min(heights.cols() - 1, col + reach);
             ++c) {
          if (!std::isnan(heights(r, c))) around.push_back(heights(r, c));
        }
      }
      if (heights(row, col) > median(around) + kStep) out(row, col) = kNone;
    }
  }
  return out;
}

/// Fills what is empty with means of what lies around, from coarser and coarser squares, as far as
/// `levels` doublings reach.
Raster<float> filled(const Raster<float>& heights, int levels) {
  if (levels == 0 || heights.rows() < 2 || heights.cols() < 2) return heights;
  Raster<float> half((heights.rows() + 1) / 2, (heights.cols() + 1) / 2, kNone);
  for (int row = 0; row < half.rows(); ++row) {
    for (int col = 0; col < half.cols(); ++col) {
      float sum = 0.0F;
      int count = 0;
      for (int r = 2 * row; r < std::min(heights.rows(), 2 * row + 2); ++r) {
        for (int c = 2 * col; c < std::min(heights.cols(), 2 * col + 2); ++c) {
          if (std::isnan(heights(r, c))) continue;
          sum += heights(r, c);
          ++count;
        }
      }
      if (count > 0) half(row, col) = sum / static_cast<float>(count);
    }
  }
  half = filled(half, levels - 1);
  Raster<float> out = heights;
  for (int row = 0; row < out.rows(); ++row) {
    for (int col = 0; col < out.cols(); ++col) {
      if (!std::isnan(out(row, col))) continue;
      const auto around =
          cellsClamped<float>(half.rows(), half.cols(), (col - 0.5) / 2.0, (row - 0.5) / 2.0);
      const float mean = around.mean([&](int r, int c) { return half(r, c); });
      out(row, col) = std::isnan(mean) ? half(row / 2, col / 2) : mean;
    }
  }
  return out;
}

}  // namespace

Raster<float> soilGround(const GridFrame& frame, const Raster<float>& surface,
                         const Raster<float>& cover) {
  constexpr int kAround = 3;
  const Squares squares = squaresOf(frame, surface, cover);
  const double side = squares.step * frame.cell;
  const int levels = std::max(1, static_cast<int>(std::lround(std::log2(kSoilReach / side))));
  const Raster<float> ground = filled(withoutHigh(squares.height, kAround), levels);
  Raster<float> out(frame.rows, frame.cols, kNone);
  parallelFor(static_cast<std::size_t>(frame.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    const double v = (r + 0.5) / squares.step - 0.5;
    for (int c = 0; c < frame.cols; ++c) {
      const auto around =
          cellsClamped<float>(ground.rows(), ground.cols(), (c + 0.5) / squares.step - 0.5, v);
      const float mean = around.mean([&](int i, int k) { return ground(i, k); });
      out(r, c) = std::isnan(mean) ? ground(r / squares.step, c / squares.step) : mean;
    }
  });
  return out;
}

}  // namespace agricolmap::map
