#include "agricolmap/simulate/field/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::simulate {

Window makeWindow(const Eigen::Vector2d& corner, double heading, double width, double height,
                  double cell) {
  Window window;
  window.corner = corner;
  window.heading = heading;
  window.cell = cell;
  window.cols = std::max(1, static_cast<int>(std::ceil(width / cell - 1e-9)));
  window.rows = std::max(1, static_cast<int>(std::ceil(height / cell - 1e-9)));
  return window;
}

namespace {

std::vector<float> gaussianKernel(double sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3.0 * sigma)));
  std::vector<float> kernel(static_cast<std::size_t>(2 * radius + 1));
  float sum = 0.0F;
  for (int i = -radius; i <= radius; ++i) {
    const double t = i / sigma;
    kernel[static_cast<std::size_t>(i + radius)] = static_cast<float>(std::exp(-0.5 * t * t));
    sum += kernel[static_cast<std::size_t>(i + radius)];
  }
  for (float& k : kernel) k /= sum;
  return kernel;
}

}  // namespace

void blurRaster(Raster<float>& raster, double sigma) {
  if (sigma < 0.2 || raster.empty()) return;
  const std::vector<float> kernel = gaussianKernel(sigma);
  const int radius = static_cast<int>(kernel.size()) / 2;
  const int rows = raster.rows();
  const int cols = raster.cols();
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t r) {
        float* row = raster.row(static_cast<int>(r));
        std::vector<float> padded(static_cast<std::size_t>(cols + 2 * radius));
        std::fill_n(padded.begin(), radius, row[0]);
        std::copy_n(row, cols, padded.begin() + radius);
        std::fill_n(padded.begin() + radius + cols, radius, row[cols - 1]);
        std::fill_n(row, cols, 0.0F);
        for (std::size_t k = 0; k < kernel.size(); ++k) {
          const float weight = kernel[k];
          const float* shifted = padded.data() + k;
          for (int c = 0; c < cols; ++c) row[c] += weight * shifted[c];
        }
      },
      16);
  Raster<float> source = raster;
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t r) {
        float* row = raster.row(static_cast<int>(r));
        std::fill_n(row, cols, 0.0F);
        for (int k = -radius; k <= radius; ++k) {
          const float weight = kernel[static_cast<std::size_t>(k + radius)];
          const float* other = source.row(std::clamp(static_cast<int>(r) + k, 0, rows - 1));
          for (int c = 0; c < cols; ++c) row[c] += weight * other[c];
        }
      },
      16);
}

float sampleRaster(const Raster<float>& raster, float col, float row) {
  return cellsClamped<float>(raster.rows(), raster.cols(), col, row).mean(raster);
}

}  // namespace agricolmap::simulate
