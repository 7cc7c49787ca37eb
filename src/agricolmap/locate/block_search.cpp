#include "agricolmap/locate/block_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace agricolmap::locate {
namespace {

/// Side of the squares of which each gives one peak at most [cells].
constexpr int kTile = 6;
/// The finer hypotheses are tried this far around a peak of the bound [cells].
constexpr int kAround = 2;

/// out[i] = max(in[i − radius … i + radius]) along rows, cells beyond the border left out.
void maxAlongRow(const float* in, int count, int radius, std::vector<float>& work, float* out) {
  const int width = 2 * radius + 1;
  const auto padded = static_cast<std::size_t>(count + 2 * radius);
  work.assign(padded, -std::numeric_limits<float>::infinity());
  std::copy(in, in + count, work.begin() + radius);
  // Doubling: after each step an element holds the maximum over `span` from it on.
  int span = 1;
  std::size_t valid = padded;
  while (span < width) {
    const int step = std::min(span, width - span);
    valid -= static_cast<std::size_t>(step);
    float* w = work.data();
    for (std::size_t i = 0; i < valid; ++i) {
      w[i] = std::max(w[i], w[i + static_cast<std::size_t>(step)]);
    }
    span += step;
  }
  std::copy(work.begin(), work.begin() + count, out);
}

void maxAlongCols(Raster<float>& raster, int radius) {
  if (radius == 0) return;
  const Raster<float> in = raster;
  const int rows = in.rows();
  for (int r = 0; r < rows; ++r) {
    float* out = raster.row(r);
    for (int k = std::max(0, r - radius); k <= std::min(rows - 1, r + radius); ++k) {
      if (k == r) continue;
      const float* from = in.row(k);
      for (int c = 0; c < in.cols(); ++c) out[c] = std::max(out[c], from[c]);
    }
  }
}

/// Largest value within `radius` (col, row) cells.
Raster<float> maxPooled(const Raster<float>& in, const Eigen::Vector2i& radius) {
  Raster<float> out = in;
  if (radius.x() > 0) {
    std::vector<float> work;
    for (int r = 0; r < in.rows(); ++r) {
      maxAlongRow(in.row(r), in.cols(), radius.x(), work, out.row(r));
    }
  }
  maxAlongCols(out, radius.y());
  return out;
}

/// Adds `step` to what a running sum over `changes` has in [from, to).
void stepUp(std::vector<float>& changes, int from, int to, float step) {
  changes[static_cast<std::size_t>(from)] += step;
  changes[static_cast<std::size_t>(to)] -= step;
}

/// The `most` with the highest scores, highest first.
template <typename Peak>
void keepHighest(std::vector<Peak>& peaks, int most) {
  const auto kept = std::min(peaks.size(), static_cast<std::size_t>(most));
  std::partial_sort(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(kept), peaks.end(),
                    [](const Peak& a, const Peak& b) { return a.score > b.score; });
  peaks.resize(kept);
}

/// Subtracts the mean; returns the variance.
double centred(Raster<float>& raster) {
  double sum = 0.0;
  double sum2 = 0.0;
  for (const float v : raster) {
    sum += static_cast<double>(v);
    sum2 += static_cast<double>(v) * static_cast<double>(v);
  }
  const auto n = static_cast<double>(raster.size());
  const double mean = sum / n;
  const auto offset = static_cast<float>(mean);
  for (float& v : raster) v -= offset;
  return std::max(0.0, sum2 / n - mean * mean);
}

}  // namespace

BlockSearch::BlockSearch(const map::SignalMap& moving, const correlation::MatchedFilter& filter,
                         const SearchSpace& space, const map::StripFrame& strip,
                         std::vector<map::Block> blocks, int peaks, double min_inside)
    : moving_(moving),
      filter_(filter),
      space_(space),
      strip_(strip),
      blocks_(std::move(blocks)),
      peaks_(peaks),
      min_inside_(min_inside) {
  const GridFrame& frame = filter.frame();
  radius_ = space.uncertainty.translation / frame.cell;
  // Where the strip's middle may come to lie: not further beyond the map than half of the strip.
  const Eigen::Vector2d middle = frame.cellOf(space.centre);
  const double rim = strip.half_extent.norm() / frame.cell;
  const Eigen::Vector2d low =
      (Eigen::Vector2d::Constant(-rim) - middle).cwiseMax(Eigen::Vector2d::Constant(-radius_));
  const Eigen::Vector2d high = (Eigen::Vector2d(frame.cols + rim, frame.rows + rim) - middle)
                                   .cwiseMin(Eigen::Vector2d::Constant(radius_));
  shifts_ = {low.array().floor().matrix().cast<int>(), high.array().ceil().matrix().cast<int>()};
}

