#include "agricolmap/report/draw/map_layer.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::report {
namespace {

constexpr int kSmallest = 192;           // no level below this many cells along the longer side
constexpr std::size_t kFillLevels = 2;   // coarser levels that gaps are filled from
constexpr float kFillShare = 0.2F;       // least known share of the coarsest of them
constexpr std::size_t kSamples = 10000;  // enough for percentiles
constexpr std::size_t kRowsAtOnce = 32;

template <typename Body>
void forRows(const LayerLevel& level, const Body& body) {
  parallelFor(
      static_cast<std::size_t>(level.frame.rows), [&](std::size_t r) { body(static_cast<int>(r)); },
      kRowsAtOnce);
}

LayerLevel finestLevel(const map::GridMap& map, const Raster<float>& value) {
  LayerLevel level{map.frame, Raster<LayerCell>(map.frame.rows, map.frame.cols)};
  forRows(level, [&](int r) {
    const float* weights = map.weight.row(r);
    const float* values = value.row(r);
    LayerCell* cells = level.cells.row(r);
    for (int c = 0; c < map.frame.cols; ++c) {
      if (weights[c] > 0.0F) cells[c] = {values[c], 1.0F};
    }
  });
  return level;
}

/// Cells twice as large; `known` is the share of the area that is known.
LayerLevel halved(const LayerLevel& fine) {
  const int rows = (fine.frame.rows + 1) / 2;
  const int cols = (fine.frame.cols + 1) / 2;
  LayerLevel level{{fine.frame.corner, 2.0 * fine.frame.cell, rows, cols},
                   Raster<LayerCell>(rows, cols)};
  forRows(level, [&](int r) {
    LayerCell* out = level.cells.row(r);
    for (int dr = 2 * r; dr < std::min(2 * r + 2, fine.frame.rows); ++dr) {
      const LayerCell* in = fine.cells.row(dr);
      for (int c = 0; c < fine.frame.cols; ++c) {
        out[c / 2].weighted += 0.25F * in[c].weighted;
        out[c / 2].known += 0.25F * in[c].known;
      }
    }
  });
  return level;
}

/// Makes cells of which anything is known fully known and fills the others from the coarser levels,
/// which must still be as `halved` made them.
void fillGaps(std::vector<LayerLevel>& levels, std::size_t index) {
  LayerLevel& level = levels[index];
  forRows(level, [&](int r) {
    LayerCell* cells = level.cells.row(r);
    for (int c = 0; c < level.frame.cols; ++c) {
      if (cells[c].known == 1.0F) continue;
      const LayerCell* from = &cells[c];
      for (std::size_t up = 1; up <= kFillLevels && from->known <= 0.0F; ++up) {
        if (index + up >= levels.size()) break;
        const LayerCell& parent = levels[index + up].cells(r >> up, c >> up);
        if (up < kFillLevels || parent.known >= kFillShare) from = &parent;
      }
      if (from->known > 0.0F) cells[c] = {from->weighted / from->known, 1.0F};
    }
  });
}

}  // namespace

MapLayer::MapLayer(const map::GridMap& map, PictureValue value) : map_(map) {
  const Raster<float>& values = value == PictureValue::kExg ? map.exg : map.height;
  levels_.push_back(finestLevel(map, values));
  while (std::max(levels_.back().frame.rows, levels_.back().frame.cols) >= 2 * kSmallest ||
         levels_.size() <= kFillLevels) {
    levels_.push_back(halved(levels_.back()));
  }
  for (std::size_t i = 0; i < levels_.size(); ++i) fillGaps(levels_, i);
  const std::size_t step = 1 + map.weight.size() / kSamples;
  for (std::size_t i = 0; i < map.weight.size(); i += step) {
    if (map.valid(i)) sorted_.push_back(values[i]);
  }
  std::sort(sorted_.begin(), sorted_.end());
}

const LayerLevel& MapLayer::level(double pixel) const {
  const LayerLevel* best = &levels_.front();
  for (const LayerLevel& level : levels_) {
    if (level.frame.cell <= pixel) best = &level;
  }
  return *best;
}

