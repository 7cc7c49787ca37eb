#include "agricolmap/correlation/whitening.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "agricolmap/core/random.hpp"
#include "agricolmap/correlation/matched_filter.hpp"

namespace agricolmap::correlation {
namespace {

constexpr double kCell = 0.1;
constexpr double kRowWavelength = 5.0;  // cells

/// Strong rows along the columns and weak noise, in both channels; `holes` are not seen.
map::SignalMap rowsAndNoise(int size, bool holes) {
  map::SignalMap map;
  map.frame.cell = kCell;
  map.frame.rows = size;
  map.frame.cols = size;
  map.weight = Raster<float>(size, size);
  for (auto& channel : map.channel) channel = Raster<float>(size, size);
  Random random(7);
  for (int r = 0; r < size; ++r) {
    for (int c = 0; c < size; ++c) {
      const double row = std::sin(2.0 * std::numbers::pi * r / kRowWavelength);
      const bool seen = !holes || std::hypot(r - size / 2.0, c - size / 2.0) > size / 6.0;
      map.weight(r, c) = seen ? 1.0F : 0.0F;
      for (auto& channel : map.channel) {
        const double noise = random.normal();
        channel(r, c) = seen ? static_cast<float>(row + 0.3 * noise) : 0.0F;
      }
    }
  }
  return map;
}

/// Mean amplitude of the rows' wave in the cells that `chosen` names.
template <typename Chosen>
double rowsLeft(const std::vector<float>& values, int stride, int size, const Chosen& chosen) {
  double along = 0.0, across = 0.0, power = 0.0;
  for (int r = 0; r < size; ++r) {
    for (int c = 0; c < size; ++c) {
      if (!chosen(r, c)) continue;
      const auto v = static_cast<double>(values[static_cast<std::size_t>(r) * stride + c]);
      const double angle = 2.0 * std::numbers::pi * r / kRowWavelength;
      along += v * std::cos(angle);
      across += v * std::sin(angle);
      power += v * v;
    }
  }
  return std::hypot(along, across) / std::sqrt(power);  // of noise alone: about 1
}

TEST(Whitening, TakesRowsOutUpToTheEdgesAndAroundHoles) {
  constexpr int kSize = 120;
  for (const bool holes : {false, true}) {
    const map::SignalMap map = rowsAndNoise(kSize, holes);
    const Fft2 fft(Fft2::goodSize(kSize + 10), Fft2::goodSize(kSize + 10));
    const ComplexRaster white = whitenedMap(map, {0, 1}, fft, 0.4);
    const auto edge = [](int r, int) { return r < 10 || r >= kSize - 10; };
    const auto middle = [](int r, int c) {
      return std::abs(r - kSize / 2) < 30 && std::abs(c - kSize / 2) < 30;
    };
    std::vector<float> raw(map.channel[0].begin(), map.channel[0].end());
    EXPECT_GT(rowsLeft(raw, kSize, kSize, edge), 20.0);
    EXPECT_LT(rowsLeft(white.re, fft.cols(), kSize, edge), 4.0) << "holes " << holes;
    EXPECT_LT(rowsLeft(white.im, fft.cols(), kSize, edge), 4.0) << "holes " << holes;
    EXPECT_LT(rowsLeft(white.re, fft.cols(), kSize, middle), 4.0) << "holes " << holes;
  }
}

TEST(Whitening, CellsThatWereNotSeenStayZero) {
  const map::SignalMap map = rowsAndNoise(60, true);
  const Fft2 fft(64, 64);
  const ComplexRaster white = whitenedMap(map, {0, 1}, fft, 0.4);
  EXPECT_EQ(white.re[30 * 64 + 30], 0.0F);
  EXPECT_EQ(white.im[62 * 64 + 3], 0.0F);
  EXPECT_NE(white.re[3 * 64 + 3], 0.0F);
}

TEST(Whitening, AnEmptyMapStaysEmpty) {
  map::SignalMap map = rowsAndNoise(30, false);
  std::fill(map.weight.begin(), map.weight.end(), 0.0F);
  for (auto& channel : map.channel) std::fill(channel.begin(), channel.end(), 0.0F);
  const ComplexRaster white = whitenedMap(map, {0, 1}, Fft2(32, 32), 0.4);
  for (const float v : white.re) ASSERT_EQ(v, 0.0F);
}

TEST(MatchedFilter, DeviationIsThatOfTheScores) {
  const map::SignalMap map = rowsAndNoise(60, true);
  const MatchedFilter filter(map, {}, 3);
  Template piece;
  piece.first_row = -4;
  piece.first_col = -6;
  Random random(3);
  for (Raster<float>& channel : piece.channel) {
    channel = Raster<float>(9, 13);
    for (float& v : channel) v = static_cast<float>(random.normal());
  }
  MatchedFilter::Work work(filter);
  ComplexRaster surface(filter.fft().size());
  filter.correlate(piece, surface, work);
  double sum2 = 0.0;
  for (const float v : surface.re) sum2 += static_cast<double>(v) * static_cast<double>(v);
  const double expected = std::sqrt(sum2 / static_cast<double>(surface.size()));
  EXPECT_NEAR(filter.deviation(piece, work), expected, 1e-3 * expected);
}

}  // namespace
}  // namespace agricolmap::correlation
