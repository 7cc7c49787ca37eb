#include "agricolmap/4_associate/correlate/matched_filter.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap {

void describe(OptionTable& table, MatchedFilterOptions& options) {
  table.number("floor", options.floor, 1e-6, 1e6, "mean power",
               "added to the power spectrum that whitens the fixed map; large: no whitening");
  table.number("height_weight", options.height_weight, 0.0, 100.0, "",
               "weight of the height channel beside the greenness");
}

namespace {

/// |spectrum|², averaged over 3 × 3 frequencies: one map is one sample of its field's spectrum.
std::vector<float> smoothedPower(const ComplexRaster& spectrum, int rows, int cols) {
  std::vector<float> power(spectrum.size());
  for (std::size_t i = 0; i < power.size(); ++i) {
    power[i] = spectrum.re[i] * spectrum.re[i] + spectrum.im[i] * spectrum.im[i];
  }
  std::vector<float> across(power.size());
  for (int r = 0; r < rows; ++r) {
    const std::size_t base = static_cast<std::size_t>(r) * cols;
    for (int c = 0; c < cols; ++c) {
      across[base + c] =
          power[base + (c + cols - 1) % cols] + power[base + c] + power[base + (c + 1) % cols];
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

/// The spectrum of one channel divided by its power plus the floor.
ComplexRaster whitenedSpectrum(const SignalMap& fixed, int channel, const Fft2& fft, double floor) {
  ComplexRaster data(fft.size());
  ComplexRaster scratch(fft.size());
  for (int r = 0; r < fixed.frame.rows; ++r) {
    for (int c = 0; c < fixed.frame.cols; ++c) {
      data.re[static_cast<std::size_t>(r) * fft.cols() + c] =
          fixed.channel[channel](r, c) * std::min(1.0F, fixed.weight(r, c));
    }
  }
  fft.forward(data, scratch);
  const std::vector<float> power = smoothedPower(data, fft.cols(), fft.rows());
  double mean = 0.0;
  for (const float p : power) mean += static_cast<double>(p);
  mean /= static_cast<double>(power.size());
  const auto add = static_cast<float>(std::max(floor * mean, 1e-20));
  for (std::size_t i = 0; i < power.size(); ++i) {
    // Scaled to unit mean gain, so that the two channels stay comparable.
    const float gain = static_cast<float>(std::max(mean, 1e-20)) / (power[i] + add);
    data.re[i] *= gain;
    data.im[i] *= gain;
  }
  return data;
}

}  // namespace

MatchedFilter::MatchedFilter(const SignalMap& fixed, const MatchedFilterOptions& options)
    : frame_(fixed.frame),
      options_(options),
      fft_(Fft2::goodSize(fixed.frame.rows), Fft2::goodSize(fixed.frame.cols)) {
  whitened_ = whitenedSpectrum(fixed, 0, fft_, options.floor);
  const ComplexRaster height = whitenedSpectrum(fixed, 1, fft_, options.floor);
  // greenness + i · height: the real part of conj(template) · map is the sum of both channels.
  for (std::size_t i = 0; i < whitened_.size(); ++i) {
    whitened_.re[i] -= height.im[i];
    whitened_.im[i] += height.re[i];
  }
  ComplexRaster map = whitened_;
  ComplexRaster scratch(fft_.size());
  fft_.inverse(map, scratch);
  greenness_ = Raster<float>(fft_.rows(), fft_.cols());
  height_ = Raster<float>(fft_.rows(), fft_.cols());
  double sum2 = 0.0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    greenness_[i] = map.re[i];
    height_[i] = map.im[i];
    sum2 += static_cast<double>(map.re[i] * map.re[i] + map.im[i] * map.im[i]);
  }
  deviation_ = std::sqrt(0.5 * sum2 / static_cast<double>(map.size()));
}

void MatchedFilter::multiply(const Template& piece, ComplexRaster& product, Work& work) const {
  const int rows = fft_.rows();
  const int width = std::max(1, piece.re.cols());
  const std::size_t size = static_cast<std::size_t>(rows) * width;
  for (ComplexRaster* buffer : {&work.piece, &work.piece_scratch}) {
    buffer->re.assign(size, 0.0F);
    buffer->im.assign(size, 0.0F);
  }
  for (int r = 0; r < piece.re.rows(); ++r) {
    const int row = ((r + piece.first_row) % rows + rows) % rows;
    for (int c = 0; c < piece.re.cols(); ++c) {
      const std::size_t i = static_cast<std::size_t>(row) * width + c;
      work.piece.re[i] += piece.re(r, c);
      work.piece.im[i] += piece.im(r, c);
    }
  }
  fft_.forwardPiece(work.piece, work.piece_scratch, width, piece.first_col, product, work.scratch);
  float* re = product.re.data();
  float* im = product.im.data();
  const float* wr = whitened_.re.data();
  const float* wi = whitened_.im.data();
#pragma GCC ivdep
  for (std::size_t i = 0; i < product.size(); ++i) {
    const float a = re[i] * wr[i] + im[i] * wi[i];
    const float b = re[i] * wi[i] - im[i] * wr[i];
    re[i] = a;
    im[i] = b;
  }
}

void MatchedFilter::correlate(const Template& first, const Template& second, ComplexRaster& surface,
                              Work& work) const {
  multiply(first, work.first, work);
  multiply(second, work.second, work);
  // The real part of each result has the Hermitian part of its spectrum; as real and imaginary part
  // of one raster both come back by one transform.
  const int rows = fft_.rows();
  const int cols = fft_.cols();
  for (int c = 0; c < cols; ++c) {
    const std::size_t here = static_cast<std::size_t>(c) * rows;
    const std::size_t there = static_cast<std::size_t>((cols - c) % cols) * rows;
    const auto combine = [&](std::size_t k, std::size_t m) {
      const float ar = 0.5F * (work.first.re[k] + work.first.re[m]);
      const float ai = 0.5F * (work.first.im[k] - work.first.im[m]);
      const float br = 0.5F * (work.second.re[k] + work.second.re[m]);
      const float bi = 0.5F * (work.second.im[k] - work.second.im[m]);
      surface.re[k] = ar - bi;
      surface.im[k] = ai + br;
    };
    combine(here, there);
    for (int r = 1; r < rows; ++r) {
      combine(here + static_cast<std::size_t>(r), there + static_cast<std::size_t>(rows - r));
    }
  }
  fft_.inverse(surface, work.scratch);
}

void MatchedFilter::correlate(const Template& piece, ComplexRaster& surface, Work& work) const {
  multiply(piece, surface, work);
  fft_.inverse(surface, work.scratch);
  std::fill(surface.im.begin(), surface.im.end(), 0.0F);
}

}  // namespace agricolmap
