#include "agricolmap/correlation/fft.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::correlation {
namespace {

constexpr int kMaxRadix = 5;

/// Where one butterfly reads and writes: `count` consecutive values at each of `radix` places.
struct Butterfly {
  const float* in_re[kMaxRadix];
  const float* in_im[kMaxRadix];
  float* out_re[kMaxRadix];
  float* out_im[kMaxRadix];
  float cos[kMaxRadix];
  float sin[kMaxRadix];
  std::size_t count;
};

void butterfly2(const Butterfly& b) {
  const float *ar = b.in_re[0], *ai = b.in_im[0], *br = b.in_re[1], *bi = b.in_im[1];
  float *xr = b.out_re[0], *xi = b.out_im[0], *yr = b.out_re[1], *yi = b.out_im[1];
  const float c = b.cos[1], s = b.sin[1];
#pragma GCC ivdep
  for (std::size_t i = 0; i < b.count; ++i) {
    const float dr = ar[i] - br[i];
    const float di = ai[i] - bi[i];
    xr[i] = ar[i] + br[i];
    xi[i] = ai[i] + bi[i];
    yr[i] = dr * c - di * s;
    yi[i] = dr * s + di * c;
  }
}

/// `sign` is −1 forward, +1 inverse: the direction of the quarter turn.
void butterfly4(const Butterfly& b, float sign) {
  const float *r0 = b.in_re[0], *r1 = b.in_re[1], *r2 = b.in_re[2], *r3 = b.in_re[3];
  const float *i0 = b.in_im[0], *i1 = b.in_im[1], *i2 = b.in_im[2], *i3 = b.in_im[3];
  float *x0 = b.out_re[0], *x1 = b.out_re[1], *x2 = b.out_re[2], *x3 = b.out_re[3];
  float *y0 = b.out_im[0], *y1 = b.out_im[1], *y2 = b.out_im[2], *y3 = b.out_im[3];
  const float c1 = b.cos[1], c2 = b.cos[2], c3 = b.cos[3];
  const float s1 = b.sin[1], s2 = b.sin[2], s3 = b.sin[3];
#pragma GCC ivdep
  for (std::size_t i = 0; i < b.count; ++i) {
    const float ar = r0[i] + r2[i], ai = i0[i] + i2[i];
    const float br = r0[i] - r2[i], bi = i0[i] - i2[i];
    const float cr = r1[i] + r3[i], ci = i1[i] + i3[i];
    const float dr = sign * (i3[i] - i1[i]), di = sign * (r1[i] - r3[i]);
    x0[i] = ar + cr;
    y0[i] = ai + ci;
    const float er = br + dr, ei = bi + di;
    x1[i] = er * c1 - ei * s1;
    y1[i] = er * s1 + ei * c1;
    const float fr = ar - cr, fi = ai - ci;
    x2[i] = fr * c2 - fi * s2;
    y2[i] = fr * s2 + fi * c2;
    const float gr = br - dr, gi = bi - di;
    x3[i] = gr * c3 - gi * s3;
    y3[i] = gr * s3 + gi * c3;
  }
}

/// Any small radix by its definition; only 3 and 5 come here.
template <int kRadix>
void butterflyOdd(const Butterfly& b, float sign) {
  float cos[kRadix], sin[kRadix];
  for (int k = 0; k < kRadix; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kRadix;
    cos[k] = static_cast<float>(std::cos(angle));
    sin[k] = sign * static_cast<float>(std::sin(angle));
  }
  for (int j = 0; j < kRadix; ++j) {
    float* xr = b.out_re[j];
    float* xi = b.out_im[j];
    const float c = b.cos[j], s = b.sin[j];
#pragma GCC ivdep
    for (std::size_t i = 0; i < b.count; ++i) {
      float sr = b.in_re[0][i], si = b.in_im[0][i];
      for (int k = 1; k < kRadix; ++k) {
        const float wr = cos[j * k % kRadix], wi = sin[j * k % kRadix];
        sr += b.in_re[k][i] * wr - b.in_im[k][i] * wi;
        si += b.in_re[k][i] * wi + b.in_im[k][i] * wr;
      }
      xr[i] = sr * c - si * s;
      xi[i] = sr * s + si * c;
    }
  }
}

/// Elements of a pass that one thread takes at a time; a multiple of any vector's length.
constexpr std::size_t kChunk = 8192;

void butterfly(const Butterfly& b, int radix, float sign) {
  switch (radix) {
    case 2:
      butterfly2(b);
      break;
    case 3:
      butterflyOdd<3>(b, sign);
      break;
    case 4:
      butterfly4(b, sign);
      break;
    default:
      butterflyOdd<5>(b, sign);
      break;
  }
}

void transpose(const std::vector<float>& in, int rows, int cols, std::vector<float>& out) {
  constexpr int kTile = 16;
  for (int r0 = 0; r0 < rows; r0 += kTile) {
    for (int c0 = 0; c0 < cols; c0 += kTile) {
      for (int c = c0; c < std::min(c0 + kTile, cols); ++c) {
        for (int r = r0; r < std::min(r0 + kTile, rows); ++r) {
          out[static_cast<std::size_t>(c) * rows + r] = in[static_cast<std::size_t>(r) * cols + c];
        }
      }
    }
  }
}

void transpose(ComplexRaster& data, ComplexRaster& scratch, int rows, int cols) {
  transpose(data.re, rows, cols, scratch.re);
  transpose(data.im, rows, cols, scratch.im);
  std::swap(data, scratch);
}

}  // namespace

