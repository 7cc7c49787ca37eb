#include "agricolmap/fuse/seam.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "agricolmap/fuse/chamfer.hpp"

namespace agricolmap::fuse {
namespace {

/// Differences beyond are no matter of heights [m].
constexpr float kMostLeft = 1.0F;

/// Sums over squares of a strip's surroundings, smoothed by boxes: what is left between strip and
/// fixed cloud, and from how many cells.
class Left {
 public:
  Left(int rows, int cols) : sum_(rows, cols, 0.0F), weight_(rows, cols, 0.0F) {}

  void add(int row, int col, float value) {
    sum_(row, col) += value;
    weight_(row, col) += 1.0F;
  }
  /// Three passes of a box of 2·reach + 1 along both axes: nearly a Gaussian.
  void smooth(int reach) {
    for (int pass = 0; pass < 3; ++pass) {
      for (Raster<float>* raster : {&sum_, &weight_}) {
        alongRows(*raster, reach);
        alongCols(*raster, reach);
      }
    }
  }
  /// Mean around a cell; 0 where there is none.
  float at(int row, int col) const {
    constexpr float kLeast = 1e-6F;
    return weight_(row, col) > kLeast ? sum_(row, col) / weight_(row, col) : 0.0F;
  }

 private:
  template <typename Get, typename Set>
  static void box(int count, int reach, const Get& get, const Set& set) {
    std::vector<double> sums(static_cast<std::size_t>(count) + 1, 0.0);
    for (int i = 0; i < count; ++i) {
      sums[static_cast<std::size_t>(i) + 1] =
          sums[static_cast<std::size_t>(i)] + static_cast<double>(get(i));
    }
    const double share = 1.0 / (2 * reach + 1);
    for (int i = 0; i < count; ++i) {
      const auto low = static_cast<std::size_t>(std::max(0, i - reach));
      const auto high = static_cast<std::size_t>(std::min(count, i + reach + 1));
      set(i, static_cast<float>((sums[high] - sums[low]) * share));
    }
  }
  static void alongRows(Raster<float>& raster, int reach) {
    for (int row = 0; row < raster.rows(); ++row) {
      box(
          raster.cols(), reach, [&](int i) { return raster(row, i); },
          [&](int i, float value) { raster(row, i) = value; });
    }
  }
  static void alongCols(Raster<float>& raster, int reach) {
    for (int col = 0; col < raster.cols(); ++col) {
      box(
          raster.rows(), reach, [&](int i) { return raster(i, col); },
          [&](int i, float value) { raster(i, col) = value; });
    }
  }

  Raster<float> sum_;
  Raster<float> weight_;
};

/// What is left, smoothed over about as far as a cell is from the strip: beside its border what is
/// left right there, so that no step stays; further off the mean of more and more, so that single
/// leaves are not drawn out.
class LeftByDistance {
 public:
  LeftByDistance(const Left& left, int farthest) {
    for (int reach = 1; reach < farthest; reach *= 2) add(left, reach);
    add(left, farthest);
  }
  /// `cells`: distance to the strip.
  float at(int row, int col, double cells) const {
    const double level = std::log2(std::max(1.0, cells));
    const auto last = levels_.size() - 1;
    const auto fine = std::min(static_cast<std::size_t>(level), last);
    const auto share = static_cast<float>(level - std::floor(level));
    const float finer = levels_[fine].at(row, col);
    return finer + share * (levels_[std::min(fine + 1, last)].at(row, col) - finer);
  }

 private:
  void add(const Left& left, int reach) {
    levels_.push_back(left);
    levels_.back().smooth(reach);
  }

  std::vector<Left> levels_;  ///< each over twice as far as the one before, but for the last
};

/// Distance to the nearest cell that the strip saw [m], within a window.
Raster<float> distanceTo(const StripCells& strip, int first_row, int first_col, int rows, int cols,
                         double cell) {
  Raster<std::uint8_t> seen(rows, cols);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) seen(r, c) = strip.seen(first_row + r, first_col + c) ? 1 : 0;
  }
  return chamferDistance(seen, cell, std::numeric_limits<float>::max());
}

/// Leads the fixed cloud to one strip: adds to `correction`, weighted among strips.
void addSeam(const FixedHeights& fixed, const Raster<float>& bias, const StripCells& strip,
             double seam, Raster<float>& sums, Raster<float>& weights) {
  const double cell = fixed.map.frame.cell;
  const int margin = static_cast<int>(std::ceil(seam / cell)) + 1;
  const int row = std::max(0, strip.row - margin), col = std::max(0, strip.col - margin);
  const int rows = std::min(fixed.map.frame.rows, strip.row + strip.depth.rows() + margin) - row;
  const int cols = std::min(fixed.map.frame.cols, strip.col + strip.depth.cols() + margin) - col;
  if (rows <= 0 || cols <= 0) return;
  Left left(rows, cols);
  for (int r = 0; r < strip.depth.rows(); ++r) {
    for (int c = 0; c < strip.depth.cols(); ++c) {
      const int map_row = strip.row + r, map_col = strip.col + c;
      if (strip.depth(r, c) <= 0.0F || !fixed.map.valid(map_row, map_col)) continue;
      const float difference =
          strip.coarse.height(r, c) - fixed.map.height(map_row, map_col) - bias(map_row, map_col);
      if (std::abs(difference) < kMostLeft) left.add(map_row - row, map_col - col, difference);
    }
  }
  const LeftByDistance smooth(left, std::max(1, static_cast<int>(std::lround(0.5 * seam / cell))));
  const Raster<float> distance = distanceTo(strip, row, col, rows, cols, cell);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const auto away = static_cast<double>(distance(r, c));
      const double way = away / seam;
      if (!(way < 1.0)) continue;
      // From 1 at the strip to 0 with a level end.
      const auto fade = static_cast<float>(0.5 + 0.5 * std::cos(way * std::numbers::pi));
      sums(row + r, col + c) += fade * smooth.at(r, c, away / cell) * fade;
      weights(row + r, col + c) += fade;
    }
  }
}

}  // namespace

Raster<float> heightCorrection(const FixedHeights& fixed, const std::optional<HeightBias>& bias,
                               const std::vector<const StripCells*>& strips, double seam) {
  const int rows = fixed.map.frame.rows, cols = fixed.map.frame.cols;
  Raster<float> correction(rows, cols, 0.0F);
  if (bias) {
    for (std::size_t i = 0; i < correction.size(); ++i) {
      const std::optional<HeightShift> shift = bias->at(fixed, i);
      if (shift) correction[i] = static_cast<float>(shift->mean);
    }
  }
  if (seam <= 0.0) return correction;
  Raster<float> sums(rows, cols, 0.0F), weights(rows, cols, 0.0F);
  for (const StripCells* strip : strips) addSeam(fixed, correction, *strip, seam, sums, weights);
  for (std::size_t i = 0; i < correction.size(); ++i) {
    if (weights[i] > 0.0F) correction[i] += sums[i] / weights[i];
  }
  return correction;
}

}  // namespace agricolmap::fuse
