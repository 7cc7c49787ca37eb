#include "agricolmap/correlation/whitening.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::correlation {
namespace {

/// The residual falls by about a factor of two to three in each; the norms are of Whitening::solve.
constexpr int kMostIterations = 12;
constexpr double kEnough = 1e-3;

/// The power of each frequency, averaged over 3 × 3 of them: one map is one sample of its field's
/// spectrum. `raw` is stored rows × cols.
std::vector<float> smoothed(const std::vector<float>& raw, int rows, int cols) {
  std::vector<float> power(raw.size());
  std::vector<float> across(raw.size());
  for (int r = 0; r < rows; ++r) {
    const std::size_t base = static_cast<std::size_t>(r) * cols;
    for (int c = 0; c < cols; ++c) {
      across[base + c] =
          raw[base + (c + cols - 1) % cols] + raw[base + c] + raw[base + (c + 1) % cols];
    }
  }
  for (int r = 0; r < rows; ++r) {
    const std::size_t above = static_cast<std::size_t>((r + rows - 1) % rows) * cols;
    const std::size_t here = static_cast<std::size_t>(r) * cols;
    const std::size_t below = static_cast<std::size_t>((r + 1) % rows) * cols;
    for (int c = 0; c < cols; ++c) {
      power[here + c] = (across[above + c] + across[here + c] + across[below + c]) / 9.0F;
    }
  }
  return power;
}

/// Both channels of a pair as one complex raster, and where they are known.
struct Observed {
  ComplexRaster values;
  std::vector<float> mask;
};

Observed observedOf(const map::SignalMap& fixed, ChannelPair channels, const Fft2& fft) {
  Observed observed{ComplexRaster(fft.size()), std::vector<float>(fft.size(), 0.0F)};
  for (int r = 0; r < fixed.frame.rows; ++r) {
    for (int c = 0; c < fixed.frame.cols; ++c) {
      const std::size_t i = static_cast<std::size_t>(r) * fft.cols() + c;
      const float weight = std::min(1.0F, fixed.weight(r, c));
      observed.values.re[i] = fixed.channel[channels.first](r, c) * weight;
      if (channels.second >= 0) {
        observed.values.im[i] = fixed.channel[channels.second](r, c) * weight;
      }
      observed.mask[i] = weight > 0.0F ? 1.0F : 0.0F;
    }
  }
  return observed;
}

/// Real factors per frequency and channel; each is symmetric, as a real channel's power is.
struct Gains {
  std::vector<float> first;
  std::vector<float> second;
};

/// Multiplies the channels' spectra, packed as first + i · second, by their gains or divides by
/// them. `data` is the spectrum of a rows × cols raster, stored cols × rows.
void scaleChannels(ComplexRaster& data, const Gains& gains, bool divide, int rows, int cols) {
  const auto factor = [&](float gain) { return divide ? 1.0F / gain : gain; };
  for (int c = 0; c <= cols / 2; ++c) {
    const std::size_t here = static_cast<std::size_t>(c) * rows;
    const std::size_t there = static_cast<std::size_t>((cols - c) % cols) * rows;
    const auto scale = [&](std::size_t k, std::size_t m) {
      const float half = 0.5F * (factor(gains.first[k]) + factor(gains.second[k]));
      const float swap = 0.5F * (factor(gains.first[k]) - factor(gains.second[k]));
      const float kr = data.re[k], ki = data.im[k], mr = data.re[m], mi = data.im[m];
      data.re[k] = half * kr + swap * mr;
      data.im[k] = half * ki - swap * mi;
      data.re[m] = half * mr + swap * kr;
      data.im[m] = half * mi - swap * ki;
    };
    const int last = here == there ? rows / 2 : rows - 1;
    for (int r = 0; r <= last; ++r) {
      scale(here + static_cast<std::size_t>(r),
            there + static_cast<std::size_t>((rows - r) % rows));
    }
  }
}

/// mean power / (power + floor · mean power): scaled so that the two channels stay comparable.
std::vector<float> gainsOf(const std::vector<float>& power, double floor) {
  double mean = 0.0;
  for (const float p : power) mean += static_cast<double>(p);
  mean = std::max(mean / static_cast<double>(power.size()), 1e-20);
  std::vector<float> gains(power.size());
  for (std::size_t i = 0; i < gains.size(); ++i) {
    gains[i] = static_cast<float>(mean / (static_cast<double>(power[i]) + floor * mean));
  }
  return gains;
}

/// Power per channel of a packed spectrum, smoothed and turned into gains.
Gains gainsOf(const ComplexRaster& spectrum, const Fft2& fft, double floor) {
  const int rows = fft.rows();
  const int cols = fft.cols();
  Gains power{std::vector<float>(fft.size()), std::vector<float>(fft.size())};
  for (int c = 0; c < cols; ++c) {
    for (int r = 0; r < rows; ++r) {
      const std::size_t k = static_cast<std::size_t>(c) * rows + r;
      const std::size_t m = static_cast<std::size_t>((cols - c) % cols) * rows + (rows - r) % rows;
      const float gr = 0.5F * (spectrum.re[k] + spectrum.re[m]);
      const float gi = 0.5F * (spectrum.im[k] - spectrum.im[m]);
      const float hr = 0.5F * (spectrum.im[k] + spectrum.im[m]);
      const float hi = 0.5F * (spectrum.re[m] - spectrum.re[k]);
      power.first[k] = gr * gr + gi * gi;
      power.second[k] = hr * hr + hi * hi;
    }
  }
  return {gainsOf(smoothed(power.first, cols, rows), floor),
          gainsOf(smoothed(power.second, cols, rows), floor)};
}

double dot(const ComplexRaster& a, const ComplexRaster& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<double>(a.re[i] * b.re[i] + a.im[i] * b.im[i]);
  }
  return sum;
}

