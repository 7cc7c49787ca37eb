#include "agricolmap/correlation/fft.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "agricolmap/core/random.hpp"

namespace agricolmap::correlation {
namespace {

TEST(Fft, GoodSizes) {
  EXPECT_EQ(Fft2::goodSize(1), 1);
  EXPECT_EQ(Fft2::goodSize(7), 8);
  EXPECT_EQ(Fft2::goodSize(121), 125);
}

TEST(Fft, MatchesTheDefinition) {
  for (const auto& [rows, cols] : {std::pair{4, 6}, {5, 9}, {8, 15}, {1, 12}, {30, 2}}) {
    Random random(5);
    const Fft2 fft(rows, cols);
    ComplexRaster data(fft.size()), scratch(fft.size());
    for (std::size_t i = 0; i < data.size(); ++i) {
      data.re[i] = static_cast<float>(random.normal());
      data.im[i] = static_cast<float>(random.normal());
    }
    const ComplexRaster original = data;
    fft.forward(data, scratch);
    for (int u = 0; u < rows; ++u) {
      for (int v = 0; v < cols; ++v) {
        std::complex<double> sum = 0.0;
        for (int r = 0; r < rows; ++r) {
          for (int c = 0; c < cols; ++c) {
            const auto i = static_cast<std::size_t>(r * cols + c);
            const double angle =
                -2.0 * std::numbers::pi *
                (static_cast<double>(u * r) / rows + static_cast<double>(v * c) / cols);
            sum += std::complex<double>(original.re[i], original.im[i]) * std::polar(1.0, angle);
          }
        }
        const auto i = static_cast<std::size_t>(v * rows + u);
        ASSERT_NEAR(data.re[i], sum.real(), 1e-4) << rows << "x" << cols;
        ASSERT_NEAR(data.im[i], sum.imag(), 1e-4);
      }
    }
    fft.inverse(data, scratch);
    for (std::size_t i = 0; i < data.size(); ++i) {
      ASSERT_NEAR(data.re[i], original.re[i], 1e-5);
      ASSERT_NEAR(data.im[i], original.im[i], 1e-5);
    }
  }
}

TEST(Fft, APieceIsTransformedAsTheWhole) {
  const int rows = 20, cols = 12, width = 5, first_col = -2;
  const Fft2 fft(rows, cols);
  Random random(6);
  ComplexRaster whole(fft.size()), scratch(fft.size()), spectrum(fft.size());
  ComplexRaster piece(static_cast<std::size_t>(rows * width)), small(piece.size());
  for (int r = 3; r < 9; ++r) {
    for (int c = 0; c < width; ++c) {
      const auto i = static_cast<std::size_t>(r * width + c);
      const auto j = static_cast<std::size_t>(r * cols + (first_col + c + cols) % cols);
      whole.re[j] = piece.re[i] = static_cast<float>(random.normal());
      whole.im[j] = piece.im[i] = static_cast<float>(random.normal());
    }
  }
  fft.forward(whole, scratch);
  fft.forwardPiece(piece, small, width, first_col, spectrum, scratch);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_NEAR(spectrum.re[i], whole.re[i], 1e-4);
    ASSERT_NEAR(spectrum.im[i], whole.im[i], 1e-4);
  }
}

}  // namespace
}  // namespace agricolmap::correlation
