#include "agricolmap/verdict/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr double kMinSeenShare = 0.3;  // of a block's area, in both maps
/// As many blocks as a share of agreeing ones needs to mean something, and their least side [m]:
/// smaller ones hold too little to be placed alone.
constexpr double kFewestBlocks = 12.0;
constexpr double kLeastBlock = 0.6;
/// Around a pose the highest score of the nearest whole cells counts: at most this far [cells].
constexpr int kPeakReach = 1;
/// A part of the strip that is smaller than this is judged as if it were as large.
constexpr double kLeastInside = 0.2;

double surfaceDeviation(const correlation::ComplexRaster& surface) {
  double sum2 = 0.0;
  for (const float v : surface.re) sum2 += static_cast<double>(v) * static_cast<double>(v);
  return std::sqrt(sum2 / static_cast<double>(surface.size()));
}

}  // namespace

double blockSide(const map::StripFrame& strip, const EvidenceOptions& options) {
  const double area = 4.0 * strip.half_extent.prod();
  return std::clamp(std::sqrt(area / kFewestBlocks), std::min(kLeastBlock, options.block),
                    options.block);
}

EvidenceMeter::EvidenceMeter(const map::SignalMap& fixed, const map::SignalMap& moving,
                             const EvidenceOptions& options)
    : moving_(moving),
      fixed_(fixed),
      options_(options),
      filter_(fixed, options.filter),
      strip_(map::stripFrame(moving)) {}

correlation::Template EvidenceMeter::wholeTemplate(const Eigen::Affine2d& pose) const {
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& corner : strip_.corners()) bounds.extend(corner);
  return correlation::makeTemplate(moving_, strip_.centre, pose.linear(), bounds, fixed_.frame.cell,
                                   options_.filter.height_weight,
                                   [](const Eigen::Vector2d&) { return true; });
}

double EvidenceMeter::significance(const correlation::Template& piece, double deviation,
                                   const Eigen::Affine2d& pose) const {
  if (deviation <= 0.0) return 0.0;
  const Eigen::Vector2d at = fixed_.frame.cellOf(pose * strip_.centre);
  const int row0 = static_cast<int>(std::lround(at.y())) + piece.first_row;
  const int col0 = static_cast<int>(std::lround(at.x())) + piece.first_col;
  double energy = 0.0;
  double inside = 0.0;
  for (int r = 0; r < piece.re.rows(); ++r) {
    for (int c = 0; c < piece.re.cols(); ++c) {
      const float cell = piece.re(r, c) * piece.re(r, c) + piece.im(r, c) * piece.im(r, c);
      energy += static_cast<double>(cell);
      if (!fixed_.weight.contains(row0 + r, col0 + c)) continue;
      if (fixed_.weight(row0 + r, col0 + c) > 0.0F) inside += static_cast<double>(cell);
    }
  }
  if (inside <= 0.0) return 0.0;
  const Raster<float> scores = blockScores(piece, at, kPeakReach);
  double highest = -std::numeric_limits<double>::infinity();
  for (const float score : scores) highest = std::max(highest, static_cast<double>(score));
  return highest / (deviation * std::sqrt(std::max(kLeastInside, inside / energy)));
}

double EvidenceMeter::significance(const Eigen::Affine2d& pose) const {
  const correlation::Template piece = wholeTemplate(pose);
  correlation::MatchedFilter::Work work(filter_);
  return significance(piece, filter_.deviation(piece, work), pose);
}

double EvidenceMeter::highestOther(const correlation::ComplexRaster& surface,
                                   const Eigen::Vector2d& centre, double radius,
                                   const Eigen::Vector2d& peak) const {
  const GridFrame& frame = fixed_.frame;
  const auto within = [](double at, int count) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(count - 1)));
  };
  const int r0 = within(std::floor(centre.y() - radius), frame.rows);
  const int r1 = within(std::ceil(centre.y() + radius), frame.rows);
  const int c0 = within(std::floor(centre.x() - radius), frame.cols);
  const int c1 = within(std::ceil(centre.x() + radius), frame.cols);
  const double exclusion = options_.exclusion / frame.cell;
  double highest = -std::numeric_limits<double>::infinity();
  for (int r = r0; r <= r1; ++r) {
    const float* scores = surface.re.data() + static_cast<std::size_t>(r) * filter_.fft().cols();
    for (int c = c0; c <= c1; ++c) {
      const Eigen::Vector2d at(c, r);
      if ((at - centre).norm() > radius || (at - peak).norm() <= exclusion) continue;
      highest = std::max(highest, static_cast<double>(scores[c]));
    }
  }
  return highest;
}

double EvidenceMeter::distance(const Eigen::Affine2d& a, const Eigen::Affine2d& b) const {
  double largest = 0.0;
  for (const Eigen::Vector2d& corner : strip_.corners()) {
    largest = std::max(largest, (a * corner - b * corner).norm());
  }
  return largest;
}

