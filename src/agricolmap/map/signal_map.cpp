#include "agricolmap/map/signal_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "agricolmap/core/parallel.hpp"
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

/// Means over (2·radius + 1) cells along rows, and along columns by being called on the transpose.
void boxSumRows(const Raster<float>& in, int radius, Raster<float>& out) {
  parallelFor(static_cast<std::size_t>(in.rows()), [&](std::size_t r) {
    const float* source = in.row(static_cast<int>(r));
    float* target = out.row(static_cast<int>(r));
    const int cols = in.cols();
    double sum = 0.0;
    for (int c = 0; c < std::min(radius, cols); ++c) sum += static_cast<double>(source[c]);
    for (int c = 0; c < cols; ++c) {
      if (c + radius < cols) sum += static_cast<double>(source[c + radius]);
      if (c - radius - 1 >= 0) sum -= static_cast<double>(source[c - radius - 1]);
      target[c] = static_cast<float>(sum);
    }
  });
}

void boxSumCols(const Raster<float>& in, int radius, Raster<float>& out) {
  constexpr int kStripe = 64;
  const int cols = in.cols();
  const int rows = in.rows();
  const auto stripes = static_cast<std::size_t>((cols + kStripe - 1) / kStripe);
  parallelFor(stripes, [&](std::size_t stripe) {
    const int first = static_cast<int>(stripe) * kStripe;
    const int count = std::min(kStripe, cols - first);
    double sum[kStripe] = {};
    const auto add = [&](int row, double sign) {
      const float* source = in.row(row) + first;
      for (int c = 0; c < count; ++c) sum[c] += sign * static_cast<double>(source[c]);
    };
    for (int r = 0; r < std::min(radius, rows); ++r) add(r, 1.0);
    for (int r = 0; r < rows; ++r) {
      if (r + radius < rows) add(r + radius, 1.0);
      if (r - radius - 1 >= 0) add(r - radius - 1, -1.0);
      float* target = out.row(r) + first;
      for (int c = 0; c < count; ++c) target[c] = static_cast<float>(sum[c]);
    }
  });
}

Raster<float> boxSum(const Raster<float>& in, int radius) {
  Raster<float> rows(in.rows(), in.cols());
  Raster<float> both(in.rows(), in.cols());
  boxSumRows(in, radius, rows);
  boxSumCols(rows, radius, both);
  return both;
}

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
double highPass(Raster<float>& value, const Raster<float>& weight, int radius, double clip) {
  // Two boxes make a smooth low-pass without the side lobes of one.
  Raster<float> low = weightedBoxMean(value, weight, radius);
  low = weightedBoxMean(low, weight, radius);
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

Raster<float> weightedBoxMean(const Raster<float>& value, const Raster<float>& weight, int radius) {
  Raster<float> product(value.rows(), value.cols());
  for (std::size_t i = 0; i < value.size(); ++i) product[i] = value[i] * weight[i];
  Raster<float> sum = boxSum(product, radius);
  const Raster<float> norm = boxSum(weight, radius);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = norm[i] > 1e-3F ? sum[i] / norm[i] : 0.0F;
  }
  return sum;
}

SignalMap makeSignalMap(const GridMap& map, int factor, const SignalOptions& options) {
  Coarse coarse = averageCells(map, factor, options.term);
  SignalMap signal;
  signal.frame = coarse.frame;
  signal.weight = std::move(coarse.weight);
  const int radius =
      std::max(1, static_cast<int>(std::lround(0.5 * options.high_pass / signal.frame.cell)));
  for (int k = 0; k < kSignalChannels; ++k) {
    signal.channel[k] = std::move(coarse.channel[k]);
    if (uses(options.term, k)) {
      signal.deviation[k] = highPass(signal.channel[k], signal.weight, radius, options.clip);
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