std::vector<BlockSearch::Surface> BlockSearch::correlate(const Eigen::Matrix2d& linear) const {
  const GridFrame& frame = filter_.frame();
  const auto templateOf = [&](const map::Block& block) {
    return correlation::makeTemplate(
        moving_, block.centre, linear, boundsOf(block, strip_), frame.cell, filter_.options(),
        [&](const Eigen::Vector2d& p) { return block.contains(strip_.local(p)); });
  };
  correlation::MatchedFilter::Work work(filter_);
  correlation::ComplexRaster both(filter_.fft().size());
  std::vector<Surface> surfaces(blocks_.size());
  const auto take = [&](const std::vector<float>& from, Surface& surface) {
    const int rim = filter_.rim();
    surface.score = Raster<float>(frame.rows + 2 * rim, frame.cols + 2 * rim);
    double sum2 = 0.0;
    for (int r = 0; r < surface.score.rows(); ++r) {
      // What lies before the map's first row or column stands at the end: correlation is circular.
      const int row = (r - rim + filter_.fft().rows()) % filter_.fft().rows();
      const float* source = from.data() + static_cast<std::size_t>(row) * filter_.fft().cols();
      float* to = surface.score.row(r);
      std::copy(source + filter_.fft().cols() - rim, source + filter_.fft().cols(), to);
      std::copy(source, source + frame.cols + rim, to + rim);
    }
    for (const float v : surface.score) sum2 += static_cast<double>(v) * static_cast<double>(v);
    surface.variance = sum2 / static_cast<double>(surface.score.size());
  };
  for (std::size_t b = 0; b + 1 < blocks_.size(); b += 2) {
    filter_.correlate(templateOf(blocks_[b]), templateOf(blocks_[b + 1]), both, work);
    take(both.re, surfaces[b]);
    take(both.im, surfaces[b + 1]);
  }
  if (blocks_.size() % 2 == 1) {
    filter_.correlate(templateOf(blocks_.back()), both, work);
    take(both.re, surfaces.back());
  }
  return surfaces;
}

BlockSearch::Offsets BlockSearch::offsetsOf(const Hypothesis& hypothesis) const {
  const Eigen::Matrix2d linear = linearOf(hypothesis, space_);
  Offsets offsets;
  for (const map::Block& block : blocks_) {
    const Eigen::Vector2d at =
        filter_.frame().cellOf(space_.centre + linear * (block.centre - space_.centre));
    offsets.emplace_back(static_cast<int>(std::lround(at.x())) + filter_.rim(),
                         static_cast<int>(std::lround(at.y())) + filter_.rim());
  }
  return offsets;
}

double BlockSearch::insideShare(const Eigen::Vector2i& at) const {
  const int rim = filter_.rim();
  const GridFrame& frame = filter_.frame();
  const auto within = [&](int margin) {
    return at.x() >= rim - margin && at.x() < frame.cols + rim + margin && at.y() >= rim - margin &&
           at.y() < frame.rows + rim + margin;
  };
  return within(0) ? 1.0 : within(rim) ? 0.5 : 0.0;
}

