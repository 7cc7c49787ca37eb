#include "agricolmap/verdict/slip.hpp"

#include <Eigen/QR>
#include <limits>

namespace agricolmap::verdict {
namespace {

/// Slices on either side that a slip needs to be told from what one slice is off by.
constexpr std::size_t kLeastSide = 2;
constexpr std::size_t kLeastSlices = 6;
/// Squares that a slip must explain, of those of the offsets.
constexpr double kExplained = 0.5;

}  // namespace

std::optional<Compromise> largerPart(const std::vector<SliceOffset>& slices) {
  const std::size_t count = slices.size();
  if (count < kLeastSlices) return std::nullopt;
  Eigen::MatrixX2d offsets(count, 2);
  for (std::size_t i = 0; i < count; ++i) {
    offsets.row(static_cast<Eigen::Index>(i)) = slices[i].offset.transpose();
  }
  double least = (1.0 - kExplained) * offsets.squaredNorm();
  std::optional<Compromise> best;
  for (std::size_t behind = kLeastSide; behind + kLeastSide <= count; ++behind) {
    // The larger part is what the affine is of; the smaller one has a shift more.
    const bool larger_first = 2 * behind >= count;
    Eigen::MatrixX3d terms(count, 3);
    for (std::size_t i = 0; i < count; ++i) {
      const bool slipped = (i >= behind) == larger_first;
      terms.row(static_cast<Eigen::Index>(i)) << 1.0, slices[i].along, slipped ? 1.0 : 0.0;
    }
    const Eigen::Matrix<double, 3, 2> fit = terms.colPivHouseholderQr().solve(offsets);
    const double left = (offsets - terms * fit).squaredNorm();
    if (left >= least) continue;
    least = left;
    best = Compromise{fit.row(0).transpose(), fit.row(1).transpose()};
  }
  return best;
}

}  // namespace agricolmap::verdict
