#include "experiments/methods/plain_correlation.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::experiments {

PlainCorrelation::PlainCorrelation(const map::SignalMap& fixed, int most_rows, int most_cols,
                                   double least_energy)
    : frame_(fixed.frame),
      fft_(correlation::Fft2::goodSize(fixed.frame.rows + most_rows),
           correlation::Fft2::goodSize(fixed.frame.cols + most_cols)) {
  const Raster<float>& value = fixed.channel[0];
  Raster<float> square(value.rows(), value.cols());
  double energy = 0.0;
  double seen = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    square[i] = value[i] * value[i];
    energy += static_cast<double>(square[i]);
    seen += fixed.weight[i] > 0.0F ? 1.0 : 0.0;
  }
  floor_ = least_energy * energy / std::max(seen, 1.0);
  fixed_ = spectrumOf(value, 0, 0);
  squared_ = spectrumOf(square, 0, 0);
}

correlation::ComplexRaster PlainCorrelation::spectrumOf(const Raster<float>& values, int first_row,
                                                        int first_col) const {
  const int rows = fft_.rows();
  const int width = values.cols();
  correlation::ComplexRaster strip(static_cast<std::size_t>(rows) * width);
  correlation::ComplexRaster strip_scratch(strip.size());
  for (int r = 0; r < values.rows(); ++r) {
    const int row = ((r + first_row) % rows + rows) % rows;
    std::copy_n(values.row(r), width, &strip.re[static_cast<std::size_t>(row) * width]);
  }
  correlation::ComplexRaster spectrum(fft_.size());
  correlation::ComplexRaster scratch(fft_.size());
  fft_.forwardPiece(strip, strip_scratch, width, first_col, spectrum, scratch);
  return spectrum;
}

PlainCorrelation::Peak PlainCorrelation::best(const Piece& piece, const Eigen::Vector2d& centre,
                                              double reach) const {
  double energy = 0.0;
  double cells = 0.0;
  for (std::size_t i = 0; i < piece.value.size(); ++i) {
    energy += static_cast<double>(piece.value[i]) * static_cast<double>(piece.value[i]);
    cells += static_cast<double>(piece.seen[i]);
  }
  Peak peak;
  if (!(energy > 0.0)) return peak;
  const correlation::ComplexRaster signal =
      spectrumOf(piece.value, piece.first_row, piece.first_col);
  const correlation::ComplexRaster mask = spectrumOf(piece.seen, piece.first_row, piece.first_col);
  // Both correlations are real: as real and imaginary part of one raster they share an inverse.
  correlation::ComplexRaster both(fft_.size());
  for (std::size_t i = 0; i < both.size(); ++i) {
    const float ar = signal.re[i] * fixed_.re[i] + signal.im[i] * fixed_.im[i];
    const float ai = signal.re[i] * fixed_.im[i] - signal.im[i] * fixed_.re[i];
    const float br = mask.re[i] * squared_.re[i] + mask.im[i] * squared_.im[i];
    const float bi = mask.re[i] * squared_.im[i] - mask.im[i] * squared_.re[i];
    both.re[i] = ar - bi;
    both.im[i] = ai + br;
  }
  correlation::ComplexRaster scratch(fft_.size());
  fft_.inverse(both, scratch);
  for (int r = 0; r < frame_.rows; ++r) {
    for (int c = 0; c < frame_.cols; ++c) {
      const Eigen::Vector2d anchor = frame_.centre(r, c);
      if ((anchor - centre).norm() > reach) continue;
      const std::size_t i = static_cast<std::size_t>(r) * fft_.cols() + c;
      const double under = std::max(static_cast<double>(both.im[i]), floor_ * cells);
      const double correlation = static_cast<double>(both.re[i]) / std::sqrt(energy * under);
      const double score = correlation * std::sqrt(cells);
      if (score > peak.score) peak = {score, correlation, anchor};
    }
  }
  return peak;
}

}  // namespace agricolmap::experiments