std::vector<BlockSearch::Peak> BlockSearch::boundPeaks(const std::vector<Surface>& bounds,
                                                       const Offsets& offsets) const {
  if (shifts_.isEmpty()) return {};
  const int rim = filter_.rim();
  const int rows = filter_.frame().rows + 2 * rim;
  const int cols = filter_.frame().cols + 2 * rim;
  const int first = shifts_.min().x();
  const int width = shifts_.max().x() - first + 1;
  double total = 0.0;
  for (const Surface& bound : bounds) total += bound.variance;
  const auto least = static_cast<float>(min_inside_ * total);
  std::vector<float> sum(static_cast<std::size_t>(width));
  std::vector<float> variance(sum.size() + 1);
  const int tiles = (width + kTile - 1) / kTile;
  const Peak none{-std::numeric_limits<float>::infinity(), Eigen::Vector2i::Zero()};
  std::vector<Peak> tile(static_cast<std::size_t>(tiles), none);
  std::vector<Peak> peaks;
  for (int dr = shifts_.min().y(); dr <= shifts_.max().y(); ++dr) {
    const double reach = std::sqrt(std::max(0.0, radius_ * radius_ - static_cast<double>(dr) * dr));
    const int from_col = std::max(first, -static_cast<int>(std::min(reach, 1e9)));
    const int to_col = std::min(shifts_.max().x(), static_cast<int>(std::min(reach, 1e9)));
    std::fill(sum.begin(), sum.end(), 0.0F);
    std::fill(variance.begin(), variance.end(), 0.0F);
    for (std::size_t b = 0; b < bounds.size(); ++b) {
      const int row = offsets[b].y() + dr;
      if (row < 0 || row >= rows) continue;
      const int from = std::clamp(-offsets[b].x() - first, 0, width);
      const int to = std::clamp(cols - offsets[b].x() - first, from, width);
      if (from == to) continue;
      const float* source = bounds[b].score.row(row) + offsets[b].x() + first;
      for (int i = from; i < to; ++i) sum[static_cast<std::size_t>(i)] += source[i];
      // Half of what a block on the map has where only its edge may be: see insideShare.
      const auto half = static_cast<float>(0.5 * bounds[b].variance);
      stepUp(variance, from, to, half);
      if (row < rim || row >= rows - rim) continue;
      const int on_from = std::clamp(rim - offsets[b].x() - first, from, to);
      stepUp(variance, on_from, std::clamp(cols - rim - offsets[b].x() - first, on_from, to), half);
    }
    float inside = 0.0F;
    for (int i = 0; i < width; ++i) {
      inside += variance[static_cast<std::size_t>(i)];
      const int dc = first + i;
      if (inside < least || dc < from_col || dc > to_col) continue;
      const float score = sum[static_cast<std::size_t>(i)] / std::sqrt(inside);
      Peak& best = tile[static_cast<std::size_t>(i / kTile)];
      if (score > best.score) best = {score, {dc, dr}};
    }
    if ((dr - shifts_.min().y()) % kTile == kTile - 1 || dr == shifts_.max().y()) {
      for (Peak& best : tile) {
        if (std::isfinite(best.score)) peaks.push_back(best);
        best = none;
      }
    }
  }
  keepHighest(peaks, peaks_);
  return peaks;
}

Candidate BlockSearch::bestNear(const Peak& peak, const std::vector<Hypothesis>& fine,
                                const std::vector<Offsets>& fine_offsets,
                                const std::vector<Surface>& surfaces) const {
  double total = 0.0;
  for (const Surface& surface : surfaces) total += surface.variance;
  Candidate best;
  best.score = -std::numeric_limits<double>::infinity();
  for (std::size_t h = 0; h < fine.size(); ++h) {
    for (int dr = -kAround; dr <= kAround; ++dr) {
      for (int dc = -kAround; dc <= kAround; ++dc) {
        const Eigen::Vector2i shift = peak.shift + Eigen::Vector2i(dc, dr);
        double sum = 0.0;
        double inside = 0.0;
        for (std::size_t b = 0; b < surfaces.size(); ++b) {
          const Eigen::Vector2i at = fine_offsets[h][b] + shift;
          const double share = insideShare(at);
          if (share == 0.0) continue;
          sum += static_cast<double>(surfaces[b].score(at.y(), at.x()));
          inside += share * surfaces[b].variance;
        }
        if (inside < min_inside_ * total || inside <= 0.0) continue;
        const double score = sum / std::sqrt(inside);
        if (score > best.score) {
          best = {fine[h], filter_.frame().cell * shift.cast<double>(), score};
        }
      }
    }
  }
  return best;
}

std::vector<Candidate> BlockSearch::run(const Hypothesis& coarse,
                                        const std::vector<Hypothesis>& fine) const {
  const std::vector<Surface> surfaces = correlate(linearOf(coarse, space_));
  const Offsets offsets = offsetsOf(coarse);
  std::vector<Offsets> fine_offsets;
  for (const Hypothesis& h : fine) fine_offsets.push_back(offsetsOf(h));
  std::vector<Surface> bounds;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Eigen::Vector2i reach = Eigen::Vector2i::Zero();
    for (const Offsets& other : fine_offsets) {
      reach = reach.cwiseMax((other[b] - offsets[b]).cwiseAbs());
    }
    Surface bound{maxPooled(surfaces[b].score, reach), 0.0};
    bound.variance = centred(bound.score);
    if (bound.variance <= 0.0) return {};
    bounds.push_back(std::move(bound));
  }
  // Templates have det cells for each of the moving map's.
  double variance = 0.0;
  for (const Surface& surface : surfaces) variance += surface.variance;
  const double deviation = std::sqrt(variance) / std::abs(linearOf(coarse, space_).determinant());
  std::vector<Candidate> found;
  for (const Peak& peak : boundPeaks(bounds, offsets)) {
    Candidate best = bestNear(peak, fine, fine_offsets, surfaces);
    best.deviation = deviation;
    if (std::isfinite(best.score)) found.push_back(best);
  }
  return found;
}

}  // namespace agricolmap::locate
