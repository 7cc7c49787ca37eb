#include "agricolmap/crop/plants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::crop {

namespace {

constexpr double kSmoothing = 0.13;  // of the curve, in spacings
constexpr double kSharpening = 2.0;
constexpr double kLeastTop = 0.08;    // of a usual plant's
constexpr double kNoiseTop = 1.5;     // deviations of the soil's noise in the sharpened curve
constexpr double kTouching = 1.55;    // length of green, in spacings, that is more than a plant
constexpr double kEdge = 0.25;        // of a plant's top: where its green ends
constexpr double kMostUnknown = 0.5;  // of a gap

/// A top of the curve with the valleys about it.
struct Top {
  int index = 0;
  int left = 0;   ///< lowest sample towards the top before
  int right = 0;  ///< and after
  double height = 0.0;
  double parted = 1.0;  ///< how deep the shallower valley is, of the lower top beside it
};

/// How deep a valley two tops need between them to be two plants, by their distance in spacings:
/// plants of one drill seldom stand nearer than half a spacing, leaves of one plant do.
double depthNeeded(double spacings) {
  if (spacings < 0.33) return 2.0;
  return std::clamp(0.5 - 1.2 * (spacings - 0.33), 0.06, 0.5);
}

std::vector<Top> topsOf(const RowProfile& curve) {
  std::vector<Top> tops;
  const std::vector<double>& y = curve.green;
  const int count = curve.size();
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool up = i == 0 || y[k] > y[k - 1];
    const bool down = i + 1 == count || y[k] >= y[k + 1];
    if (up && down && y[k] > 0.0) tops.push_back({i, 0, count - 1, y[k]});
  }
  return tops;
}

/// Smoothed, and what stands out of a neighbourhood twice as wide made to stand out more: two
/// plants that the map blurs into one hill become two tops again.
RowProfile sharpened(const RowProfile& profile, double distance) {
  RowProfile fine = smoothed(profile, kSmoothing * distance);
  const RowProfile wide = smoothed(profile, 2.0 * kSmoothing * distance);
  for (std::size_t i = 0; i < fine.green.size(); ++i) {
    fine.green[i] += kSharpening * (fine.green[i] - wide.green[i]);
  }
  // Of white noise under Gaussians of σ and 2σ, which correlate by √0.8.
  constexpr double kOwn = 1.0 + kSharpening;
  fine.noise *= std::sqrt(kOwn * kOwn + 0.5 * kSharpening * kSharpening -
                          2.0 * kOwn * kSharpening * std::sqrt(0.4));
  return fine;
}

int lowestBetween(const RowProfile& curve, int from, int to) {
  const auto begin = curve.green.begin();
  return static_cast<int>(std::min_element(begin + from, begin + to + 1) - begin);
}

/// How clearly two neighbouring tops part.
double parting(const RowProfile& curve, const Top& a, const Top& b) {
  const int valley = lowestBetween(curve, a.index, b.index);
  const double low = std::max(0.0, curve.green[static_cast<std::size_t>(valley)]);
  return 1.0 - low / std::min(a.height, b.height);
}

/// Takes away the lower of two tops that do not part, the worst first, until all do.
void mergeTops(const RowProfile& curve, double distance, std::vector<Top>& tops) {
  while (tops.size() > 1) {
    double worst = 0.0;
    std::size_t at = tops.size();
    for (std::size_t i = 0; i + 1 < tops.size(); ++i) {
      const double apart = (tops[i + 1].index - tops[i].index) * curve.step / distance;
      const double lacking = depthNeeded(apart) - parting(curve, tops[i], tops[i + 1]);
      if (lacking > worst) {
        worst = lacking;
        at = i;
      }
    }
    if (at == tops.size()) return;
    const bool first = tops[at].height < tops[at + 1].height;
    tops.erase(tops.begin() + static_cast<std::ptrdiff_t>(first ? at : at + 1));
  }
}

void setValleys(const RowProfile& curve, std::vector<Top>& tops) {
  for (std::size_t i = 0; i + 1 < tops.size(); ++i) {
    const int valley = lowestBetween(curve, tops[i].index, tops[i + 1].index);
    const double parted = parting(curve, tops[i], tops[i + 1]);
    tops[i].right = valley;
    tops[i + 1].left = valley;
    tops[i].parted = std::min(tops[i].parted, parted);
    tops[i + 1].parted = std::min(tops[i + 1].parted, parted);
  }
}

/// Where the green of a top ends, between its valleys.
Stretch greenOf(const RowProfile& curve, const Top& top) {
  const double edge = kEdge * top.height;
  int from = top.index;
  while (from > top.left && curve.green[static_cast<std::size_t>(from - 1)] > edge) --from;
  int to = top.index;
  while (to < top.right && curve.green[static_cast<std::size_t>(to + 1)] > edge) ++to;
  return {from * curve.step, (to + 1) * curve.step};
}

