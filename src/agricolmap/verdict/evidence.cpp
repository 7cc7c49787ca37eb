#include "agricolmap/verdict/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "agricolmap/core/parabola.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::verdict {

void listOptions(OptionTable& table, EvidenceOptions& options) {
  table.number("block", options.block, 0.2, 100.0, "m", "side of the blocks that are placed alone");
  table.number("block_reach", options.block_reach, 0.05, 100.0, "m",
               "how far from its predicted place a block is looked for");
  table.number("agreement", options.agreement, 0.01, 100.0, "m",
               "a block agrees when its best place is this near to the predicted one");
  table.number("exclusion", options.exclusion, 0.01, 100.0, "m",
               "other peaks are counted from this distance on");
}

namespace {

/// What decoys hardly ever surpass, for a place that was not measured against them.
constexpr double kHighestDecoy = 8.0;
/// Where a tight guess leaves nothing else in reach, a place is compared with what chance gives at
/// one: the refinement turns six parameters until the score is highest, and the square of that of
/// noise is as large as they are many.
constexpr double kHighestByFreedom = 2.45;  // the root of six
constexpr double kMinSeenShare = 0.3;       // of a block's area, in both maps
/// As many blocks as a share of agreeing ones needs to mean something, and their least side [m]:
/// smaller ones hold too little to be placed alone.
constexpr double kFewestBlocks = 12.0;
constexpr double kLeastBlock = 0.6;

/// Whether a map has seen enough of the square of half a side `half` around a cell.
bool seenAround(const map::SignalMap& map, const Eigen::Vector2d& at, double half) {
  double looked = 0.0;
  double seen = 0.0;
  for (int r = static_cast<int>(at.y() - half); r <= static_cast<int>(at.y() + half); ++r) {
    for (int c = static_cast<int>(at.x() - half); c <= static_cast<int>(at.x() + half); ++c) {
      looked += 1.0;
      if (map.weight.contains(r, c) && map.weight(r, c) > 0.0F) seen += 1.0;
    }
  }
  return seen >= kMinSeenShare * looked;
}

/// Nothing where too little of the block is seen in either map.
std::optional<BlockEvidence> placeBlock(const correlation::StripScore& score,
                                        const map::Block& block, const Eigen::Affine2d& pose,
                                        const EvidenceOptions& options) {
  const GridFrame& frame = score.fixed().frame;
  const map::StripFrame& strip = score.strip();
  const double cell = frame.cell;
  const correlation::Template piece = correlation::makeTemplate(
      score.moving(), block.centre, pose.linear(), boundsOf(block, strip), cell, score.options(),
      [&](const Eigen::Vector2d& p) { return block.contains(strip.local(p)); });
  BlockEvidence evidence;
  evidence.moving = block.centre;
  evidence.place = pose * block.centre;
  const Eigen::Vector2d at = frame.cellOf(evidence.place);
  const Eigen::Vector2d size = (block.high - block.low) / cell;
  const double area = size.prod() * std::abs(pose.linear().determinant());
  if (piece.filled < kMinSeenShare * area || !seenAround(score.fixed(), at, 0.5 * size.norm())) {
    return std::nullopt;
  }
  const int reach = static_cast<int>(std::ceil(options.block_reach / cell));
  const Raster<float> scores = score.around(piece, at, reach);
  // The scores' middle is the whole cell nearest to the predicted place.
  const Eigen::Vector2d rounding = at.array().round().matrix() - at;
  int best_row = reach, best_col = reach;
  for (int r = 0; r < scores.rows(); ++r) {
    for (int c = 0; c < scores.cols(); ++c) {
      if (std::hypot(r - reach, c - reach) * cell > options.block_reach) continue;
      if (scores(r, c) > scores(best_row, best_col)) best_row = r, best_col = c;
    }
  }
  Eigen::Vector2d peak(best_col - reach, best_row - reach);
  if (best_row > 0 && best_row + 1 < scores.rows() && best_col > 0 &&
      best_col + 1 < scores.cols()) {
    const auto at_peak = [&](int dr, int dc) {
      return static_cast<double>(scores(best_row + dr, best_col + dc));
    };
    peak.x() += parabolaVertex(at_peak(0, -1), at_peak(0, 0), at_peak(0, 1));
    peak.y() += parabolaVertex(at_peak(-1, 0), at_peak(0, 0), at_peak(1, 0));
  }
  evidence.offset = cell * (peak + rounding);
  evidence.agrees = evidence.offset.norm() <= options.agreement;
  return evidence;
}

}  // namespace

double Evidence::decoyRatio() const {
  if (decoys.empty()) return significance / kHighestDecoy;
  return significance / std::max(1.0, *std::max_element(decoys.begin(), decoys.end()));
}

void discountFreedom(Evidence& evidence, double before, double freedom) {
  const double square = evidence.significance * evidence.significance - freedom;
  const double sure = std::max(before, std::sqrt(std::max(0.0, square)));
  if (!(sure < evidence.significance)) return;
  evidence.uniqueness *= sure / evidence.significance;
  evidence.significance = sure;
}

double blockSide(const map::StripFrame& strip, const EvidenceOptions& options) {
  const double area = 4.0 * strip.half_extent.prod();
  return std::clamp(std::sqrt(area / kFewestBlocks), std::min(kLeastBlock, options.block),
                    options.block);
}

Evidence measureEvidence(const correlation::StripScore& score, const Eigen::Affine2d& pose,
                         const SearchSpace& space, double rival, const EvidenceOptions& options) {
  const map::StripFrame& strip = score.strip();
  Evidence evidence;
  // The shifts that the guess allows, about where it puts the strip's middle.
  const correlation::ScorePeaks peaks =
      score.peaks(pose, strip.centre, space.uncertainty.translation, options.exclusion);
  evidence.significance = peaks.significance;
  evidence.uniqueness = peaks.significance / std::max({peaks.other, rival, kHighestByFreedom});
  evidence.strip = strip;
  evidence.block_side = blockSide(strip, options);
  const std::vector<map::Block> blocks = map::cutBlocks(score.moving(), strip, evidence.block_side);
  if (!blocks.empty()) evidence.block_size = blocks.front().high - blocks.front().low;
  std::vector<std::optional<BlockEvidence>> placed(blocks.size());
  parallelFor(blocks.size(),
              [&](std::size_t i) { placed[i] = placeBlock(score, blocks[i], pose, options); });
  for (const std::optional<BlockEvidence>& block : placed) {
    if (!block) continue;
    evidence.blocks.push_back(*block);
    if (block->agrees) ++evidence.agreeing;
  }
  evidence.parts = findDisplacedParts(score, pose);
  evidence.parts.turn = space.turn;
  return evidence;
}

}  // namespace agricolmap::verdict
