#include "experiments/methods/features/brief.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/core/random.hpp"

namespace agricolmap::experiments {
namespace {

/// Sums `kernel` along rows or columns; pixels outside are those of the rim.
Raster<float> convolved(const Raster<float>& from, const std::vector<float>& kernel,
                        bool along_row) {
  const int half = static_cast<int>(kernel.size()) / 2;
  Raster<float> to(from.rows(), from.cols());
  for (int r = 0; r < from.rows(); ++r) {
    for (int c = 0; c < from.cols(); ++c) {
      float sum = 0.0F;
      for (int k = -half; k <= half; ++k) {
        const int row = along_row ? r : std::clamp(r + k, 0, from.rows() - 1);
        const int col = along_row ? std::clamp(c + k, 0, from.cols() - 1) : c;
        sum += kernel[static_cast<std::size_t>(k + half)] * from(row, col);
      }
      to(r, c) = sum;
    }
  }
  return to;
}

}  // namespace

Brief::Brief(const BriefOptions& options) : options_(options) {
  Random random(static_cast<std::uint64_t>(options.seed));
  const int half = options.patch / 2;
  const double sigma = options.patch / 5.0;
  const auto draw = [&] {
    return std::clamp(static_cast<int>(std::lround(random.normal(sigma))), -half, half);
  };
  for (Test& test : tests_) {
    do {
      test.row_a = draw();
      test.col_a = draw();
      test.row_b = draw();
      test.col_b = draw();
    } while (test.row_a == test.row_b && test.col_a == test.col_b);
  }
}

Raster<std::uint8_t> Brief::smoothed(const Raster<std::uint8_t>& picture) const {
  const int half = options_.kernel / 2;
  std::vector<float> kernel;
  float total = 0.0F;
  for (int k = -half; k <= half; ++k) {
    kernel.push_back(
        static_cast<float>(std::exp(-0.5 * k * k / (options_.sigma * options_.sigma))));
    total += kernel.back();
  }
  for (float& value : kernel) value /= total;
  Raster<float> grey(picture.rows(), picture.cols());
  std::copy(picture.begin(), picture.end(), grey.begin());
  grey = convolved(convolved(grey, kernel, true), kernel, false);
  Raster<std::uint8_t> smooth(picture.rows(), picture.cols());
  for (std::size_t i = 0; i < grey.size(); ++i) {
    smooth[i] = static_cast<std::uint8_t>(std::lround(std::clamp(grey[i], 0.0F, 255.0F)));
  }
  return smooth;
}

std::array<std::uint8_t, Brief::kBytes> Brief::describe(const Raster<std::uint8_t>& smooth, int row,
                                                        int col) const {
  const auto at = [&](int r, int c) {
    return smooth(std::clamp(row + r, 0, smooth.rows() - 1),
                  std::clamp(col + c, 0, smooth.cols() - 1));
  };
  std::array<std::uint8_t, kBytes> bits{};
  for (std::size_t k = 0; k < tests_.size(); ++k) {
    const Test& test = tests_[k];
    if (at(test.row_a, test.col_a) < at(test.row_b, test.col_b)) {
      bits[k / 8] = static_cast<std::uint8_t>(bits[k / 8] | (1U << (k % 8)));
    }
  }
  return bits;
}

}  // namespace agricolmap::experiments
