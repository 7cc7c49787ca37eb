#include "agricolmap/map/vegetation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::map {

std::string_view toString(VegetationStatus status) {
  switch (status) {
    case VegetationStatus::kOk:
      return "ok";
    case VegetationStatus::kTooFewCells:
      return "too few filled cells";
    case VegetationStatus::kConstant:
      return "the cells have no colour contrast";
    case VegetationStatus::kNoVegetation:
      return "no vegetation stands out from the soil";
    case VegetationStatus::kClosedCanopy:
      return "no soil shows between the plants";
    case VegetationStatus::kExtremeShare:
      return "nearly all cells are soil or nearly all are vegetation";
  }
  return "unknown";
}

void listOptions(OptionTable& table, VegetationOptions& options) {
  table.number("min_contrast", options.min_contrast, 0.0, 100.0, "",
               "least greenness of plants above soil, in robust deviations of the soil's");
  table.number("min_share", options.min_share, 0.0, 0.5, "",
               "least share of cells that must be vegetation, and that must be soil");
}

namespace {

constexpr int kBins = 1024;
constexpr std::size_t kMinCells = 100;
constexpr std::size_t kChunk = 1U << 18;
/// A rare population found behind the bulk needs this much more contrast than one found by Otsu:
/// the tail of skewed soil reaches further than half of it does.
constexpr double kTailFactor = 1.7;
/// ... and this much more to be preferred where Otsu's is good enough: on a real beet field it then
/// agreed better with the labels.
constexpr double kTailGain = 1.15;
/// One population is called green above this Excess Green. It only chooses between two names for
/// "no contrast", so a camera's white balance does little harm.
constexpr double kGreenMean = 0.06;

/// Counts of Excess Green over the bulk of the filled cells.
struct Histogram {
  std::array<double, kBins> count{};
  double low = 0.0;
  double width = 0.0;  ///< of a bin
  double centre(int bin) const { return low + (bin + 0.5) * width; }
  double at(int bin) const { return count[static_cast<std::size_t>(bin)]; }
  Histogram& operator+=(const Histogram& other) {
    for (std::size_t i = 0; i < kBins; ++i) count[i] += other.count[i];
    return *this;
  }
};

/// Histogram of the filled cells between `low` and `high`; values beyond go to the end bins.
Histogram histogramOf(const GridMap& map, double low, double high) {
  Histogram zero;
  zero.low = low;
  zero.width = (high - low) / kBins;
  return parallelSum(map.exg.size(), kChunk, zero, [&](std::size_t begin, std::size_t end) {
    Histogram part = zero;
    for (std::size_t i = begin; i < end; ++i) {
      if (!map.valid(i)) continue;
      const double bin = (static_cast<double>(map.exg[i]) - low) / zero.width;
      part.count[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))] += 1.0;
    }
    return part;
  });
}

/// The cells in the bins [begin, end).
struct Class {
  double count = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double deviation = 0.0;  ///< from the median absolute deviation, at least half a bin
};

/// Bin below which (and in which) `share` of the counts in [begin, end) lie.
int quantileBin(const Histogram& histogram, int begin, int end, double share) {
  double total = 0.0;
  for (int bin = begin; bin < end; ++bin) total += histogram.at(bin);
  double sum = 0.0;
  for (int bin = begin; bin < end; ++bin) {
    sum += histogram.at(bin);
    if (sum >= share * total) return bin;
  }
  return end - 1;
}

Class classOf(const Histogram& histogram, int begin, int end) {
  Class result;
  for (int bin = begin; bin < end; ++bin) {
    result.count += histogram.at(bin);
    result.mean += histogram.at(bin) * histogram.centre(bin);
  }
  if (result.count <= 0.0) return result;
  result.mean /= result.count;
  const int median = quantileBin(histogram, begin, end, 0.5);
  result.median = histogram.centre(median);
  // Grow an interval about the median until it holds half of the cells.
  int reach = 0;
  for (double inside = histogram.at(median); inside < 0.5 * result.count;) {
    ++reach;
    if (median - reach >= begin) inside += histogram.at(median - reach);
    if (median + reach < end) inside += histogram.at(median + reach);
  }
  result.deviation = kMadToDeviation * std::max(0.5, static_cast<double>(reach)) * histogram.width;
  return result;
}

