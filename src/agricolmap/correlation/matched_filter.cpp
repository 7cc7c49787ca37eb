#include "agricolmap/correlation/matched_filter.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/correlation/whitening.hpp"

namespace agricolmap::correlation {

void listOptions(OptionTable& table, MatchedFilterOptions& options) {
  table.number("floor", options.floor, 1e-6, 1e6, "mean power",
               "added to the power spectrum that whitens the fixed map; large: no whitening");
  table.number("height_weight", options.height_weight, 0.0, 100.0, "",
               "weight of the height channel beside the greenness");
}

MatchedFilter::MatchedFilter(const map::SignalMap& fixed, const MatchedFilterOptions& options,
                             int rim)
    : frame_(fixed.frame),
      options_(options),
      rim_(rim),
      fft_(Fft2::goodSize(fixed.frame.rows + 2 * rim), Fft2::goodSize(fixed.frame.cols + 2 * rim)) {
  const ComplexRaster map = whitenedMap(fixed, fft_, options.floor);
  greenness_ = Raster<float>(fft_.rows(), fft_.cols());
  height_ = Raster<float>(fft_.rows(), fft_.cols());
  for (std::size_t i = 0; i < map.size(); ++i) {
    greenness_[i] = map.re[i];
    height_[i] = map.im[i];
  }
  // greenness + i · height: the real part of conj(template) · map is the sum of both channels.
  whitened_ = map;
  ComplexRaster scratch(fft_.size());
  fft_.forward(whitened_, scratch);
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

double MatchedFilter::deviation(const Template& piece, Work& work) const {
  multiply(piece, work.first, work);
  const int rows = fft_.rows();
  const int cols = fft_.cols();
  // Parseval, over the part of the spectrum that gives the real scores.
  double sum2 = 0.0;
  for (int c = 0; c < cols; ++c) {
    const std::size_t here = static_cast<std::size_t>(c) * rows;
    const std::size_t there = static_cast<std::size_t>((cols - c) % cols) * rows;
    const auto power = [&](std::size_t k, std::size_t m) {
      const float re = 0.5F * (work.first.re[k] + work.first.re[m]);
      const float im = 0.5F * (work.first.im[k] - work.first.im[m]);
      return static_cast<double>(re * re + im * im);
    };
    sum2 += power(here, there);
    for (int r = 1; r < rows; ++r) {
      sum2 += power(here + static_cast<std::size_t>(r), there + static_cast<std::size_t>(rows - r));
    }
  }
  return std::sqrt(sum2) / static_cast<double>(fft_.size());
}

}  // namespace agricolmap::correlation
