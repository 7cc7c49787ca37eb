#include "agricolmap/verdict/slices.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::verdict {
namespace {

constexpr double kLength = 0.8;       ///< of a slice [m]
constexpr double kLeastLength = 0.4;  ///< shorter ones hold too little [m]
constexpr double kFewest = 6.0;
constexpr double kMost = 50.0;
constexpr int kMostReach = 40;         ///< [cells]
constexpr double kFar = 0.35;          ///< shifts beyond this are chance [m]
constexpr std::size_t kLeastFar = 50;  ///< so many of them tell what chance gives
constexpr double kMinSeenShare = 0.5;  ///< of a slice's area, by either map

double sliceCount(double length) {
  const double most = std::max(1.0, std::floor(length / kLeastLength));
  return std::min(most, std::clamp(std::round(length / kLength), kFewest, kMost));
}

/// Whether both maps have seen enough of a slice.
bool seen(const correlation::StripScore& score, const map::Block& slice,
          const Eigen::Affine2d& pose) {
  const double cell = score.fixed().frame.cell;
  double looked = 0.0, moving = 0.0, both = 0.0;
  for (double u = slice.low.x() + 0.5 * cell; u < slice.high.x(); u += cell) {
    for (double v = slice.low.y() + 0.5 * cell; v < slice.high.y(); v += cell) {
      const Eigen::Vector2d p = score.strip().world({u, v});
      looked += 1.0;
      if (map::sampleSignal(score.moving(), p).weight <= 0.0F) continue;
      moving += 1.0;
      if (map::sampleSignal(score.fixed(), pose * p).weight > 0.0F) both += 1.0;
    }
  }
  return moving >= kMinSeenShare * looked && both > 0.0 && both >= kMinSeenShare * moving;
}

/// Root mean square score of the far shifts; 0 for too few.
double deviationOfFar(const Raster<float>& scores, int reach, double cell) {
  double sum2 = 0.0;
  std::size_t count = 0;
  for (int r = 0; r < scores.rows(); ++r) {
    for (int c = 0; c < scores.cols(); ++c) {
      if (std::hypot(r - reach, c - reach) * cell <= kFar) continue;
      sum2 += static_cast<double>(scores(r, c)) * static_cast<double>(scores(r, c));
      ++count;
    }
  }
  return count >= kLeastFar ? std::sqrt(sum2 / static_cast<double>(count)) : 0.0;
}

}  // namespace

Slices scoreSlices(const correlation::StripScore& score, const Eigen::Affine2d& pose,
                   double reach) {
  const GridFrame& frame = score.fixed().frame;
  const map::StripFrame& strip = score.strip();
  Slices result;
  result.cell = frame.cell;
  result.reach = std::min(kMostReach, static_cast<int>(std::ceil(reach / frame.cell)));
  const double length = 2.0 * strip.half_extent.x();
  const auto count = static_cast<std::size_t>(sliceCount(length));
  const double step = length / static_cast<double>(count);
  // All slices hang on one point that the pose lays into the middle of a cell: so no shift is none,
  // and the scores of neighbours add up.
  const Eigen::Vector2d at = frame.cellOf(pose * strip.centre).array().round();
  const Eigen::Vector2d anchor =
      pose.inverse() * frame.centre(static_cast<int>(at.y()), static_cast<int>(at.x()));
  result.slices.resize(count);
  parallelFor(count, [&](std::size_t i) {
    Slice& slice = result.slices[i];
    slice.begin = step * static_cast<double>(i);
    slice.end = step * static_cast<double>(i + 1);
    map::Block block;
    block.low = {slice.begin - strip.half_extent.x(), -strip.half_extent.y()};
    block.high = {slice.end - strip.half_extent.x(), strip.half_extent.y()};
    if (!seen(score, block, pose)) return;
    const correlation::Template piece = correlation::makeTemplate(
        score.moving(), anchor, pose.linear(), boundsOf(block, strip), frame.cell, score.options(),
        [&](const Eigen::Vector2d& p) { return block.contains(strip.local(p)); });
    slice.scores = score.around(piece, at, result.reach);
    slice.deviation = deviationOfFar(slice.scores, result.reach, frame.cell);
  });
  return result;
}

}  // namespace agricolmap::verdict
