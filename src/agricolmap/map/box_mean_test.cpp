#include "agricolmap/map/box_mean.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/random.hpp"

namespace agricolmap::map {
namespace {

TEST(BoxMean, IsTheWeightedMeanOfTheSquareAround) {
  constexpr int kRows = 9, kCols = 14, kRadius = 2;
  Random random(4);
  Raster<float> value(kRows, kCols), weight(kRows, kCols);
  for (std::size_t i = 0; i < value.size(); ++i) {
    value[i] = static_cast<float>(random.uniform(-1.0, 1.0));
    weight[i] = random.chance(0.6) ? static_cast<float>(random.uniform(0.1, 1.0)) : 0.0F;
  }
  const BoxMean box(weight, kRadius);
  const Raster<float> mean = box.of(value);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      double sum = 0.0, norm = 0.0;
      for (int i = r - kRadius; i <= r + kRadius; ++i) {
        for (int j = c - kRadius; j <= c + kRadius; ++j) {
          if (!weight.contains(i, j)) continue;
          sum += static_cast<double>(weight(i, j) * value(i, j));
          norm += static_cast<double>(weight(i, j));
        }
      }
      EXPECT_NEAR(mean(r, c), sum / norm, 1e-5) << r << ", " << c;
    }
  }
}

TEST(BoxMean, IsNoneWhereNothingWeighs) {
  const Raster<float> nothing(6, 6), value(6, 6, 3.0F);
  for (const float mean : BoxMean(nothing, 1).of(value)) EXPECT_EQ(mean, 0.0F);
}

}  // namespace
}  // namespace agricolmap::map
