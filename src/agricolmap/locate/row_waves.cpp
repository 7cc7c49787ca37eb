#include "agricolmap/locate/row_waves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/parabola.hpp"
#include "agricolmap/correlation/fft.hpp"

namespace agricolmap::locate {
namespace {

/// Side of the part of a map that is looked at [cells].
constexpr int kMostCells = 600;
/// Bands of wavenumber over which the power is compared [per octave].
constexpr double kBandsPerOctave = 4.0;

/// The middle of a map.
map::GridMap middleOf(const map::GridMap& map) {
  const Eigen::Vector2d middle = map.frame.centre(0.5 * map.frame.rows, 0.5 * map.frame.cols);
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * kMostCells * map.frame.cell);
  return map::croppedMap(map, map::Box2(middle - half, middle + half));
}

/// Power of the map, tapered so that its edges make no waves.
struct Spectrum {
  int rows = 0;
  int cols = 0;
  double cell = 0.0;
  std::vector<float> power;  ///< at col · rows + row

  Eigen::Vector2d wave(int row, int col) const {
    const int r = row > rows / 2 ? row - rows : row;
    const int c = col > cols / 2 ? col - cols : col;
    return {c / (cols * cell), r / (rows * cell)};
  }
  float at(int row, int col) const {
    const int r = (row + rows) % rows;
    const int c = (col + cols) % cols;
    return power[static_cast<std::size_t>(c) * rows + static_cast<std::size_t>(r)];
  }
};

Spectrum spectrumOf(const map::SignalMap& map, const Raster<float>& value) {
  const int rows = map.frame.rows;
  const int cols = map.frame.cols;
  // Twice the size: peaks between the frequencies of a narrow strip must not be missed.
  const correlation::Fft2 fft(correlation::Fft2::goodSize(rows < kMostCells / 2 ? 2 * rows : rows),
                              correlation::Fft2::goodSize(cols < kMostCells / 2 ? 2 * cols : cols));
  correlation::ComplexRaster data(fft.size());
  correlation::ComplexRaster scratch(fft.size());
  const auto taper = [](int i, int n) {
    return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (i + 0.5) / n);
  };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const float window = static_cast<float>(taper(r, rows) * taper(c, cols));
      data.re[static_cast<std::size_t>(r) * fft.cols() + static_cast<std::size_t>(c)] =
          window * value(r, c) * std::min(1.0F, map.weight(r, c));
    }
  }
  fft.forward(data, scratch);
  Spectrum spectrum{fft.rows(), fft.cols(), map.frame.cell, std::vector<float>(fft.size())};
  for (std::size_t i = 0; i < spectrum.power.size(); ++i) {
    spectrum.power[i] = data.re[i] * data.re[i] + data.im[i] * data.im[i];
  }
  return spectrum;
}

}  // namespace

std::vector<Wave> strongestWaves(const map::GridMap& map, const map::SignalOptions& options,
                                 int most, double min_strength) {
  const map::SignalMap signal = map::makeSignalMap(middleOf(map), 1, options);
  // Rows are green, or at least high, before they are bright.
  int channel = 0;
  while (channel + 1 < map::kSignalChannels && !signal.has(channel)) ++channel;
  const Spectrum spectrum = spectrumOf(signal, signal.channel[channel]);
  // The high-pass leaves something of waves that are a little longer.
  const double least = 0.9 / options.high_pass;
  const double highest = 1.0 / (4.0 * map.frame.cell);
  const auto bandOf = [&](double k) {
    return static_cast<std::size_t>(kBandsPerOctave * std::log2(k / least));
  };
  if (!(highest > least)) return {};
  std::vector<double> sum(bandOf(highest) + 1, 0.0);
  std::vector<double> count(sum.size(), 0.0);
  struct Peak {
    int row, col;
    double power;
  };
  std::vector<Peak> peaks;
  for (int c = 0; c <= spectrum.cols / 2; ++c) {
    for (int r = 0; r < spectrum.rows; ++r) {
      const double k = spectrum.wave(r, c).norm();
      if (k < least || k > highest) continue;
      const float here = spectrum.at(r, c);
      sum[bandOf(k)] += static_cast<double>(here);
      count[bandOf(k)] += 1.0;
      bool top = true;
      for (int i = -1; i <= 1 && top; ++i) {
        for (int j = -1; j <= 1 && top; ++j) top = here >= spectrum.at(r + i, c + j);
      }
      if (top) peaks.push_back({r, c, static_cast<double>(here)});
    }
  }
  std::vector<Wave> waves;
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.power > b.power; });
  for (const Peak& peak : peaks) {
    if (static_cast<int>(waves.size()) >= most) break;
    const Eigen::Vector2d at = spectrum.wave(peak.row, peak.col);
    const std::size_t band = bandOf(at.norm());
    Wave wave;
    wave.strength = peak.power * count[band] / std::max(1e-30, sum[band]);
    if (wave.strength < min_strength) continue;
    const auto offset = [&](int dr, int dc) {
      return parabolaVertex(static_cast<double>(spectrum.at(peak.row - dr, peak.col - dc)),
                            peak.power,
                            static_cast<double>(spectrum.at(peak.row + dr, peak.col + dc)));
    };
    wave.vector = at + Eigen::Vector2d(offset(0, 1) / (spectrum.cols * spectrum.cell),
                                       offset(1, 0) / (spectrum.rows * spectrum.cell));
    // One crest has one wave: side lobes and the mirrored half of the spectrum are no others.
    const bool known = std::any_of(waves.begin(), waves.end(), [&](const Wave& other) {
      return std::min((other.vector - wave.vector).norm(), (other.vector + wave.vector).norm()) <
             0.2 * wave.vector.norm();
    });
    if (!known) waves.push_back(wave);
  }
  return waves;
}

std::vector<Hypothesis> alongWaves(const std::vector<Hypothesis>& hypotheses,
                                   const std::vector<Wave>& moving, const std::vector<Wave>& fixed,
                                   const SearchSpace& space, const WaveTolerance& tolerance) {
  const auto fits = [&](const Eigen::Vector2d& carried, const Eigen::Vector2d& to) {
    const Eigen::Vector2d along = to.normalized();
    const double length = to.norm();
    const double sign = carried.dot(along) < 0.0 ? -1.0 : 1.0;
    const double longer = (sign * carried.dot(along) - length) / (tolerance.along * length);
    const double turned =
        (along.x() * carried.y() - along.y() * carried.x()) / (tolerance.across * length);
    return longer * longer + turned * turned <= 1.0;
  };
  std::vector<Hypothesis> kept;
  for (const Hypothesis& hypothesis : hypotheses) {
    // cos(2π k·p) stays itself when p ↦ A·p and k ↦ A⁻ᵀ·k.
    const Eigen::Matrix2d carry = linearOf(hypothesis, space).inverse().transpose();
    const bool any = std::any_of(moving.begin(), moving.end(), [&](const Wave& from) {
      return std::any_of(fixed.begin(), fixed.end(),
                         [&](const Wave& to) { return fits(carry * from.vector, to.vector); });
    });
    if (any) kept.push_back(hypothesis);
  }
  return kept;
}

}  // namespace agricolmap::locate
