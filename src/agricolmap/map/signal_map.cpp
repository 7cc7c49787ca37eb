#include "agricolmap/map/signal_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/map/box_mean.hpp"
#include "agricolmap/map/soil_texture.hpp"

namespace agricolmap::map {

void listOptions(OptionTable& table, SignalOptions& options) {
  table
      .number("high_pass", options.high_pass, 0.05, 100.0, "m",
              "variation slower than this wavelength is taken out before maps are compared")
      .basic();
  table.number("clip", options.clip, 0.5, 100.0, "deviations", "larger values are cut to this");
  table.choice("term", options.term, {"all", "exg_height", "rgb", "exg", "height"},
               "what is compared: Excess Green, height and luminance, or some of them");
}

namespace {

/// Means of `factor × factor` fine cells; frame and weight first, then one value per channel.
struct Coarse {
  GridFrame frame;
  Raster<float> weight;
  Raster<float> channel[kSignalChannels];
};

/// Deviations below these are none: of Excess Green, height [m] and luminance.
constexpr double kFlat[kSignalChannels] = {1e-4, 1e-3, 1e-4};

/// Whether a channel is looked at.
bool uses(SignalTerm term, int channel) {
  switch (term) {
    case SignalTerm::kAll:
      return true;
    case SignalTerm::kExgHeight:
      return channel != kLuminanceChannel;
    case SignalTerm::kRgb:
      return channel == kLuminanceChannel;
    case SignalTerm::kExg:
      return channel == kGreenChannel;
    case SignalTerm::kHeight:
      break;
  }
  return channel == kHeightChannel;
}

Coarse averageCells(const GridMap& map, int factor, SignalTerm term) {
  Coarse coarse;
  coarse.frame = map.frame;
  coarse.frame.cell = map.frame.cell * factor;
  coarse.frame.rows = (map.frame.rows + factor - 1) / factor;
  coarse.frame.cols = (map.frame.cols + factor - 1) / factor;
  const int rows = coarse.frame.rows;
  const int cols = coarse.frame.cols;
  coarse.weight = Raster<float>(rows, cols);
  for (auto& channel : coarse.channel) channel = Raster<float>(rows, cols);
  std::optional<Raster<float>> texture;
  if (map.soil_below && uses(term, kLuminanceChannel)) {
    texture = soilTexture(map, *map.soil_below);
  }
  const float share = 1.0F / static_cast<float>(factor * factor);
  parallelFor(static_cast<std::size_t>(rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int fine_row = r * factor; fine_row < std::min((r + 1) * factor, map.frame.rows);
         ++fine_row) {
      for (int fine_col = 0; fine_col < map.frame.cols; ++fine_col) {
        const std::size_t i = map.weight.index(fine_row, fine_col);
        if (!map.valid(i)) continue;
        const std::size_t j = coarse.weight.index(r, fine_col / factor);
        coarse.weight[j] += 1.0F;
        coarse.channel[kGreenChannel][j] += map.exg[i];
        coarse.channel[kHeightChannel][j] += map.height[i];
        coarse.channel[kLuminanceChannel][j] += texture ? (*texture)[i] : luminance(map.colour[i]);
      }
    }
    for (int c = 0; c < cols; ++c) {
      const std::size_t j = coarse.weight.index(r, c);
      if (coarse.weight[j] <= 0.0F) continue;
      for (auto& channel : coarse.channel) channel[j] /= coarse.weight[j];
      coarse.weight[j] *= share;
    }
  });
  return coarse;
}

/// Subtracts the local mean, divides by the deviation, cuts outliers; returns the deviation.
double highPass(Raster<float>& value, const Raster<float>& weight, const BoxMean& box,
                double clip) {
  // Two boxes make a smooth low-pass without the side lobes of one.
  const Raster<float> low = box.of(box.of(value));
  constexpr std::size_t kChunk = 1U << 15;
  const Eigen::Array3d sums = parallelSum<Eigen::Array3d>(
      value.size(), kChunk, Eigen::Array3d::Zero(), [&](std::size_t begin, std::size_t end) {
        Eigen::Array3d part = Eigen::Array3d::Zero();
        for (std::size_t i = begin; i < end; ++i) {
          value[i] = weight[i] > 0.0F ? value[i] - low[i] : 0.0F;
          const auto v = static_cast<double>(value[i]);
          const auto w = static_cast<double>(weight[i]);
          part += Eigen::Array3d(w, w * v, w * v * v);
        }
        return part;
      });
  if (sums[0] <= 0.0) return 0.0;
  const double mean = sums[1] / sums[0];
  const double deviation = std::sqrt(std::max(0.0, sums[2] / sums[0] - mean * mean));
  const auto scale = static_cast<float>(deviation > 1e-12 ? 1.0 / deviation : 0.0);
  const auto limit = static_cast<float>(clip);
  const auto offset = static_cast<float>(mean);
  parallelFor(
      value.size(),
      [&](std::size_t i) {
        value[i] = weight[i] > 0.0F ? std::clamp((value[i] - offset) * scale, -limit, limit) : 0.0F;
      },
      kChunk);
  return deviation;
}

}  // namespace

SignalMap makeSignalMap(const GridMap& map, int factor, const SignalOptions& options) {
  Coarse coarse = averageCells(map, factor, options.term);
  SignalMap signal;
  signal.frame = coarse.frame;
  signal.weight = std::move(coarse.weight);
  const int radius =
      std::max(1, static_cast<int>(std::lround(0.5 * options.high_pass / signal.frame.cell)));
  const BoxMean box(signal.weight, radius);
  for (int k = 0; k < kSignalChannels; ++k) {
    signal.channel[k] = std::move(coarse.channel[k]);
    if (uses(options.term, k)) {
      signal.deviation[k] = highPass(signal.channel[k], signal.weight, box, options.clip);
    }
    // The rounding of a flat cloud's heights is no relief.
    if (signal.deviation[k] < kFlat[k]) {
      std::fill(signal.channel[k].begin(), signal.channel[k].end(), 0.0F);
      signal.deviation[k] = 0.0;
    }
  }
  return signal;
}

}  // namespace agricolmap::map
