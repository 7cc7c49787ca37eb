#include "agricolmap/correlation/strip_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/pose_distance.hpp"

namespace agricolmap::correlation {
namespace {

/// Around a pose the highest score of the nearest whole cells counts: at most this far [cells].
constexpr int kPeakReach = 1;
/// A part of the strip that is smaller than this is judged as if it were as large.
constexpr double kLeastInside = 0.2;

double surfaceDeviation(const ComplexRaster& surface) {
  double sum2 = 0.0;
  for (const float v : surface.re) sum2 += static_cast<double>(v) * static_cast<double>(v);
  return std::sqrt(sum2 / static_cast<double>(surface.size()));
}

}  // namespace

StripScore::StripScore(const map::SignalMap& fixed, const map::SignalMap& moving,
                       const MatchedFilter& filter)
    : fixed_(fixed), moving_(moving), filter_(filter), strip_(map::stripFrame(moving)) {
  // A template meets as many seen cells as there are, whatever empty ones surround them: a map that
  // lies obliquely in its bounding box, or in a padded one, must not look more significant.
  const auto seen = static_cast<double>(std::count_if(fixed.weight.begin(), fixed.weight.end(),
                                                      [](float weight) { return weight > 0.0F; }));
  per_seen_cell_ = std::sqrt(static_cast<double>(filter.fft().size()) / std::max(1.0, seen));
}

Template StripScore::wholeTemplate(const Eigen::Affine2d& pose) const {
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& corner : strip_.corners()) bounds.extend(corner);
  return makeTemplate(moving_, strip_.centre, pose.linear(), bounds, fixed_.frame.cell,
                      filter_.options(), [](const Eigen::Vector2d&) { return true; });
}

double StripScore::significance(const Template& piece, double deviation,
                                const Eigen::Affine2d& pose) const {
  if (deviation <= 0.0) return 0.0;
  const Eigen::Vector2d at = fixed_.frame.cellOf(pose * strip_.centre);
  const int row0 = static_cast<int>(std::lround(at.y())) + piece.first_row;
  const int col0 = static_cast<int>(std::lround(at.x())) + piece.first_col;
  double energy = 0.0;
  double inside = 0.0;
  for (int r = 0; r < piece.rows(); ++r) {
    for (int c = 0; c < piece.cols(); ++c) {
      const double cell = piece.energy(r, c);
      energy += cell;
      if (!fixed_.weight.contains(row0 + r, col0 + c)) continue;
      if (fixed_.weight(row0 + r, col0 + c) > 0.0F) inside += cell;
    }
  }
  if (inside <= 0.0) return 0.0;
  const Raster<float> scores = around(piece, at, kPeakReach);
  double highest = -std::numeric_limits<double>::infinity();
  for (const float score : scores) highest = std::max(highest, static_cast<double>(score));
  return highest / (deviation * std::sqrt(std::max(kLeastInside, inside / energy)));
}

double StripScore::significance(const Eigen::Affine2d& pose) const {
  const Template piece = wholeTemplate(pose);
  MatchedFilter::Work work(filter_);
  return significance(piece, per_seen_cell_ * filter_.deviation(piece, work), pose);
}

double StripScore::highestOther(const ComplexRaster& surface, const Eigen::Vector2d& centre,
                                double radius, const Eigen::Vector2d& peak,
                                double exclusion) const {
  const GridFrame& frame = fixed_.frame;
  const auto within = [](double at, int count) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(count - 1)));
  };
  const int r0 = within(std::floor(centre.y() - radius), frame.rows);
  const int r1 = within(std::ceil(centre.y() + radius), frame.rows);
  const int c0 = within(std::floor(centre.x() - radius), frame.cols);
  const int c1 = within(std::ceil(centre.x() + radius), frame.cols);
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

ScorePeaks StripScore::peaks(const Eigen::Affine2d& pose, const Eigen::Vector2d& centre,
                             double radius, double exclusion) const {
  const double cell = fixed_.frame.cell;
  const Template piece = wholeTemplate(pose);
  ComplexRaster surface(filter_.fft().size());
  MatchedFilter::Work work(filter_);
  filter_.correlate(piece, surface, work);
  const double deviation = per_seen_cell_ * surfaceDeviation(surface);
  ScorePeaks peaks;
  peaks.significance = significance(piece, deviation, pose);
  const Eigen::Vector2d at = fixed_.frame.cellOf(pose * strip_.centre);
  const double other =
      highestOther(surface, fixed_.frame.cellOf(centre), radius / cell, at, exclusion / cell);
  if (deviation > 0.0) peaks.other = other / deviation;
  return peaks;
}

void StripScore::addScores(const Raster<float>& piece, const Raster<float>& map, int row0, int col0,
                           Raster<float>& scores) const {
  for (int r = 0; r < piece.rows(); ++r) {
    for (int c = 0; c < piece.cols(); ++c) {
      const float value = piece(r, c);
      if (value == 0.0F) continue;
      const int first = std::max(0, -(col0 + c));
      const int last = std::min(scores.cols(), fixed_.frame.cols - (col0 + c));
      for (int dr = 0; dr < scores.rows(); ++dr) {
        const int row = row0 + r + dr;
        if (row < 0 || row >= fixed_.frame.rows) continue;
        const float* from = map.row(row) + col0 + c;
        float* to = scores.row(dr);
        for (int dc = first; dc < last; ++dc) to[dc] += value * from[dc];
      }
    }
  }
}

double StripScore::distance(const Eigen::Affine2d& a, const Eigen::Affine2d& b) const {
  return poseDistance(strip_.corners(), a, b);
}

Raster<float> StripScore::around(const Template& piece, const Eigen::Vector2d& at,
                                 int reach) const {
  Raster<float> scores(2 * reach + 1, 2 * reach + 1);
  const int row0 = static_cast<int>(std::lround(at.y())) + piece.first_row - reach;
  const int col0 = static_cast<int>(std::lround(at.x())) + piece.first_col - reach;
  for (const int k : filter_.channels()) {
    addScores(piece.channel[k], filter_.whitened(k), row0, col0, scores);
  }
  return scores;
}

}  // namespace agricolmap::correlation
