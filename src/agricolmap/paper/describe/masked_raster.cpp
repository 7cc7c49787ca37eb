#include "agricolmap/paper/describe/masked_raster.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::paper {

namespace {

constexpr std::size_t kRowGrain = 8;

/// Columns that are not all zero: a strip that lies askew fills little of its bounding box.
struct Span {
  int begin = 0;
  int end = 0;

  bool empty() const { return begin >= end; }
  Span widened(int by, int cols) const {
    return empty() ? Span{} : Span{std::max(begin - by, 0), std::min(end + by, cols)};
  }
  void include(const Span& other) {
    if (other.empty()) return;
    *this = empty() ? other : Span{std::min(begin, other.begin), std::max(end, other.end)};
  }
};

Span spanOf(const float* row, int cols, int depth) {
  const auto used = [&](int col) {
    const float* cell = row + static_cast<std::ptrdiff_t>(col) * depth;
    return std::any_of(cell, cell + depth, [](float value) { return value != 0.0F; });
  };
  Span span{0, cols};
  while (span.begin < cols && !used(span.begin)) ++span.begin;
  while (span.end > span.begin && !used(span.end - 1)) --span.end;
  return span;
}

/// One row along x. `kDepth` floats per cell; the kernel is symmetric.
template <int kDepth>
void smoothRow(const float* in, float* out, int cols, Span span, const std::vector<float>& kernel) {
  const int radius = static_cast<int>(kernel.size() / 2);
  for (int col = span.begin; col < span.end; ++col) {
    const int first = std::max(-radius, -col);
    const int last = std::min(radius, cols - 1 - col);
    float sum[kDepth] = {};
    for (int k = first; k <= last; ++k) {
      const float weight = kernel[static_cast<std::size_t>(k + radius)];
      const float* cell = in + static_cast<std::ptrdiff_t>(col + k) * kDepth;
      for (int j = 0; j < kDepth; ++j) sum[j] += weight * cell[j];
    }
    for (int j = 0; j < kDepth; ++j) out[static_cast<std::ptrdiff_t>(col) * kDepth + j] = sum[j];
  }
}

/// Floats [begin, end) of one row along y, from the rows around it, in strips of columns that stay
/// in registers.
void smoothColumn(const float* in, float* out, int row, int rows, std::size_t width,
                  std::size_t begin, std::size_t end, const std::vector<float>& kernel) {
  constexpr std::size_t kStrip = 32;
  const int radius = static_cast<int>(kernel.size() / 2);
  const int first = std::max(-radius, -row);
  const int last = std::min(radius, rows - 1 - row);
  for (; begin < end; begin += kStrip) {
    float sum[kStrip] = {};
    const std::size_t count = std::min(kStrip, end - begin);
    for (int k = first; k <= last; ++k) {
      const float weight = kernel[static_cast<std::size_t>(k + radius)];
      const float* source = in + static_cast<std::size_t>(row + k) * width + begin;
      if (count == kStrip) {
        for (std::size_t j = 0; j < kStrip; ++j) sum[j] += weight * source[j];
      } else {
        for (std::size_t j = 0; j < count; ++j) sum[j] += weight * source[j];
      }
    }
    std::copy_n(sum, count, out + static_cast<std::size_t>(row) * width + begin);
  }
}

/// `out` must be zero.
template <int kDepth>
void smoothInto(const float* in, float* out, int rows, int cols, double sigma) {
  const std::vector<float> kernel = gaussianKernel(sigma);
  const int radius = static_cast<int>(kernel.size() / 2);
  const std::size_t width = static_cast<std::size_t>(cols) * kDepth;
  const auto count = static_cast<std::size_t>(rows);
  std::vector<float> across(width * count);
  std::vector<Span> spans(count);
  parallelFor(
      count,
      [&](std::size_t row) {
        const float* source = in + row * width;
        spans[row] = spanOf(source, cols, kDepth).widened(radius, cols);
        smoothRow<kDepth>(source, across.data() + row * width, cols, spans[row], kernel);
      },
      kRowGrain);
  parallelFor(
      count,
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        Span span;
        for (int k = std::max(row - radius, 0); k <= std::min(row + radius, rows - 1); ++k) {
          span.include(spans[static_cast<std::size_t>(k)]);
        }
        smoothColumn(across.data(), out, row, rows, width,
                     static_cast<std::size_t>(span.begin) * kDepth,
                     static_cast<std::size_t>(span.end) * kDepth, kernel);
      },
      kRowGrain);
}

}  // namespace

std::vector<float> gaussianKernel(double sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(2.5 * sigma)));
  std::vector<float> kernel;
  double sum = 0.0;
  for (int k = -radius; k <= radius; ++k) {
    const double value = std::exp(-0.5 * k * k / (sigma * sigma));
    kernel.push_back(static_cast<float>(value));
    sum += value;
  }
  for (float& value : kernel) value /= static_cast<float>(sum);
  return kernel;
}

Layers smoothed(const Layers& in, double sigma) {
  Layers out(in.rows, in.cols, in.depth);
  if (in.depth == 8) {
    smoothInto<8>(in.data.data(), out.data.data(), in.rows, in.cols, sigma);
  } else {
    smoothInto<1>(in.data.data(), out.data.data(), in.rows, in.cols * in.depth, sigma);
  }
  return out;
}

Raster<float> smoothed(const Raster<float>& in, double sigma) {
  Raster<float> out(in.rows(), in.cols());
  smoothInto<1>(in.data(), out.data(), in.rows(), in.cols(), sigma);
  return out;
}

MaskedRaster smoothed(const MaskedRaster& in, double sigma) {
  Raster<float> weighted = in.value;
  for (std::size_t i = 0; i < weighted.size(); ++i) weighted[i] *= in.weight[i];
  MaskedRaster out{smoothed(weighted, sigma), smoothed(in.weight, sigma)};
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    // Below this the quotient is noise of the kernel's tail.
    out.value[i] = out.weight[i] > 1e-4F ? out.value[i] / out.weight[i] : 0.0F;
  }
  return out;
}

MaskedRaster halved(const MaskedRaster& in) {
  const int rows = (in.value.rows() + 1) / 2;
  const int cols = (in.value.cols() + 1) / 2;
  MaskedRaster out{Raster<float>(rows, cols), Raster<float>(rows, cols)};
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      float weight = 0.0F;
      float value = 0.0F;
      for (int r = 2 * row; r < std::min(2 * row + 2, in.value.rows()); ++r) {
        for (int c = 2 * col; c < std::min(2 * col + 2, in.value.cols()); ++c) {
          weight += in.weight(r, c);
          value += in.weight(r, c) * in.value(r, c);
        }
      }
      out.weight(row, col) = 0.25F * weight;
      out.value(row, col) = weight > 0.0F ? value / weight : 0.0F;
    }
  }
  return out;
}

}  // namespace agricolmap::paper