Raster<float> EvidenceMeter::blockScores(const correlation::Template& piece,
                                         const Eigen::Vector2d& at, int reach) const {
  const Raster<float>& green = filter_.whitenedGreenness();
  const Raster<float>& high = filter_.whitenedHeight();
  Raster<float> scores(2 * reach + 1, 2 * reach + 1);
  const int row0 = static_cast<int>(std::lround(at.y())) + piece.first_row - reach;
  const int col0 = static_cast<int>(std::lround(at.x())) + piece.first_col - reach;
  for (int r = 0; r < piece.re.rows(); ++r) {
    for (int c = 0; c < piece.re.cols(); ++c) {
      const float g = piece.re(r, c);
      const float h = piece.im(r, c);
      if (g == 0.0F && h == 0.0F) continue;
      for (int dr = 0; dr < scores.rows(); ++dr) {
        const int row = row0 + r + dr;
        if (row < 0 || row >= fixed_.frame.rows) continue;
        const int first = std::max(0, -(col0 + c));
        const int last = std::min(scores.cols(), fixed_.frame.cols - (col0 + c));
        const float* from_green = green.row(row) + col0 + c;
        const float* from_high = high.row(row) + col0 + c;
        float* to = scores.row(dr);
        for (int dc = first; dc < last; ++dc) to[dc] += g * from_green[dc] + h * from_high[dc];
      }
    }
  }
  return scores;
}

BlockEvidence EvidenceMeter::placeBlock(const map::Block& block, const Eigen::Affine2d& pose,
                                        bool& usable) const {
  const double cell = fixed_.frame.cell;
  const correlation::Template piece = correlation::makeTemplate(
      moving_, block.centre, pose.linear(), boundsOf(block, strip_), cell,
      options_.filter.height_weight,
      [&](const Eigen::Vector2d& p) { return block.contains(strip_.local(p)); });
  BlockEvidence evidence;
  evidence.moving = block.centre;
  evidence.place = pose * block.centre;
  const Eigen::Vector2d at = fixed_.frame.cellOf(evidence.place);
  const Eigen::Vector2d size = (block.high - block.low) / cell;
  const double area = size.prod() * std::abs(pose.linear().determinant());
  usable = piece.filled >= kMinSeenShare * area && seenAround(at, 0.5 * size.norm());
  if (!usable) return evidence;
  const int reach = static_cast<int>(std::ceil(options_.block_reach / cell));
  const Raster<float> scores = blockScores(piece, at, reach);
  // The scores' middle is the whole cell nearest to the predicted place.
  const Eigen::Vector2d rounding = at.array().round().matrix() - at;
  int best_row = reach, best_col = reach;
  for (int r = 0; r < scores.rows(); ++r) {
    for (int c = 0; c < scores.cols(); ++c) {
      if (std::hypot(r - reach, c - reach) * cell > options_.block_reach) continue;
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
  evidence.agrees = evidence.offset.norm() <= options_.agreement;
  return evidence;
}

bool EvidenceMeter::seenAround(const Eigen::Vector2d& at, double half) const {
  double looked = 0.0;
  double seen = 0.0;
  for (int r = static_cast<int>(at.y() - half); r <= static_cast<int>(at.y() + half); ++r) {
    for (int c = static_cast<int>(at.x() - half); c <= static_cast<int>(at.x() + half); ++c) {
      looked += 1.0;
      if (fixed_.weight.contains(r, c) && fixed_.weight(r, c) > 0.0F) seen += 1.0;
    }
  }
  return seen >= kMinSeenShare * looked;
}

Evidence EvidenceMeter::measure(const Eigen::Affine2d& pose, const SearchSpace& space,
                                double rival) const {
  const double cell = fixed_.frame.cell;
  Evidence evidence;
  const correlation::Template piece = wholeTemplate(pose);
  correlation::ComplexRaster surface(filter_.fft().size());
  correlation::MatchedFilter::Work work(filter_);
  filter_.correlate(piece, surface, work);
  const double deviation = surfaceDeviation(surface);
  evidence.significance = significance(piece, deviation, pose);
  // The shifts that the guess allows, about where it puts the strip's middle.
  const Eigen::Vector2d at = fixed_.frame.cellOf(pose * strip_.centre);
  const Eigen::Vector2d guess = fixed_.frame.cellOf(strip_.centre);
  const double other = highestOther(surface, guess, space.uncertainty.translation / cell, at);
  if (deviation > 0.0) {
    // Next to nothing else in reach: compared with one deviation, what chance gives anywhere.
    evidence.uniqueness = evidence.significance / std::max({other / deviation, rival, 1.0});
  }
  evidence.block_side = blockSide(strip_, options_);
  const std::vector<map::Block> blocks = map::cutBlocks(moving_, strip_, evidence.block_side);
  std::vector<BlockEvidence> placed(blocks.size());
  std::vector<char> usable(blocks.size(), 0);
  parallelFor(blocks.size(), [&](std::size_t i) {
    bool ok = false;
    placed[i] = placeBlock(blocks[i], pose, ok);
    usable[i] = ok ? 1 : 0;
  });
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (usable[i] == 0) continue;
    evidence.blocks.push_back(placed[i]);
    if (placed[i].agrees) ++evidence.agreeing;
  }
  return evidence;
}

}  // namespace agricolmap::verdict