/// a += factor · b
void add(ComplexRaster& a, double factor, const ComplexRaster& b) {
  const auto f = static_cast<float>(factor);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a.re[i] += f * b.re[i];
    a.im[i] += f * b.im[i];
  }
}

class Whitening {
 public:
  Whitening(const map::SignalMap& fixed, ChannelPair channels, const Fft2& fft, double floor)
      : fft_(fft), observed_(observedOf(fixed, channels, fft)), scratch_(fft.size()) {
    ComplexRaster spectrum = observed_.values;
    fft_.forward(spectrum, scratch_, true);
    gains_ = gainsOf(spectrum, fft_, floor);
  }

  /// w with covariance · w = observed on the seen cells, 0 elsewhere: conjugate gradients until the
  /// residual's norm, in which the noise of the map would count as its power, is small.
  ComplexRaster solve() {
    ComplexRaster solution = whitened(observed_.values);
    ComplexRaster residual = observed_.values;
    add(residual, -1.0, covariance(solution));
    const double whole = dot(observed_.values, solution);
    ComplexRaster step = whitened(residual);
    ComplexRaster direction = step;
    double norm = dot(residual, step);
    for (int i = 0; i < kMostIterations && norm > kEnough * whole; ++i) {
      const ComplexRaster image = covariance(direction);
      const double length = norm / dot(direction, image);
      add(solution, length, direction);
      add(residual, -length, image);
      step = whitened(residual);
      const double next = dot(residual, step);
      const double turn = next / norm;
      norm = next;
      for (std::size_t k = 0; k < direction.size(); ++k) {
        direction.re[k] = step.re[k] + static_cast<float>(turn) * direction.re[k];
        direction.im[k] = step.im[k] + static_cast<float>(turn) * direction.im[k];
      }
    }
    return solution;
  }

 private:
  ComplexRaster whitened(const ComplexRaster& in) { return filtered(in, false); }
  ComplexRaster covariance(const ComplexRaster& in) { return filtered(in, true); }
  ComplexRaster filtered(ComplexRaster data, bool divide) {
    fft_.forward(data, scratch_, true);
    scaleChannels(data, gains_, divide, fft_.rows(), fft_.cols());
    fft_.inverse(data, scratch_, true);
    for (std::size_t i = 0; i < data.size(); ++i) {
      data.re[i] *= observed_.mask[i];
      data.im[i] *= observed_.mask[i];
    }
    return data;
  }

  const Fft2& fft_;
  Observed observed_;
  ComplexRaster scratch_;
  Gains gains_;
};

}  // namespace

ComplexRaster whitenedMap(const map::SignalMap& fixed, ChannelPair channels, const Fft2& fft,
                          double floor) {
  return Whitening(fixed, channels, fft, floor).solve();
}

}  // namespace agricolmap::correlation
