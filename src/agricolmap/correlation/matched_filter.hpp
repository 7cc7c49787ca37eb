// Where does a piece of the moving map fit? Correlation with the fixed map whitened by its own
// power spectrum: the optimal detector in clutter that looks like the rest of the field, and blind
// to what repeats (rows, plant spacing).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "agricolmap/correlation/fft.hpp"
#include "agricolmap/correlation/whitening.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::correlation {

struct MatchedFilterOptions {
  double floor = 0.4;          ///< added to the power spectrum, in units of its mean
  double height_weight = 1.0;  ///< of the height channel; greenness has 1
  double luminance_weight = 1.0;

  double weight(int channel) const {
    return channel == map::kHeightChannel      ? height_weight
           : channel == map::kLuminanceChannel ? luminance_weight
                                               : 1.0;
  }
};
void listOptions(OptionTable& table, MatchedFilterOptions& options);

/// A piece of the moving map, moved by a linear map and resampled to the fixed map's cell size.
/// Offsets are relative to the cell of the piece's anchor.
struct Template {
  int first_row = 0;  ///< row offset of element (0, 0)
  int first_col = 0;
  Raster<float> channel[map::kSignalChannels];  ///< times its weight
  double filled = 0;                            ///< number of cells seen

  int rows() const { return channel[0].rows(); }
  int cols() const { return channel[0].cols(); }
  /// Sum of the squares of a cell's values.
  double energy(int row, int col) const {
    double sum = 0.0;
    for (const Raster<float>& values : channel) {
      sum += static_cast<double>(values(row, col)) * static_cast<double>(values(row, col));
    }
    return sum;
  }
};

/// Samples `moving` where `inside(point)` holds: element d covers the moving point
/// anchor + linear⁻¹ · d · cell. `reach` bounds |point − anchor| in the moving frame [m].
template <typename Inside>
Template makeTemplate(const map::SignalMap& moving, const Eigen::Vector2d& anchor,
                      const Eigen::Matrix2d& linear, const Eigen::AlignedBox2d& bounds, double cell,
                      const MatchedFilterOptions& options, const Inside& inside);

class MatchedFilter {
 public:
  /// `rim`: how far beyond the map's border [cells] a piece's anchor is scored too, so that pieces
  /// that reach over it count with what they have inside.
  MatchedFilter(const map::SignalMap& fixed, const MatchedFilterOptions& options, int rim = 0);

  /// Buffers of one correlation at a time.
  struct Work {
    explicit Work(const MatchedFilter& filter)
        : first(filter.fft().size()),
          second(filter.fft().size()),
          spectrum(filter.fft().size()),
          scratch(filter.fft().size()) {}
    ComplexRaster first, second, spectrum, scratch, piece, piece_scratch;
  };
  /// Scores of two templates' anchors at every cell of the fixed map: `surface.re` and `surface.im`
  /// of size `fft().rows() × fft().cols()`, row-major. Two at once cost little more than one: each
  /// score is real. Correlation is circular.
  void correlate(const Template& first, const Template& second, ComplexRaster& surface,
                 Work& work) const;
  /// One template alone; `surface.im` is 0.
  void correlate(const Template& piece, ComplexRaster& surface, Work& work) const;
  /// Root mean square of a template's scores over all shifts, for half of what the scores cost.
  double deviation(const Template& piece, Work& work) const;

  const Fft2& fft() const { return fft_; }
  const GridFrame& frame() const { return frame_; }
  int rim() const { return rim_; }
  const MatchedFilterOptions& options() const { return options_; }
  /// Those of the fixed map's channels that are not empty.
  const std::vector<int>& channels() const { return channels_; }
  /// The whitened map itself, one of `channels()`; cells beyond the frame pad it for the FFT.
  const Raster<float>& whitened(int channel) const {
    return maps_[static_cast<std::size_t>(channel)];
  }

 private:
  /// A pair of channels of the whitened map: spectrum of the first + i · the second.
  struct Whitened {
    ChannelPair channels;
    ComplexRaster spectrum;
  };
  /// Spectrum of a pair of a template's channels: the first + i · the second.
  void transform(const Template& piece, ChannelPair channels, ComplexRaster& spectrum,
                 Work& work) const;
  /// conj(template) · whitened map, spectra, summed over the channels. The real part of its inverse
  /// transform holds the scores.
  void multiply(const Template& piece, ComplexRaster& product, Work& work) const;

  GridFrame frame_;
  MatchedFilterOptions options_;
  int rim_;
  Fft2 fft_;
  std::vector<int> channels_;
  std::vector<Whitened> pairs_;
  std::array<Raster<float>, map::kSignalChannels> maps_;
};

// Implementation of the template.

template <typename Inside>
Template makeTemplate(const map::SignalMap& moving, const Eigen::Vector2d& anchor,
                      const Eigen::Matrix2d& linear, const Eigen::AlignedBox2d& bounds, double cell,
                      const MatchedFilterOptions& options, const Inside& inside) {
  Eigen::AlignedBox2d moved;
  for (int corner = 0; corner < 4; ++corner) {
    moved.extend(Eigen::Vector2d(
        linear * (bounds.corner(static_cast<Eigen::AlignedBox2d::CornerType>(corner)) - anchor) /
        cell));
  }
  Template piece;
  piece.first_row = static_cast<int>(std::floor(moved.min().y()));
  piece.first_col = static_cast<int>(std::floor(moved.min().x()));
  const int rows = static_cast<int>(std::ceil(moved.max().y())) - piece.first_row + 1;
  const int cols = static_cast<int>(std::ceil(moved.max().x())) - piece.first_col + 1;
  float weight[map::kSignalChannels];
  for (int k = 0; k < map::kSignalChannels; ++k) {
    piece.channel[k] = Raster<float>(rows, cols);
    weight[k] = static_cast<float>(options.weight(k));
  }
  const Eigen::Matrix2d back = linear.inverse() * cell;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const Eigen::Vector2d point =
          anchor + back * Eigen::Vector2d(c + piece.first_col, r + piece.first_row);
      if (!inside(point)) continue;
      const map::SignalSample sample = map::sampleSignal(moving, point);
      if (sample.weight <= 0.0F) continue;
      for (int k = 0; k < map::kSignalChannels; ++k) {
        piece.channel[k](r, c) = sample.value[k] * weight[k];
      }
      piece.filled += 1.0;
    }
  }
  return piece;
}

}  // namespace agricolmap::correlation
