#include "agricolmap/fuse/drone_heights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace agricolmap::fuse {
namespace {

constexpr double kClass = 0.02;           ///< width of a class at least [m]
constexpr std::size_t kLeastCells = 300;  ///< in a class
constexpr double kTrim = 0.05;            ///< of the differences at either end
constexpr double kLargest = 1.0;          ///< differences beyond are no heights of plants [m]

struct Sample {
  double height = 0.0;      ///< of the fixed cloud above the ground [m]
  double difference = 0.0;  ///< strip − fixed cloud [m]
};

/// Which curve a cell of the fixed cloud belongs to, and where on it.
struct Kind {
  std::size_t curve = 0;
  double height = 0.0;
};

Kind kindOf(const FixedHeights& fixed, std::size_t i) {
  const double height =
      static_cast<double>(fixed.map.height[i]) - static_cast<double>(fixed.ground[i]);
  if (std::isnan(height)) return {2, 0.0};
  return {fixed.cover[i] >= 0.5F ? std::size_t{1} : std::size_t{0}, height};
}

/// Calls `take(curve, sample)` for every cell of a strip that both show, those beside what it did
/// not see, too: tall plants hide what is behind them, so that far from every hole lies what is
/// low, and plants in maize would seem 8 cm lower than they are.
template <typename Take>
void samplesOf(const FixedHeights& fixed, const StripCells& strip, const Take& take) {
  for (int r = 0; r < strip.depth.rows(); ++r) {
    for (int c = 0; c < strip.depth.cols(); ++c) {
      const int row = strip.row + r, col = strip.col + c;
      if (strip.depth(r, c) <= 0.0F || !fixed.map.valid(row, col)) continue;
      const Kind kind = kindOf(fixed, fixed.map.height.index(row, col));
      const Sample sample{kind.height, static_cast<double>(strip.coarse.height(r, c)) -
                                           static_cast<double>(fixed.map.height(row, col))};
      if (std::abs(sample.difference) < kLargest) take(kind.curve, sample);
    }
  }
}

/// Mean and deviation without the tails.
void addClass(std::vector<Sample>::const_iterator begin, std::vector<Sample>::const_iterator end,
              HeightCurve& curve) {
  std::vector<double> differences;
  double height = 0.0;
  for (auto sample = begin; sample != end; ++sample) {
    differences.push_back(sample->difference);
    height += sample->height;
  }
  std::sort(differences.begin(), differences.end());
  const auto cut = static_cast<std::size_t>(kTrim * static_cast<double>(differences.size()));
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = cut; i < differences.size() - cut; ++i) {
    sum += differences[i];
    squares += differences[i] * differences[i];
  }
  const auto count = static_cast<double>(differences.size() - 2 * cut);
  const double mean = sum / count;
  curve.height.push_back(height / static_cast<double>(end - begin));
  curve.shift.push_back(mean);
  curve.deviation.push_back(std::sqrt(std::max(0.0, squares / count - mean * mean)));
}

HeightCurve curveOf(std::vector<Sample> samples) {
  HeightCurve curve;
  if (samples.size() < kLeastCells) return curve;
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return a.height != b.height ? a.height < b.height : a.difference < b.difference;
  });
  std::size_t begin = 0;
  while (begin < samples.size()) {
    std::size_t end = std::min(samples.size(), begin + kLeastCells);
    while (end < samples.size() && samples[end].height - samples[begin].height < kClass) ++end;
    if (samples.size() - end < kLeastCells) end = samples.size();
    addClass(samples.cbegin() + static_cast<std::ptrdiff_t>(begin),
             samples.cbegin() + static_cast<std::ptrdiff_t>(end), curve);
    begin = end;
  }
  return curve;
}

double between(const std::vector<double>& places, const std::vector<double>& values, double at) {
  if (at <= places.front()) return values.front();
  if (at >= places.back()) return values.back();
  const auto next = std::upper_bound(places.begin(), places.end(), at);
  const auto i = static_cast<std::size_t>(next - places.begin());
  const double share = (at - places[i - 1]) / std::max(1e-9, places[i] - places[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

/// What the curves leave in the mean of each strip.
double betweenStrips(const FixedHeights& fixed, const HeightBias& bias,
                     const std::vector<const StripCells*>& strips) {
  std::vector<double> means;
  for (const StripCells* strip : strips) {
    double sum = 0.0, count = 0.0;
    samplesOf(fixed, *strip, [&](std::size_t kind, const Sample& sample) {
      const HeightCurve& curve = bias.curves[kind];
      if (curve.empty()) return;
      sum += sample.difference - curve.shiftAt(sample.height);
      count += 1.0;
    });
    if (count >= static_cast<double>(kLeastCells)) means.push_back(sum / count);
  }
  if (means.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  double mean = 0.0, squares = 0.0;
  for (const double value : means) mean += value / static_cast<double>(means.size());
  for (const double value : means) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(means.size() - 1));
}

}  // namespace

double HeightCurve::shiftAt(double height_above_ground) const {
  return between(height, shift, height_above_ground);
}

double HeightCurve::deviationAt(double height_above_ground) const {
  return between(height, deviation, height_above_ground);
}

std::optional<HeightShift> HeightBias::at(const FixedHeights& fixed, std::size_t i) const {
  if (!fixed.map.valid(i)) return std::nullopt;
  const Kind kind = kindOf(fixed, i);
  const HeightCurve& curve = curves[kind.curve];
  if (curve.empty()) return std::nullopt;
  const double between = std::isnan(between_strips) ? 0.0 : between_strips;
  return HeightShift{curve.shiftAt(kind.height),
                     std::hypot(curve.deviationAt(kind.height), between)};
}

std::optional<HeightBias> heightBiasOf(const FixedHeights& fixed,
                                       const std::vector<const StripCells*>& strips) {
  std::array<std::vector<Sample>, 3> samples;
  for (const StripCells* strip : strips) {
    samplesOf(fixed, *strip,
              [&](std::size_t kind, const Sample& sample) { samples[kind].push_back(sample); });
  }
  HeightBias bias;
  bool any = false;
  for (std::size_t kind = 0; kind < samples.size(); ++kind) {
    bias.cells += samples[kind].size();
    bias.curves[kind] = curveOf(std::move(samples[kind]));
    any = any || !bias.curves[kind].empty();
  }
  if (!any) return std::nullopt;
  bias.between_strips = betweenStrips(fixed, bias, strips);
  return bias;
}

}  // namespace agricolmap::fuse
