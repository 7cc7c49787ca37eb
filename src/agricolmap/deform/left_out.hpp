// Blocks of the strip that are left out of a fit, so that they can confirm it.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/deform/strip_bins.hpp"

namespace agricolmap::deform {

/// Blocks of the two halves of a strip in two folds: neighbours, also those beside one another, are
/// in different ones. So at each place along the path one half is left out and the other is not.
class LeftOutBlocks {
 public:
  static constexpr int kFolds = 2;

  explicit LeftOutBlocks(const BinLayout& layout)
      : layout_(layout),
        along_(std::max(4, static_cast<int>(std::lround(layout.length / kLength)))) {}
  int count() const { return 2 * along_; }
  int of(int bin) const {
    const int along = (bin % layout_.count) * along_ / layout_.count;
    return layout_.left(bin) ? along_ + along : along;
  }
  int fold(int bin) const {
    const int block = of(bin);
    return (block % along_ + block / along_) % kFolds;
  }

 private:
  /// About what a plant and its shadow differ over: cells of one block err together [m].
  static constexpr double kLength = 1.0;

  BinLayout layout_;
  int along_;
};

/// Mean of the blocks' gains over its standard error.
inline double significanceOf(const std::vector<double>& gains) {
  double sum = 0.0, sum2 = 0.0;
  for (const double gain : gains) sum += gain, sum2 += gain * gain;
  const auto count = static_cast<double>(gains.size());
  if (count < 2.0) return 0.0;
  const double variance = std::max(0.0, sum2 - sum * sum / count) * count / (count - 1.0);
  return variance > 0.0 ? sum / std::sqrt(variance) : 0.0;
}

}  // namespace agricolmap::deform
