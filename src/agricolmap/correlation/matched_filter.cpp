#include "agricolmap/correlation/matched_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace agricolmap::correlation {

void listOptions(OptionTable& table, MatchedFilterOptions& options) {
  table.number("floor", options.floor, 1e-6, 1e6, "mean power",
               "added to the power spectrum that whitens the fixed map; large: no whitening");
  table.number("height_weight", options.height_weight, 0.0, 100.0, "",
               "weight of the height beside the greenness");
  table.number("luminance_weight", options.luminance_weight, 0.0, 100.0, "",
               "weight of the luminance beside the greenness");
}

MatchedFilter::MatchedFilter(const map::SignalMap& fixed, const MatchedFilterOptions& options,
                             int rim)
    : frame_(fixed.frame),
      options_(options),
      rim_(rim),
      fft_(Fft2::goodSize(fixed.frame.rows + 2 * rim), Fft2::goodSize(fixed.frame.cols + 2 * rim)) {
  for (int k = 0; k < map::kSignalChannels; ++k) {
    if (fixed.has(k) && options.weight(k) > 0.0) channels_.push_back(k);
  }
  ComplexRaster scratch(fft_.size());
  for (std::size_t i = 0; i < channels_.size(); i += 2) {
    const ChannelPair pair{channels_[i], i + 1 < channels_.size() ? channels_[i + 1] : -1};
    ComplexRaster map = whitenedMap(fixed, pair, fft_, options.floor);
    const auto keep = [&](int channel, const std::vector<float>& values) {
      Raster<float>& kept = maps_[static_cast<std::size_t>(channel)];
      kept = Raster<float>(fft_.rows(), fft_.cols());
      std::copy(values.begin(), values.end(), kept.begin());
    };
    keep(pair.first, map.re);
    if (pair.second >= 0) keep(pair.second, map.im);
    fft_.forward(map, scratch);
    pairs_.push_back({pair, std::move(map)});
  }
}

void MatchedFilter::transform(const Template& piece, ChannelPair channels, ComplexRaster& spectrum,
                              Work& work) const {
  const int rows = fft_.rows();
  const int width = std::max(1, piece.cols());
  const std::size_t size = static_cast<std::size_t>(rows) * width;
  for (ComplexRaster* buffer : {&work.piece, &work.piece_scratch}) {
    buffer->re.assign(size, 0.0F);
    buffer->im.assign(size, 0.0F);
  }
  const Raster<float>& first = piece.channel[channels.first];
  for (int r = 0; r < piece.rows(); ++r) {
    const int row = ((r + piece.first_row) % rows + rows) % rows;
    const std::size_t begin = static_cast<std::size_t>(row) * width;
    for (int c = 0; c < piece.cols(); ++c) {
      const std::size_t i = begin + static_cast<std::size_t>(c);
      work.piece.re[i] += first(r, c);
      if (channels.second >= 0) work.piece.im[i] += piece.channel[channels.second](r, c);
    }
  }
  fft_.forwardPiece(work.piece, work.piece_scratch, width, piece.first_col, spectrum, work.scratch);
}

void MatchedFilter::multiply(const Template& piece, ComplexRaster& product, Work& work) const {
  if (pairs_.empty()) {
    std::fill(product.re.begin(), product.re.end(), 0.0F);
    std::fill(product.im.begin(), product.im.end(), 0.0F);
  }
  for (std::size_t pair = 0; pair < pairs_.size(); ++pair) {
    ComplexRaster& spectrum = pair == 0 ? product : work.spectrum;
    transform(piece, pairs_[pair].channels, spectrum, work);
    float* re = product.re.data();
    float* im = product.im.data();
    const float* tr = spectrum.re.data();
    const float* ti = spectrum.im.data();
    const float* wr = pairs_[pair].spectrum.re.data();
    const float* wi = pairs_[pair].spectrum.im.data();
    const float before = pair == 0 ? 0.0F : 1.0F;
#pragma GCC ivdep
    for (std::size_t i = 0; i < product.size(); ++i) {
      const float a = tr[i] * wr[i] + ti[i] * wi[i];
      const float b = tr[i] * wi[i] - ti[i] * wr[i];
      re[i] = before * re[i] + a;
      im[i] = before * im[i] + b;
    }
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