BatchFft::BatchFft(int length) {
  int remaining = length;
  int stride = 1;
  while (remaining > 1) {
    const int radix = remaining % 4 == 0   ? 4
                      : remaining % 3 == 0 ? 3
                      : remaining % 5 == 0 ? 5
                      : remaining % 2 == 0 ? 2
                                           : 0;
    if (radix == 0) throw UsageError("FFT lengths must be products of 2, 3 and 5");
    Pass pass{radix, remaining, stride, {}, {}};
    for (int p = 0; p < remaining / radix; ++p) {
      for (int j = 0; j < radix; ++j) {
        const double angle = -2.0 * std::numbers::pi * p * j / remaining;
        pass.cos.push_back(static_cast<float>(std::cos(angle)));
        pass.sin.push_back(static_cast<float>(std::sin(angle)));
      }
    }
    passes_.push_back(std::move(pass));
    remaining /= radix;
    stride *= radix;
  }
}

void BatchFft::transform(ComplexRaster& data, ComplexRaster& scratch, int batch, bool forward,
                         bool threads) const {
  const float sign = forward ? -1.0F : 1.0F;
  for (const Pass& pass : passes_) {
    const int parts = pass.remaining / pass.radix;
    const std::size_t run = static_cast<std::size_t>(pass.stride) * batch;
    const auto part = [&](int p, std::size_t begin, std::size_t end) {
      Butterfly b{};
      b.count = end - begin;
      for (int j = 0; j < pass.radix; ++j) {
        const std::size_t from = run * static_cast<std::size_t>(p + j * parts) + begin;
        const std::size_t to = run * static_cast<std::size_t>(pass.radix * p + j) + begin;
        b.in_re[j] = data.re.data() + from;
        b.in_im[j] = data.im.data() + from;
        b.out_re[j] = scratch.re.data() + to;
        b.out_im[j] = scratch.im.data() + to;
        b.cos[j] = pass.cos[static_cast<std::size_t>(p * pass.radix + j)];
        b.sin[j] = -sign * pass.sin[static_cast<std::size_t>(p * pass.radix + j)];
      }
      butterfly(b, pass.radix, sign);
    };
    if (threads) {
      const std::size_t chunks = (run + kChunk - 1) / kChunk;
      parallelFor(static_cast<std::size_t>(parts) * chunks, [&](std::size_t i) {
        const std::size_t begin = i % chunks * kChunk;
        part(static_cast<int>(i / chunks), begin, std::min(run, begin + kChunk));
      });
    } else {
      for (int p = 0; p < parts; ++p) part(p, 0, run);
    }
    std::swap(data, scratch);
  }
}

Fft2::Fft2(int rows, int cols) : rows_(rows), cols_(cols), along_rows_(rows), along_cols_(cols) {}

int Fft2::goodSize(int n) {
  for (int size = std::max(1, n);; ++size) {
    int rest = size;
    for (const int factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return size;
  }
}

void Fft2::forward(ComplexRaster& data, ComplexRaster& scratch, bool threads) const {
  along_rows_.transform(data, scratch, cols_, true, threads);
  transpose(data, scratch, rows_, cols_);
  along_cols_.transform(data, scratch, rows_, true, threads);
}

void Fft2::forwardPiece(ComplexRaster& piece, ComplexRaster& piece_scratch, int width,
                        int first_col, ComplexRaster& spectrum, ComplexRaster& scratch) const {
  along_rows_.transform(piece, piece_scratch, width, true);
  std::fill(spectrum.re.begin(), spectrum.re.end(), 0.0F);
  std::fill(spectrum.im.begin(), spectrum.im.end(), 0.0F);
  for (int c = 0; c < width; ++c) {
    const int col = ((first_col + c) % cols_ + cols_) % cols_;
    float* re = spectrum.re.data() + static_cast<std::size_t>(col) * rows_;
    float* im = spectrum.im.data() + static_cast<std::size_t>(col) * rows_;
    for (int r = 0; r < rows_; ++r) {
      const std::size_t i = static_cast<std::size_t>(r) * width + c;
      re[r] += piece.re[i];
      im[r] += piece.im[i];
    }
  }
  along_cols_.transform(spectrum, scratch, rows_, true);
}

void Fft2::inverse(ComplexRaster& data, ComplexRaster& scratch, bool threads) const {
  along_cols_.transform(data, scratch, rows_, false, threads);
  transpose(data, scratch, cols_, rows_);
  along_rows_.transform(data, scratch, cols_, false, threads);
  const float scale = 1.0F / static_cast<float>(size());
  for (float& v : data.re) v *= scale;
  for (float& v : data.im) v *= scale;
}

}  // namespace agricolmap::correlation
