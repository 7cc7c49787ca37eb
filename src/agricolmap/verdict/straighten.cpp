#include "agricolmap/verdict/straighten.hpp"

#include <vector>

#include "agricolmap/core/scaled_rotation.hpp"

namespace agricolmap::verdict {
namespace {

/// Blocks whose middles are no further apart, in sides, are neighbours: also across a corner.
constexpr double kNeighbours = 1.6;
/// Neighbours of a bent strip are displaced alike to so much [m]. By chance one block in sixteen
/// is, of those looked for within half a metre; a scale that is a tenth off displaces them so, too.
constexpr double kAlike = 0.2;
constexpr std::size_t kLeastNeighbours = 2;
/// So many blocks must disagree alike, and so many be coherent in all.
constexpr std::size_t kLeastBent = 2;
constexpr std::size_t kLeastCoherent = 6;

/// Whether more than half of its neighbours are displaced like it.
bool fitsNeighbours(const Evidence& evidence, std::size_t i) {
  const BlockEvidence& block = evidence.blocks[i];
  std::size_t neighbours = 0;
  std::size_t alike = 0;
  for (std::size_t j = 0; j < evidence.blocks.size(); ++j) {
    const BlockEvidence& other = evidence.blocks[j];
    if (j == i || (other.moving - block.moving).norm() > kNeighbours * evidence.block_side) {
      continue;
    }
    ++neighbours;
    if ((other.offset - block.offset).norm() <= kAlike) ++alike;
  }
  return alike >= kLeastNeighbours && 2 * alike > neighbours;
}

}  // namespace

std::optional<Eigen::Affine2d> straightenedPose(const Evidence& evidence,
                                                const Eigen::Matrix2d& scale_axes) {
  std::vector<Match> matches;
  std::size_t bent = 0;
  for (std::size_t i = 0; i < evidence.blocks.size(); ++i) {
    if (!fitsNeighbours(evidence, i)) continue;
    const BlockEvidence& block = evidence.blocks[i];
    if (!block.agrees) ++bent;
    matches.push_back({block.moving, block.place + block.offset});
  }
  if (bent < kLeastBent || matches.size() < kLeastCoherent) return std::nullopt;
  const auto fit = fitScaledRotation(matches, {}, orthonormalAxes(scale_axes));
  if (!fit) return std::nullopt;
  return fit->fixed_from_moving;
}

}  // namespace agricolmap::verdict
