#include "agricolmap/crop/fine_strips.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace agricolmap::crop {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kMostCells = 40e6;

/// The mean of the cells within `side` of `point`; one cell where that is no more.
float valueAt(const GridFrame& frame, const Raster<float>& values, const Eigen::Vector2d& point,
              double side) {
  const Eigen::Vector2d at = frame.cellOf(point);
  const int reach = static_cast<int>((0.5 * side / frame.cell) + 1e-6);
  const auto col = static_cast<int>(std::lround(at.x()));
  const auto row = static_cast<int>(std::lround(at.y()));
  float sum = 0.0F;
  float count = 0.0F;
  for (int r = row - reach; r <= row + reach; ++r) {
    for (int c = col - reach; c <= col + reach; ++c) {
      if (!values.contains(r, c) || !std::isfinite(values(r, c))) continue;
      sum += values(r, c);
      count += 1.0F;
    }
  }
  return count > 0.0F ? sum / count : kNone;
}

/// Each cell cut into `finer` × `finer` of the same value.
Raster<float> cut(const Raster<float>& coarse, int finer) {
  Raster<float> fine(coarse.rows() * finer, coarse.cols() * finer);
  for (int r = 0; r < fine.rows(); ++r) {
    for (int c = 0; c < fine.cols(); ++c) fine(r, c) = coarse(r / finer, c / finer);
  }
  return fine;
}

/// Puts a strip's values in place of the map's, where it has any.
void paint(const GridFrame& from, const Raster<float>& values, const GridFrame& frame,
           Raster<float>& into) {
  const Eigen::Vector2d low = frame.cellOf(from.corner);
  const Eigen::Vector2d high =
      frame.cellOf(from.corner + from.cell * Eigen::Vector2d(from.cols, from.rows));
  const int row_end = std::min(frame.rows, static_cast<int>(std::ceil(high.y())) + 1);
  const int col_end = std::min(frame.cols, static_cast<int>(std::ceil(high.x())) + 1);
  for (int r = std::max(0, static_cast<int>(std::floor(low.y()))); r < row_end; ++r) {
    for (int c = std::max(0, static_cast<int>(std::floor(low.x()))); c < col_end; ++c) {
      const float value = valueAt(from, values, frame.centre(r, c), frame.cell - from.cell);
      if (std::isfinite(value)) into(r, c) = value;
    }
  }
}

}  // namespace

void refine(FieldLayers& layers, const std::vector<FineStrip>& strips) {
  if (strips.empty()) return;
  const double most = std::sqrt(kMostCells / static_cast<double>(layers.exg.size()));
  const double ratio = std::round(layers.frame.cell / strips.front().frame.cell);
  const int finer = static_cast<int>(std::clamp(std::floor(most), 1.0, std::max(1.0, ratio)));
  layers.frame.cell /= finer;
  layers.frame.rows *= finer;
  layers.frame.cols *= finer;
  layers.exg = cut(layers.exg, finer);
  if (!layers.height.empty()) layers.height = cut(layers.height, finer);
  for (const FineStrip& strip : strips) {
    paint(strip.frame, strip.exg, layers.frame, layers.exg);
    if (!layers.height.empty()) paint(strip.frame, strip.height, layers.frame, layers.height);
  }
}

}  // namespace agricolmap::crop
