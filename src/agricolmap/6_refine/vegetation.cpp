#include "agricolmap/6_refine/vegetation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap {

std::string_view describe(VegetationStatus status) {
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

void describe(OptionTable& table, VegetationOptions& options) {
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
constexpr double kTailFactor = 1.5;
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
  double deviation = 0.0;  ///< 1.4826 · median absolute deviation, at least half a bin
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
  result.deviation = 1.4826 * std::max(0.5, static_cast<double>(reach)) * histogram.width;
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

Box2 boxOf(const std::vector<VegetationPoint>& points) {
  Box2 box;
  for (const VegetationPoint& p : points) box.extend(p.position);
  return box;
}

/// Squares of one side over the box of some points, anchored at zero.
class Squares {
 public:
  Squares(const std::vector<VegetationPoint>& points, double side) : side_(side) {
    const Box2 box = boxOf(points);
    first_ = (box.min() / side).array().floor();
    const Eigen::Array2d count = (box.max() / side).array().floor() - first_ + 1.0;
    if (!(count.prod() < kMaxSquares)) {
      throw UsageError("the side of a thinning square is far too small for the extent of the map");
    }
    cols_ = static_cast<std::uint64_t>(count.x());
    squares_ = cols_ * static_cast<std::uint64_t>(count.y());
  }
  std::uint64_t key(const VegetationPoint& p) const {
    const Eigen::Array2d square = (p.position / side_).array().floor() - first_;
    return static_cast<std::uint64_t>(square.y()) * cols_ + static_cast<std::uint64_t>(square.x());
  }
  /// How many squares hold points.
  std::size_t occupied(const std::vector<VegetationPoint>& points) const {
    std::vector<bool> seen(squares_, false);
    std::size_t count = 0;
    for (const VegetationPoint& p : points) {
      const std::uint64_t square = key(p);
      count += seen[square] ? 0 : 1;
      seen[square] = true;
    }
    return count;
  }

 private:
  static constexpr double kMaxSquares = 4e9;
  double side_;
  Eigen::Array2d first_;
  std::uint64_t cols_ = 0;
  std::uint64_t squares_ = 0;
};

}  // namespace

VegetationThreshold vegetationThreshold(const GridMap& map, const VegetationOptions& options) {
  checkOptions(options);
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
  if (result.threshold.status != VegetationStatus::kOk) return result;
  const double threshold = result.threshold.threshold;
  const double scale = 1.0 / (result.threshold.vegetation_mean - threshold);
  result.mask = Raster<unsigned char>(map.frame.rows, map.frame.cols);
  for (int row = 0; row < map.frame.rows; ++row) {
    for (int col = 0; col < map.frame.cols; ++col) {
      const std::size_t i = map.weight.index(row, col);
      if (!map.valid(i)) continue;
      const double excess = static_cast<double>(map.exg[i]) - threshold;
      if (!(excess > 0.0)) continue;
      result.mask[i] = 1;
      result.points.push_back({map.frame.centre(row, col), static_cast<double>(map.height[i]),
                               std::min(1.0, scale * excess)});
    }
  }
  return result;
}

std::vector<VegetationPoint> thinVegetation(const std::vector<VegetationPoint>& points,
                                            double voxel) {
  if (!(voxel > 0.0)) throw UsageError("the side of a thinning square must be positive");
  if (points.empty()) return {};
  const Squares squares(points, voxel);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    keys[i] = {squares.key(points[i]), static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<VegetationPoint> thinned;
  for (std::size_t i = 0; i < keys.size();) {
    VegetationPoint sum;
    const std::uint64_t key = keys[i].first;
    for (; i < keys.size() && keys[i].first == key; ++i) {
      const VegetationPoint& p = points[keys[i].second];
      sum.position += p.weight * p.position;
      sum.height += p.weight * p.height;
      sum.weight += p.weight;
    }
    if (sum.weight <= 0.0) continue;
    sum.position /= sum.weight;
    sum.height /= sum.weight;
    thinned.push_back(sum);
  }
  return thinned;
}

std::vector<VegetationPoint> thinToAtMost(const std::vector<VegetationPoint>& points,
                                          std::size_t count) {
  if (count < 4) throw UsageError("vegetation can be thinned to 4 points or more");
  if (points.size() <= count) return points;
  const Eigen::Vector2d extent = boxOf(points).sizes().cwiseMax(1e-3);
  // The squares that share the box evenly are too small or just right where the box is full; grow
  // them until they are few enough, then narrow the last step down.
  double small = 0.0;
  double large = std::max(std::sqrt(extent.prod() / static_cast<double>(count)),
                          0.1 * extent.maxCoeff() / static_cast<double>(count));
  if (Squares(points, large).occupied(points) <= count) {
    small = 0.1 * large;
  } else {
    do {
      small = large;
      large *= 1.3;
    } while (Squares(points, large).occupied(points) > count);
  }
  for (int i = 0; i < 6; ++i) {
    const double middle = 0.5 * (small + large);
    (Squares(points, middle).occupied(points) <= count ? large : small) = middle;
  }
  return thinVegetation(points, large);
}

}  // namespace agricolmap
