#include "agricolmap/crop/row_profile.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parabola.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::crop {

namespace {

constexpr double kLeastDistance = 0.05;  // of plants [m]
constexpr double kMostDistance = 0.60;   // [m]
constexpr double kAround = 1.0;          // over which a row's usual greenness is taken [m]
constexpr double kLeastClearness = 0.03;
constexpr double kPlantWide = 0.1;  // pieces of row that know nothing of one another [m]
constexpr double kLeafy = 0.2;      // greenness that is no soil's noise
constexpr double kChance = 1.5;     // deviations of the correlation of such pieces

/// The curve less its mean over a metre about, its highest tops cut: one large plant is not more
/// rhythm than a small one.
std::vector<double> rhythmOf(const RowProfile& row) {
  std::vector<double> values = row.green;
  std::vector<double> sorted = values;
  const double top = quantile(sorted, 0.85);
  for (double& value : values) value = std::min(value, top);
  const int reach = std::max(1, static_cast<int>(0.5 * kAround / row.step));
  std::vector<double> sum(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sum[i + 1] = sum[i] + values[i];
  std::vector<double> result(values.size());
  const int count = row.size();
  for (int i = 0; i < count; ++i) {
    const auto from = static_cast<std::size_t>(std::max(0, i - reach));
    const auto to = static_cast<std::size_t>(std::min(count, i + reach + 1));
    result[static_cast<std::size_t>(i)] = values[static_cast<std::size_t>(i)] -
                                          (sum[to] - sum[from]) / static_cast<double>(to - from);
  }
  return result;
}

/// The first lag at which the correlation rises by `least` of its beginning over the troughs on
/// either side.
PlantSpacing firstCrest(const std::vector<double>& correlation, double step, double least) {
  double trough = correlation.front();
  std::size_t crest = 0;
  for (std::size_t lag = 1; lag + 1 < correlation.size(); ++lag) {
    const double here = correlation[lag];
    if (crest == 0 || here > correlation[crest]) {
      if (crest == 0) trough = std::min(trough, here);
      if (here - trough >= least * correlation.front()) crest = lag;
    } else if (correlation[crest] - here >= least * correlation.front()) {
      break;
    }
  }
  const double distance = static_cast<double>(crest) * step;
  if (crest == 0 || distance < kLeastDistance || distance > kMostDistance) return {};
  const double clearness = (correlation[crest] - trough) / correlation.front();
  return {
      step * (static_cast<double>(crest) +
              parabolaVertex(correlation[crest - 1], correlation[crest], correlation[crest + 1])),
      clearness};
}

}  // namespace

int RowProfile::indexAt(double s) const {
  return std::clamp(static_cast<int>(std::floor(s / step)), 0, size() - 1);
}

RowProfile profileOf(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                     double half, double spacing) {
  const double step = std::min(frame.cell, 0.02);
  const Straightened around = straighten(frame, green, line, 0.5 * spacing, step);
  RowProfile profile;
  profile.step = step;
  profile.length = line.length();
  const int cols = around.values.cols();
  profile.green.resize(static_cast<std::size_t>(cols), 0.0);
  profile.known.resize(static_cast<std::size_t>(cols), 0.0);
  profile.leafy.resize(static_cast<std::size_t>(cols), 0.0);
  profile.lean.resize(static_cast<std::size_t>(cols), 0.0);
  std::vector<double> between;
  const int inside = std::max(1, static_cast<int>(half / step));
  const int middle = around.middle();
  for (int c = 0; c < cols; ++c) {
    double sum = 0.0;
    double known = 0.0;
    double beside = 0.0;
    double beside_known = 0.0;
    for (int r = 0; r < around.values.rows(); ++r) {
      const auto value = static_cast<double>(around.values(r, c));
      if (!std::isfinite(value)) continue;
      const int aside = std::abs(r - middle);
      if (aside <= inside) {
        sum += value;
        known += 1.0;
        if (value > kLeafy) {
          profile.leafy[static_cast<std::size_t>(c)] += value * step;
          profile.lean[static_cast<std::size_t>(c)] += value * step * (r - middle) * step;
        }
      } else if (aside * step > 0.35 * spacing) {
        beside += value;
        beside_known += 1.0;
      }
    }
    const double width = (2.0 * inside + 1.0) * step;
    const auto i = static_cast<std::size_t>(c);
    profile.known[i] = known / (2.0 * inside + 1.0);
    if (known > 0.0) profile.green[i] = width * sum / known;
    if (beside_known > 0.0) {
      // Of cells that are independent, so many as the row has.
      between.push_back(beside / beside_known * width * std::sqrt(beside_known / known));
    }
  }
  std::erase_if(between, [](double value) { return !std::isfinite(value); });
  if (!between.empty()) {
    std::vector<double> sorted = between;
    const double usual = median(sorted);
    for (double& value : between) value = std::abs(value - usual);
    profile.noise = deviationFrom(between);
  }
  return profile;
}

RowProfile smoothed(const RowProfile& profile, double sigma) {
  RowProfile result = profile;
  const int reach = std::max(1, static_cast<int>(std::ceil(3.0 * sigma / profile.step)));
  std::vector<double> kernel;
  for (int k = -reach; k <= reach; ++k) {
    const double u = k * profile.step / sigma;
    kernel.push_back(std::exp(-0.5 * u * u));
  }
  for (int i = 0; i < profile.size(); ++i) {
    double sum = 0.0;
    double weight = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      const int j = i + k;
      if (j < 0 || j >= profile.size()) continue;
      const double w =
          kernel[static_cast<std::size_t>(k + reach)] * profile.known[static_cast<std::size_t>(j)];
      sum += w * profile.green[static_cast<std::size_t>(j)];
      weight += w;
    }
    result.green[static_cast<std::size_t>(i)] = weight > 1e-6 ? sum / weight : 0.0;
  }
  // Neighbours share what they come from: about two samples are one.
  const double samples = std::max(1.0, 3.5 * sigma / profile.step / 2.0);
  result.noise = profile.noise / std::sqrt(samples);
  return result;
}

PlantSpacing plantSpacing(const std::vector<RowProfile>& rows) {
  if (rows.empty()) return {};
  const double step = rows.front().step;
  double length = 0.0;
  const int lags = static_cast<int>(1.6 * kMostDistance / step);
  std::vector<double> sum(static_cast<std::size_t>(lags) + 1, 0.0);
  for (const RowProfile& row : rows) {
    if (row.length < 2.0 * kMostDistance) continue;
    length += row.length;
    const std::vector<double> rhythm = rhythmOf(smoothed(row, std::max(0.015, step)));
    const int count = row.size();
    for (int lag = 0; lag <= std::min(lags, count - 1); ++lag) {
      double part = 0.0;
      for (int i = 0; i + lag < count; ++i) {
        part += rhythm[static_cast<std::size_t>(i)] * rhythm[static_cast<std::size_t>(i + lag)];
      }
      sum[static_cast<std::size_t>(lag)] += part;
    }
  }
  if (!(sum[0] > 0.0)) return {};
  return firstCrest(sum, step, std::max(kLeastClearness, kChance / std::sqrt(length / kPlantWide)));
}

}  // namespace agricolmap::crop
