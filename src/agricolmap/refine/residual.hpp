// What the refinements on the maps compare: a moving cell's values with the fixed map's under it,
// robustly, each channel with a gain and a noise of its own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::refine {

/// Share of a cell that must have been seen.
inline constexpr float kMinSeen = 0.25F;
/// Plants are green and high in both maps, however little they have in common; soil may be wet or
/// dry, brighter or darker than leaves.
inline constexpr double kLeastGain[map::kSignalChannels] = {0.2, 0.2, 0.0};

/// Fixed values and their slopes [1/m] at a place.
struct Look {
  bool seen = false;
  float value[map::kSignalChannels];
  float dx[map::kSignalChannels];
  float dy[map::kSignalChannels];
};

/// At a continuous column and row (GridFrame::cellOf).
inline Look lookAt(const map::SignalMap& map, float inv_cell, float col, float row) {
  Look look;
  const auto cells = cellsWithin<float>(map.frame.rows, map.frame.cols, col, row);
  if (!cells) return look;
  const float u = cells->u, v = cells->v;
  const std::size_t i = map.weight.index(cells->row, cells->col);
  const std::size_t j = i + static_cast<std::size_t>(map.frame.cols);
  const Raster<float>& w = map.weight;
  if (std::min({w[i], w[i + 1], w[j], w[j + 1]}) < kMinSeen) return look;
  look.seen = true;
  for (int k = 0; k < map::kSignalChannels; ++k) {
    const Raster<float>& f = map.channel[k];
    const float bottom = f[i + 1] - f[i], top = f[j + 1] - f[j];
    const float left = f[j] - f[i], right = f[j + 1] - f[i + 1];
    look.value[k] = f[i] + u * bottom + v * left + u * v * (top - bottom);
    look.dx[k] = (bottom + v * (top - bottom)) * inv_cell;
    look.dy[k] = (left + u * (right - left)) * inv_cell;
  }
  return look;
}

/// Per channel: gain of the fixed values and robust deviation of the residual.
struct Noise {
  double gain[map::kSignalChannels];
  double deviation[map::kSignalChannels];
  Noise() {
    std::fill(std::begin(gain), std::end(gain), 1.0);
    std::fill(std::begin(deviation), std::end(deviation), 1.0);
  }
};

/// Weighted products of the fixed (f) and moving (m) values and residuals (r), by channel.
struct Products {
  double fm[map::kSignalChannels] = {}, mm[map::kSignalChannels] = {},
         ff[map::kSignalChannels] = {};
  double rr[map::kSignalChannels] = {}, weight[map::kSignalChannels] = {};

  void add(int k, double w, double f, double m, double residual) {
    fm[k] += w * f * m;
    mm[k] += w * m * m;
    ff[k] += w * f * f;
    rr[k] += w * residual * residual;
    weight[k] += w;
  }
  Products& operator+=(const Products& other) {
    for (int k = 0; k < map::kSignalChannels; ++k) {
      fm[k] += other.fm[k];
      mm[k] += other.mm[k];
      ff[k] += other.ff[k];
      rr[k] += other.rr[k];
      weight[k] += other.weight[k];
    }
    return *this;
  }
  /// Gains and deviations that these products tell; what they say nothing of stays.
  void update(Noise& noise) const {
    for (int k = 0; k < map::kSignalChannels; ++k) {
      if (weight[k] <= 0.0 || ff[k] <= 0.0) continue;
      noise.gain[k] = std::max(kLeastGain[k], fm[k] / ff[k]);
      noise.deviation[k] = std::max(0.05, std::sqrt(rr[k] / weight[k]));
    }
  }
};

}  // namespace agricolmap::refine