/// A way to split the histogram: soil in the bins before `bin`, vegetation in the others.
struct Split {
  double threshold = 0.0;
  Class soil;
  Class green;
  double contrast() const {
    if (soil.count <= 0.0 || green.count <= 0.0) return 0.0;
    return (green.mean - soil.mean) / soil.deviation;
  }
};

Split splitAt(const Histogram& histogram, int bin) {
  return {histogram.low + bin * histogram.width, classOf(histogram, 0, bin),
          classOf(histogram, bin, kBins)};
}

/// Otsu's split (1979), of largest between-class variance. Its threshold lies half-way between the
/// two means: the border of a plant stays where it is however much the map is smoothed.
Split otsuSplit(const Histogram& histogram) {
  const Class all = classOf(histogram, 0, kBins);
  double best = -1.0;
  int best_bin = kBins / 2;
  double count = 0.0;
  double sum = 0.0;
  for (int bin = 0; bin + 1 < kBins; ++bin) {
    count += histogram.at(bin);
    sum += histogram.at(bin) * histogram.centre(bin);
    const double rest = all.count - count;
    if (count <= 0.0 || rest <= 0.0) continue;
    const double difference = sum / count - (all.mean * all.count - sum) / rest;
    const double between = count * rest * difference * difference;
    if (between > best) {
      best = between;
      best_bin = bin + 1;
    }
  }
  return splitAt(histogram, best_bin);
}

/// Half-way between the bulk and the cells four deviations greener: finds seedlings that cover so
/// little that Otsu would rather split the soil.
Split tailSplit(const Histogram& histogram) {
  const Class bulk = classOf(histogram, 0, kBins);
  const auto binOf = [&](double value) {
    return std::clamp(static_cast<int>((value - histogram.low) / histogram.width), 0, kBins);
  };
  const Class tail = classOf(histogram, binOf(bulk.median + 4.0 * bulk.deviation), kBins);
  if (tail.count <= 0.0) return {};
  return splitAt(histogram, binOf(0.5 * (bulk.median + tail.mean)));
}

/// Lowest and highest finite value of the filled cells.
std::pair<double, double> rangeOf(const GridMap& map) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (std::size_t i = 0; i < map.exg.size(); ++i) {
    if (!map.valid(i)) continue;
    low = std::min(low, static_cast<double>(map.exg[i]));
    high = std::max(high, static_cast<double>(map.exg[i]));
  }
  return {low, high};
}

/// Side of the blocks in which the margin is measured, in cells: a block counts as seen when any of
/// its cells is, so that chance gaps between points are no edge.
constexpr int kMarginCells = 4;

/// Per block the distance to the nearest block that is not seen, or to the map's end [m]: a
/// two-pass chamfer transform (Borgefors 1986), good to a tenth.
Raster<float> seenMargin(const GridMap& map) {
  const int rows = (map.frame.rows + kMarginCells - 1) / kMarginCells;
  const int cols = (map.frame.cols + kMarginCells - 1) / kMarginCells;
  Raster<float> margin(rows, cols, 0.0F);
  for (int row = 0; row < map.frame.rows; ++row) {
    for (int col = 0; col < map.frame.cols; ++col) {
      if (map.valid(row, col)) {
        margin(row / kMarginCells, col / kMarginCells) = std::numeric_limits<float>::max();
      }
    }
  }
  const auto at = [&](int row, int col) {
    return margin.contains(row, col) ? margin(row, col) : 0.0F;
  };
  constexpr float kDiagonal = 1.35F;
  const auto pass = [&](int row, int col, int back) {
    float& value = margin(row, col);
    value =
        std::min({value, at(row - back, col) + 1.0F, at(row, col - back) + 1.0F,
                  at(row - back, col - back) + kDiagonal, at(row - back, col + back) + kDiagonal});
  };
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) pass(row, col, 1);
  }
  for (int row = rows - 1; row >= 0; --row) {
    for (int col = cols - 1; col >= 0; --col) pass(row, col, -1);
  }
  // From the block's middle to the unseen block's border.
  const auto block = static_cast<float>(kMarginCells * map.frame.cell);
  for (float& value : margin) value = std::max(0.0F, value - 0.5F) * block;
  return margin;
}

}  // namespace

