#include "agricolmap/report/map_layer.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap {
namespace {

constexpr int kSmallest = 192;           // no level below this many cells along the longer side
constexpr std::size_t kSamples = 40000;  // enough for percentiles

}  // namespace

MapLayer::MapLayer(const GridMap& map, PictureValue value)
    : map_(map), value_(value == PictureValue::kExg ? map.exg : map.height) {
  LayerLevel finest{map.frame, value_.data(), map.weight.data()};
  while (std::max(finest.frame.rows, finest.frame.cols) >= 2 * kSmallest) {
    coarse_.push_back(halved(finest));
    const Coarse& last = coarse_.back();
    finest = {last.frame, last.value.data(), last.weight.data()};
  }
  const std::size_t step = 1 + map.weight.size() / kSamples;
  for (std::size_t i = 0; i < map.weight.size(); i += step) {
    if (map.valid(i)) sorted_.push_back(value_[i]);
  }
  std::sort(sorted_.begin(), sorted_.end());
}

MapLayer::Coarse MapLayer::halved(const LayerLevel& fine) {
  Coarse out;
  const int rows = (fine.frame.rows + 1) / 2;
  const int cols = (fine.frame.cols + 1) / 2;
  out.frame = {fine.frame.corner, 2.0 * fine.frame.cell, rows, cols};
  out.value = Raster<float>(rows, cols);
  out.weight = Raster<float>(rows, cols);
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t row) {
        const int r = static_cast<int>(row);
        for (int c = 0; c < cols; ++c) {
          float sum = 0.0F;
          float count = 0.0F;
          for (int dr = 2 * r; dr < std::min(2 * r + 2, fine.frame.rows); ++dr) {
            for (int dc = 2 * c; dc < std::min(2 * c + 2, fine.frame.cols); ++dc) {
              const std::size_t i = static_cast<std::size_t>(dr) * fine.frame.cols + dc;
              if (fine.weight[i] <= 0.0F) continue;
              sum += fine.value[i];
              count += 1.0F;
            }
          }
          if (count <= 0.0F) continue;
          out.value(r, c) = sum / count;
          out.weight(r, c) = 0.25F * count;
        }
      },
      16);
  return out;
}

LayerLevel MapLayer::level(double pixel) const {
  LayerLevel best{map_.frame, value_.data(), map_.weight.data()};
  for (const Coarse& coarse : coarse_) {
    if (coarse.frame.cell > pixel) break;
    best = {coarse.frame, coarse.value.data(), coarse.weight.data()};
  }
  return best;
}

double MapLayer::quantile(double share) const {
  if (sorted_.empty()) return 0.0;
  const double rank = share * static_cast<double>(sorted_.size() - 1);
  return static_cast<double>(sorted_[static_cast<std::size_t>(rank)]);
}

LayerRow::LayerRow(const LayerLevel& level, const Eigen::Affine2d& level_from_ground,
                   const View& view)
    : level_(level),
      left_(view.rect.x),
      seen_(static_cast<std::size_t>(view.rect.width)),
      value_(static_cast<std::size_t>(view.rect.width)) {
  const auto cellAt = [&](double x, double y) {
    return level.frame.cellOf(level_from_ground * view.ground({x, y}));
  };
  const Eigen::Vector2d zero = cellAt(0.0, 0.0);
  cell_from_pixel_.linear().col(0) = cellAt(1.0, 0.0) - zero;
  cell_from_pixel_.linear().col(1) = cellAt(0.0, 1.0) - zero;
  cell_from_pixel_.translation() = zero;
  cell_from_pixel_.makeAffine();
}

void LayerRow::sample(int y) {
  const Eigen::Vector2f start =
      (cell_from_pixel_ * Eigen::Vector2d(left_ + 0.5, y + 0.5)).cast<float>();
  const Eigen::Vector2f step = cell_from_pixel_.linear().col(0).cast<float>();
  const int cols = level_.frame.cols;
  const auto last_col = static_cast<float>(cols - 1);
  const auto last_row = static_cast<float>(level_.frame.rows - 1);
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const float u = start.x() + static_cast<float>(i) * step.x();
    const float v = start.y() + static_cast<float>(i) * step.y();
    seen_[i] = value_[i] = 0.0F;
    if (!(u >= 0.0F && v >= 0.0F && u < last_col && v < last_row)) continue;
    const int col = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const float a = u - static_cast<float>(col);
    const float b = v - static_cast<float>(row);
    const std::size_t at = static_cast<std::size_t>(row) * cols + col;
    const std::size_t up = at + static_cast<std::size_t>(cols);
    const float w00 = level_.weight[at] > 0.0F ? (1.0F - a) * (1.0F - b) : 0.0F;
    const float w01 = level_.weight[at + 1] > 0.0F ? a * (1.0F - b) : 0.0F;
    const float w10 = level_.weight[up] > 0.0F ? (1.0F - a) * b : 0.0F;
    const float w11 = level_.weight[up + 1] > 0.0F ? a * b : 0.0F;
    const float sum = w00 + w01 + w10 + w11;
    if (sum <= 0.0F) continue;
    seen_[i] = sum;
    value_[i] = (w00 * level_.value[at] + w01 * level_.value[at + 1] + w10 * level_.value[up] +
                 w11 * level_.value[up + 1]) /
                sum;
  }
}

}  // namespace agricolmap