/// The middle of what is green about a top, not beyond the valleys.
CropPlant plantAt(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                  const RowProfile& curve, const Top& top, double half, double distance) {
  CropPlant plant;
  plant.along = curve.along(top.index);
  const double from = top.left * curve.step;
  const double to = (top.right + 1) * curve.step;
  const double sigma = 0.22 * distance;
  double aside = 0.0;
  const double step = curve.step;
  for (int round = 0; round < 5; ++round) {
    double w = 0.0;
    double ws = 0.0;
    double wt = 0.0;
    double area = 0.0;
    const double low = std::max(from, plant.along - 3.0 * sigma);
    const double high = std::min(to, plant.along + 3.0 * sigma);
    for (double s = low; s <= high; s += step) {
      const RowPlace place = line.at(s);
      for (double t = -half; t <= half; t += step) {
        const auto value =
            static_cast<double>(knownValue(frame, green, place.point + t * place.left()));
        if (!(value > 0.2)) continue;
        const double u = ((s - plant.along) * (s - plant.along) + (t - aside) * (t - aside)) /
                         (2.0 * sigma * sigma);
        const double weight = value * std::exp(-u);
        w += weight;
        ws += weight * s;
        wt += weight * t;
        area += std::min(1.0, value) * step * step;
      }
    }
    if (!(w > 0.0)) break;
    plant.along = ws / w;
    aside = wt / w;
    plant.area = area;
  }
  const RowPlace place = line.at(plant.along);
  plant.place = place.point + aside * place.left();
  return plant;
}

double unknownShare(const RowProfile& profile, const Stretch& stretch) {
  const int from = profile.indexAt(stretch.from);
  const int to = profile.indexAt(stretch.to);
  double known = 0.0;
  for (int i = from; i <= to; ++i) known += profile.known[static_cast<std::size_t>(i)];
  return 1.0 - known / (to - from + 1);
}

/// From plant to plant; a stretch that could not be counted has plants at both of its ends.
std::vector<Stretch> gapsOf(const RowProfile& profile, const RowPlants& row, double distance) {
  std::vector<double> stems;
  for (const CropPlant& plant : row.plants) stems.push_back(plant.along);
  for (const Stretch& stretch : row.touching) {
    for (double s = stretch.from + 0.5 * distance; s < stretch.to - 0.25 * distance;
         s += distance) {
      stems.push_back(s);
    }
    stems.push_back(std::max(stretch.from, stretch.to - 0.5 * distance));
  }
  std::sort(stems.begin(), stems.end());
  std::vector<Stretch> gaps;
  for (std::size_t i = 0; i + 1 < stems.size(); ++i) {
    const Stretch between{stems[i], stems[i + 1]};
    if (between.length() < kGapSpacings * distance) continue;
    if (unknownShare(profile, between) <= kMostUnknown) gaps.push_back(between);
  }
  return gaps;
}

}  // namespace

double usualTop(const std::vector<RowProfile>& rows, double distance) {
  std::vector<double> heights;
  for (const RowProfile& row : rows) {
    const RowProfile curve = sharpened(row, distance);
    std::vector<Top> tops = topsOf(curve);
    std::erase_if(tops, [&](const Top& top) { return top.height < kNoiseTop * curve.noise; });
    mergeTops(curve, distance, tops);
    for (const Top& top : tops) heights.push_back(top.height);
  }
  return heights.empty() ? 0.0 : median(heights);
}

RowPlants findPlants(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                     const RowProfile& profile, double half, double distance, double usual) {
  RowPlants row;
  const RowProfile curve = sharpened(profile, distance);
  const double least = std::max(kNoiseTop * curve.noise, kLeastTop * usual);
  std::vector<Top> tops = topsOf(curve);
  std::erase_if(tops, [&](const Top& top) { return top.height < 0.5 * least; });
  mergeTops(curve, distance, tops);
  for (const Top& top : tops) {
    // Something green, but less than a plant: perhaps one after all.
    if (top.height < least) row.unseen += std::max(0.0, top.height / least - 0.5);
  }
  std::erase_if(tops, [&](const Top& top) { return top.height < least; });
  setValleys(curve, tops);
  for (const Top& top : tops) {
    const Stretch green_part = greenOf(curve, top);
    if (green_part.length() > kTouching * distance) {
      row.touching.push_back(green_part);
      continue;
    }
    CropPlant plant = plantAt(frame, green, line, curve, top, half, distance);
    // Beyond the border the curve goes on for a little.
    const Eigen::Vector2d cell = frame.cellOf(plant.place);
    if (!green.contains(static_cast<int>(std::lround(cell.y())),
                        static_cast<int>(std::lround(cell.x())))) {
      continue;
    }
    plant.height = std::numeric_limits<double>::quiet_NaN();
    const double by_size = std::clamp(0.5 + 0.5 * (top.height / least - 1.0), 0.5, 1.0);
    const double by_valley = std::clamp(0.5 + top.parted, 0.5, 1.0);
    plant.certainty = by_size * by_valley;
    row.plants.push_back(plant);
  }
  row.gaps = gapsOf(profile, row, distance);
  return row;
}

}  // namespace agricolmap::crop