VegetationThreshold vegetationThreshold(const GridMap& map, const VegetationOptions& options) {
  VegetationThreshold result;
  const auto filled = std::count_if(map.weight.begin(), map.weight.end(),
                                    [](float weight) { return weight > 0.0F; });
  if (static_cast<std::size_t>(filled) < kMinCells) return result;
  const auto [low, high] = rangeOf(map);
  if (!(high - low > 1e-6)) {
    result.status = VegetationStatus::kConstant;
    return result;
  }
  // A few odd cells must not stretch the bins: the second histogram spans the bulk.
  const Histogram wide = histogramOf(map, low, high);
  const double margin = 2.0 * wide.width;
  const Histogram histogram =
      histogramOf(map, wide.centre(quantileBin(wide, 0, kBins, 0.001)) - margin,
                  wide.centre(quantileBin(wide, 0, kBins, 0.999)) + margin);
  Split split = otsuSplit(histogram);
  bool apart = split.contrast() >= options.min_contrast;
  const Split tail = tailSplit(histogram);
  if (tail.contrast() >= kTailFactor * options.min_contrast &&
      (!apart || tail.contrast() > kTailGain * split.contrast())) {
    split = tail;
    apart = true;
  }
  result.threshold = split.threshold;
  result.soil_mean = split.soil.mean;
  result.vegetation_mean = split.green.mean;
  result.contrast = split.contrast();
  result.share = split.green.count / (split.soil.count + split.green.count);
  if (!apart) {
    const bool green = classOf(histogram, 0, kBins).median > kGreenMean;
    result.status = green ? VegetationStatus::kClosedCanopy : VegetationStatus::kNoVegetation;
  } else if (result.share < options.min_share || result.share > 1.0 - options.min_share) {
    result.status = VegetationStatus::kExtremeShare;
  } else {
    result.status = VegetationStatus::kOk;
  }
  return result;
}

Vegetation extractVegetation(const GridMap& map, const VegetationOptions& options) {
  Vegetation result;
  result.threshold = vegetationThreshold(map, options);
  if (result.threshold.status != VegetationStatus::kOk &&
      result.threshold.status != VegetationStatus::kClosedCanopy) {
    return result;
  }
  const double threshold = result.threshold.threshold;
  const double scale = 1.0 / (result.threshold.vegetation_mean - threshold);
  const Raster<float> margin = seenMargin(map);
  result.mask = Raster<unsigned char>(map.frame.rows, map.frame.cols);
  for (int row = 0; row < map.frame.rows; ++row) {
    for (int col = 0; col < map.frame.cols; ++col) {
      const std::size_t i = map.weight.index(row, col);
      if (!map.valid(i)) continue;
      const double excess = static_cast<double>(map.exg[i]) - threshold;
      if (!(excess > 0.0)) continue;
      result.mask[i] = 1;
      result.points.push_back(
          {map.frame.centre(row, col), static_cast<double>(map.height[i]),
           std::min(1.0, scale * excess),
           static_cast<double>(margin(row / kMarginCells, col / kMarginCells))});
    }
  }
  return result;
}

}  // namespace agricolmap::map
