// What flights have and the presets have not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "agricolmap/simulate/field/mosaic_pieces.hpp"
#include "agricolmap/simulate/test_support.hpp"

namespace agricolmap::simulate {
namespace {

TEST(Mosaic, OfOnePieceIsAsItWas) {
  const MosaicPieces one(MosaicOptions{}, {20.0, 20.0}, 3);
  EXPECT_FALSE(one.any());
  EXPECT_TRUE(one.displacement({4.0, 5.0}).isZero());
}

TEST(Mosaic, PiecesAreOffByWhatWasAsked) {
  MosaicOptions options;
  options.shift = 0.05;
  const MosaicPieces pieces(options, {200.0, 200.0}, 3);
  double sum2 = 0.0;
  std::set<double> shifts;
  for (double x = -5.0; x < 205.0; x += 1.0) {
    for (double y = -5.0; y < 205.0; y += 1.0) {
      const Eigen::Vector2d off = pieces.displacement({x, y});
      shifts.insert(off.x());
      sum2 += off.squaredNorm() / (2.0 * 210.0 * 210.0);
    }
  }
  EXPECT_NEAR(std::sqrt(sum2), 0.05, 0.008);
  EXPECT_NEAR(static_cast<double>(shifts.size()), std::pow(200.0 / options.piece, 2), 200.0);
}

TEST(Mosaic, TruthIsWhereThePiecesShowIt) {
  SimulationOptions options = smallOptions();
  options.ugv.drift = 0.0;
  options.views.leaf_unshared = 0.0;
  const SimulatedPair whole = simulatePair(options);
  options.uav.mosaic.piece = 2.0;
  options.uav.mosaic.shift = 0.10;
  const SimulatedPair pieced = simulatePair(options);
  EXPECT_EQ(pieced.ugv.xyz, whole.ugv.xyz);
  EXPECT_GT(rms(pieced, pieced.nominal), 0.05);
  EXPECT_GT(correlation(pieced, options), correlation(whole, options) - 0.1);
  SimulatedPair wrong = pieced;
  wrong.truth = whole.truth;
  EXPECT_LT(correlation(wrong, options), correlation(pieced, options) - 0.2);
}

TEST(Mosaic, PiecesMayBeSoftDoubledOrBright) {
  SimulationOptions options = smallOptions();
  options.uav.colour.noise = 0.0;
  const auto contrastOf = [&]() {
    const SimulatedPair pair = simulatePair(options);
    const StripMap map = mapFromAbove(pair, options);
    double sum = 0.0;
    for (int r = 0; r < map.rows; ++r) {
      for (int c = 1; c < map.cols; ++c) {
        if (map.count(r, c) == 0.0F || map.count(r, c - 1) == 0.0F) continue;
        sum += std::pow(static_cast<double>(map.grey(r, c) - map.grey(r, c - 1)), 2);
      }
    }
    return sum;
  };
  const double sharp = contrastOf();
  options.uav.mosaic.blur = 6.0;
  EXPECT_LT(contrastOf(), 0.85 * sharp);
  options.uav.mosaic.blur = 0.0;
  options.uav.mosaic.doubled = 1.0;
  options.uav.mosaic.doubled_shift = 0.15;
  EXPECT_LT(contrastOf(), 0.9 * sharp);
  options.uav.mosaic.doubled = 0.0;
  options.uav.mosaic.exposure = 0.3;
  options.uav.mosaic.piece = 3.0;
  const MosaicPieces pieces(options.uav.mosaic, {6.0, 6.0}, 1);
  EXPECT_NE(pieces.at({0.5, 0.5}).exposure, pieces.at({5.5, 5.5}).exposure);
}

}  // namespace
}  // namespace agricolmap::simulate
