#include "agricolmap/map/box_mean.hpp"

#include <algorithm>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::map {
namespace {

/// Sums over 2·radius + 1 cells along rows.
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

}  // namespace

BoxMean::BoxMean(const Raster<float>& weight, int radius)
    : weight_(weight), radius_(radius), norm_(boxSum(weight, radius)) {}

Raster<float> BoxMean::of(const Raster<float>& value) const {
  Raster<float> product(value.rows(), value.cols());
  for (std::size_t i = 0; i < value.size(); ++i) product[i] = value[i] * weight_[i];
  Raster<float> sum = boxSum(product, radius_);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = norm_[i] > 1e-3F ? sum[i] / norm_[i] : 0.0F;
  }
  return sum;
}

}  // namespace agricolmap::map