double MapLayer::quantile(double share) const {
  if (sorted_.empty()) return 0.0;
  const double rank = share * static_cast<double>(sorted_.size() - 1);
  return static_cast<double>(sorted_[static_cast<std::size_t>(rank)]);
}

LayerRow::LayerRow(const MapLayer& layer, const Eigen::Affine2d& layer_from_ground,
                   const View& view)
    : level_(layer.level(1.0 / view.scale)),
      left_(view.rect.x),
      seen_(static_cast<std::size_t>(view.rect.width)),
      value_(static_cast<std::size_t>(view.rect.width)) {
  const auto cellAt = [&](double x, double y) {
    return level_.frame.cellOf(layer_from_ground * view.ground({x, y}));
  };
  const Eigen::Vector2d zero = cellAt(0.0, 0.0);
  cell_from_pixel_ = Eigen::Affine2d::Identity();
  cell_from_pixel_.linear().col(0) = cellAt(1.0, 0.0) - zero;
  cell_from_pixel_.linear().col(1) = cellAt(0.0, 1.0) - zero;
  cell_from_pixel_.translation() = zero;
}

std::pair<int, int> LayerRow::inside(const Eigen::Vector2f& start,
                                     const Eigen::Vector2f& step) const {
  // More than what the compiler may round differently here and in `sample`.
  constexpr float kMargin = 0.01F;
  int begin = 0;
  int end = static_cast<int>(seen_.size());
  const Eigen::Vector2f last(static_cast<float>(level_.frame.cols - 1),
                             static_cast<float>(level_.frame.rows - 1));
  const auto isInside = [&](int i) {
    const Eigen::Vector2f at = start + static_cast<float>(i) * step;
    return (at.array() >= kMargin).all() && (at.array() <= last.array() - kMargin).all();
  };
  for (int k = 0; k < 2; ++k) {
    if (std::abs(step(k)) < 1e-9F) continue;  // along the border: decided below
    const float at_zero = -start(k) / step(k);
    const float at_last = (last(k) - start(k)) / step(k);
    const float limit = 1e6F;
    begin = std::max(begin, static_cast<int>(std::clamp(std::min(at_zero, at_last), 0.0F, limit)));
    end = std::min(end, static_cast<int>(std::clamp(std::max(at_zero, at_last), -2.0F, limit)) + 2);
  }
  while (begin < end && !isInside(begin)) ++begin;
  while (begin < end && !isInside(end - 1)) --end;
  return {begin, end};
}

void LayerRow::sample(int y) {
  std::fill(seen_.begin(), seen_.end(), 0.0F);
  std::fill(value_.begin(), value_.end(), 0.0F);
  const Eigen::Vector2f start =
      (cell_from_pixel_ * Eigen::Vector2d(left_ + 0.5, y + 0.5)).cast<float>();
  const Eigen::Vector2f step = cell_from_pixel_.linear().col(0).cast<float>();
  const auto [begin, end] = inside(start, step);
  const LayerCell* cells = level_.cells.data();
  const int cols = level_.frame.cols;
  // Not core/bilinear.hpp, with which a row of pixels takes a third longer.
  for (int i = begin; i < end; ++i) {
    const float u = start.x() + static_cast<float>(i) * step.x();
    const float v = start.y() + static_cast<float>(i) * step.y();
    const int col = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const float a = u - static_cast<float>(col);
    const float b = v - static_cast<float>(row);
    const LayerCell* low = cells + (static_cast<std::ptrdiff_t>(row) * cols + col);
    const LayerCell* up = low + cols;
    const auto mix = [&](float ll, float lr, float ul, float ur) {
      const float lower = ll + a * (lr - ll);
      const float upper = ul + a * (ur - ul);
      return lower + b * (upper - lower);
    };
    const float known = mix(low[0].known, low[1].known, up[0].known, up[1].known);
    const float weighted = mix(low[0].weighted, low[1].weighted, up[0].weighted, up[1].weighted);
    seen_[static_cast<std::size_t>(i)] = known;
    value_[static_cast<std::size_t>(i)] = weighted / std::max(known, 1e-6F);
  }
}

}  // namespace agricolmap::report
