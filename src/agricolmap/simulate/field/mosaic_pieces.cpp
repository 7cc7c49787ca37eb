#include "agricolmap/simulate/field/mosaic_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/field/noise.hpp"

namespace agricolmap::simulate {

namespace {

MosaicPiece drawPiece(const MosaicOptions& options, int row, int col, std::uint64_t seed) {
  Random random(hashBits(seed, row, col));
  MosaicPiece piece;
  // Within the middle of its square, so that the nearest is in this square or beside it.
  piece.centre = options.piece * Eigen::Vector2d(col - 1 + random.uniform(0.15, 0.85),
                                                 row - 1 + random.uniform(0.15, 0.85));
  piece.shift << random.normal(options.shift), random.normal(options.shift);
  for (double& entry : piece.shear.reshaped()) entry = random.normal(options.shear);
  piece.blur = static_cast<float>(random.uniform());
  piece.exposure = static_cast<float>(std::exp(random.normal(options.exposure)));
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  if (random.chance(options.doubled)) {
    piece.doubled = options.doubled_shift * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return piece;
}

}  // namespace

MosaicPieces::MosaicPieces(const MosaicOptions& options, const Eigen::Vector2d& field_size,
                           std::uint64_t seed)
    : side_(options.piece) {
  if (!options.any()) return;
  pieces_ = Raster<MosaicPiece>(static_cast<int>(field_size.y() / side_) + 3,
                                static_cast<int>(field_size.x() / side_) + 3);
  for (int r = 0; r < pieces_.rows(); ++r) {
    for (int c = 0; c < pieces_.cols(); ++c) pieces_(r, c) = drawPiece(options, r, c, seed);
  }
}

const MosaicPiece& MosaicPieces::at(const Eigen::Vector2d& place) const {
  const int row =
      std::clamp(static_cast<int>(std::floor(place.y() / side_)) + 1, 1, pieces_.rows() - 2);
  const int col =
      std::clamp(static_cast<int>(std::floor(place.x() / side_)) + 1, 1, pieces_.cols() - 2);
  const MosaicPiece* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = col - 1; c <= col + 1; ++c) {
      const double distance = (pieces_(r, c).centre - place).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      nearest = &pieces_(r, c);
    }
  }
  return *nearest;
}

}  // namespace agricolmap::simulate
