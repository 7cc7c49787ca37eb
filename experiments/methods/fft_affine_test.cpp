// FFT correlation and dense refinement without what the product adds.
#include <gtest/gtest.h>

#include "agricolmap/core/random.hpp"
#include "experiments/methods/plain_correlation.hpp"
#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

TEST(PlainCorrelation, FindsWhereAPieceWasCut) {
  map::SignalMap map;
  map.frame.cell = 0.1;
  map.frame.rows = 40;
  map.frame.cols = 50;
  map.weight = Raster<float>(40, 50, 1.0F);
  map.channel[0] = Raster<float>(40, 50);
  Random random(3);
  for (float& value : map.channel[0]) value = static_cast<float>(random.normal());
  PlainCorrelation::Piece piece;
  piece.first_row = -3;
  piece.first_col = -5;
  piece.value = Raster<float>(8, 11);
  piece.seen = Raster<float>(8, 11, 1.0F);
  for (int r = 0; r < 8; ++r) {
    for (int c = 0; c < 11; ++c) piece.value(r, c) = map.channel[0](20 - 3 + r, 30 - 5 + c);
  }
  const PlainCorrelation correlation(map, 8, 11, 0.5);
  const PlainCorrelation::Peak peak = correlation.best(piece, map.frame.centre(20, 28), 1.0);
  EXPECT_NEAR((peak.anchor - map.frame.centre(20, 30)).norm(), 0.0, 1e-9);
  EXPECT_GT(peak.correlation, 0.9);
  EXPECT_LT(peak.correlation, 1.2);
  // Out of reach, another place is named, with less confidence.
  EXPECT_LT(correlation.best(piece, map.frame.centre(10, 10), 0.5).score, 0.5 * peak.score);
}

PriorUncertainty somePrior() {
  PriorUncertainty prior;
  prior.translation = 2.0;
  prior.heading_deg = 6.0;
  prior.scale = 0.10;
  return prior;
}

testing::GuessError someError() {
  testing::GuessError error;
  error.shift = {1.2, -0.9};
  error.heading = 0.06;
  error.scale = {1.06, 0.95};
  return error;
}

TEST(FftAffine, IsRightFromAfar) {
  testing::expectRight(makeMethod("fft-affine"), someError(), somePrior());
}

TEST(FftAffine, FailsOnEmptyMaps) { testing::expectFailsOnEmptyMaps(makeMethod("fft-affine")); }

}  // namespace
}  // namespace agricolmap::experiments
