#include "agricolmap/refine/canopy_lift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/map/box_mean.hpp"

namespace agricolmap::refine {
namespace {

/// As in map/hidden_ground: radius of what is usual around [m], and the share of the usual number
/// of points with which a cell was seen whole.
constexpr double kUsualRadius = 0.25;
constexpr double kWhole = 0.5;
/// Beyond the strip there is nothing to blur in.
constexpr float kInside = 0.5F;
/// Passes of a box of three cells, after which blurs are tried: each adds 2/3 of a cell² to the
/// variance, so in cells of 2 cm up to 5.7 cm.
constexpr std::array kPasses = {0, 1, 2, 3, 5, 8, 12};
constexpr double kMostBlur = 0.06;  // [m]
/// Both are blurred by so many more where the gain is told: what one view alone sees of single
/// leaves is evened out.
constexpr int kMorePasses = 3;
/// A drone does not see canopies taller than they are.
constexpr double kMostGain = 1.1;
constexpr double kLeastGain = 0.1;
/// Share of values at either end that count as the last one before them.
constexpr double kWild = 0.005;

double blurOf(int passes, double cell) { return cell * std::sqrt(2.0 / 3.0 * passes); }

/// A raster and where it counts.
struct Surface {
  Raster<float> value;
  Raster<float> weight;

  void blur(int passes) {
    const map::BoxMean around(weight, 1);
    for (int pass = 0; pass < passes; ++pass) value = around.of(value);
  }
};

/// Height of the moving map's plants above its ground, taken for ground where a plant hides it.
Surface canopyOf(const map::GridMap& moving, const GroundModel& ground) {
  const int rows = moving.frame.rows, cols = moving.frame.cols;
  const int radius = std::max(1, static_cast<int>(std::lround(kUsualRadius / moving.frame.cell)));
  Raster<float> seen(rows, cols);
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = moving.valid(i) ? 1.0F : 0.0F;
  const Raster<float> all(rows, cols, 1.0F);
  const Raster<float> usual = map::BoxMean(seen, radius).of(moving.weight);
  const Raster<float> around = map::BoxMean(all, radius).of(seen);
  Surface canopy{Raster<float>(rows, cols), Raster<float>(rows, cols)};
  parallelFor(static_cast<std::size_t>(rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < cols; ++c) {
      const auto under = static_cast<float>(ground.at(r, c));
      if (around(r, c) <= kInside || !std::isfinite(under)) continue;
      canopy.weight(r, c) = 1.0F;
      if (!moving.valid(r, c)) continue;
      const float share =
          std::min(1.0F, moving.weight(r, c) / (static_cast<float>(kWhole) * usual(r, c)));
      canopy.value(r, c) = share * (moving.height(r, c) - under);
    }
  });
  return canopy;
}

/// The fixed surface over the moving map's ground, on the moving map's cells.
Surface fixedOver(const map::GridMap& fixed, const map::GridMap& moving, const GroundModel& ground,
                  const Eigen::Affine2d& pose, const Eigen::Vector3d& plane,
                  const Eigen::Vector2d& about) {
  Surface over{Raster<float>(moving.frame.rows, moving.frame.cols),
               Raster<float>(moving.frame.rows, moving.frame.cols)};
  parallelFor(static_cast<std::size_t>(moving.frame.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < moving.frame.cols; ++c) {
      const Eigen::Vector2d place = pose * moving.frame.centre(r, c);
      const double under = ground.at(r, c);
      int fr = 0, fc = 0;
      if (!fixedCellAt(fixed, place, fr, fc) || !std::isfinite(under)) continue;
      const double level = plane[0] + plane.tail<2>().dot(place - about);
      over.weight(r, c) = 1.0F;
      over.value(r, c) =
          static_cast<float>(static_cast<double>(fixed.height(fr, fc)) - level - under);
    }
  });
  return over;
}

/// How two surfaces vary together.
struct Likeness {
  double gain = 1.0;  ///< deviation of the fixed one over the other's
  double correlation = 0.0;
};

/// Wild values cut to where only kWild of all lie beyond.
std::vector<double> tamed(std::vector<double> values) {
  std::vector<double> copy = values;
  const double low = quantile(copy, kWild), high = quantile(copy, 1.0 - kWild);
  for (double& value : values) value = std::clamp(value, low, high);
  return values;
}

/// Leaves that only one view shows scatter both alike: the ratio of the deviations is the gain,
/// where a regression of one on the other would fall short of it.
Likeness likenessOf(const Surface& fixed, const Surface& canopy,
                    const std::vector<GroundCell>& cells) {
  std::vector<double> f, b;
  for (const GroundCell& cell : cells) {
    if (canopy.weight(cell.row, cell.col) <= 0.0F || fixed.weight(cell.row, cell.col) <= 0.0F) {
      continue;
    }
    f.push_back(static_cast<double>(fixed.value(cell.row, cell.col)));
    b.push_back(static_cast<double>(canopy.value(cell.row, cell.col)));
  }
  if (f.empty()) return {};
  f = tamed(std::move(f));
  b = tamed(std::move(b));
  const auto n = static_cast<double>(f.size());
  double mean_f = 0.0, mean_b = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    mean_f += f[i] / n;
    mean_b += b[i] / n;
  }
  double ff = 0.0, bb = 0.0, fb = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    ff += (f[i] - mean_f) * (f[i] - mean_f);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    fb += (f[i] - mean_f) * (b[i] - mean_b);
  }
  if (!(ff > 0.0) || !(bb > 0.0)) return {};
  return {std::sqrt(ff / bb), fb / std::sqrt(ff * bb)};
}

}  // namespace

CanopyLift predictLift(const map::GridMap& fixed, const map::GridMap& moving,
                       const GroundModel& under_moving, const Eigen::Affine2d& pose,
                       const std::vector<GroundCell>& cells, const Eigen::Vector3d& plane,
                       const Eigen::Vector2d& about) {
  Surface over = fixedOver(fixed, moving, under_moving, pose, plane, about);
  const Surface sharp = canopyOf(moving, under_moving);
  Surface blurred = sharp;
  Surface best = sharp;
  double highest = -2.0;
  CanopyLift result;
  int done = 0;
  for (const int passes : kPasses) {
    if (blurOf(passes, moving.frame.cell) > kMostBlur) break;
    blurred.blur(passes - done);
    done = passes;
    const double correlation = likenessOf(over, blurred, cells).correlation;
    if (correlation <= highest) continue;
    highest = correlation;
    best = blurred;
    result.blur = blurOf(passes, moving.frame.cell);
  }
  Surface even = best;
  even.blur(kMorePasses);
  over.blur(kMorePasses);
  result.correlation = highest;
  result.gain = likenessOf(over, even, cells).gain;
  const double gain = std::clamp(result.gain, kLeastGain, kMostGain);
  result.lift.reserve(cells.size());
  for (const GroundCell& cell : cells) {
    const bool inside = sharp.weight(cell.row, cell.col) > 0.0F;
    const double canopy = static_cast<double>(moving.height(cell.row, cell.col)) -
                          under_moving.at(cell.row, cell.col);
    const auto seen = static_cast<double>(best.value(cell.row, cell.col));
    result.lift.push_back(inside ? gain * seen - canopy : 0.0);
  }
  return result;
}

}  // namespace agricolmap::refine
