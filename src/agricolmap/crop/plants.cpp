#include "agricolmap/crop/plants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::crop {

namespace {

constexpr double kTouching = 3.0;  // length of green, in spacings, that rhythm alone does not part
constexpr double kShallow = 0.2;   // of a valley, of the lower top beside it
constexpr double kPlantSigma = 0.5;   // in spacings, of what is of a plant about its middle
constexpr double kSamePlant = 0.3;    // how far explanations may place it apart, in spacings
constexpr double kMostUnknown = 0.5;  // of a gap

/// The middle of what is green about a top, not beyond the valleys.
CropPlant plantAt(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                  double step, const Stretch& within, double middle, double half, double distance) {
  CropPlant plant;
  plant.along = middle;
  const double sigma = kPlantSigma * distance;
  double aside = 0.0;
  for (int round = 0; round < 5; ++round) {
    double w = 0.0;
    double ws = 0.0;
    double wt = 0.0;
    double area = 0.0;
    const double low = std::max(within.from, plant.along - 3.0 * sigma);
    const double high = std::min(within.to, plant.along + 3.0 * sigma);
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

/// Which pieces are of a hill that is so long, without a valley worth the name, that the rhythm
/// alone would say how many plants it is; and where these hills are.
std::vector<bool> closedPieces(const std::vector<Piece>& pieces, double distance,
                               std::vector<Stretch>& touching) {
  std::vector<bool> closed(pieces.size(), false);
  for (std::size_t begin = 0; begin < pieces.size();) {
    std::size_t end = begin + 1;
    while (end < pieces.size() && pieces[end - 1].parted < kShallow) ++end;
    const Piece& first = pieces[begin];
    const Piece& last = pieces[end - 1];
    const Stretch hill{std::max(first.from, first.middle - 0.5 * first.length),
                       std::min(last.to, last.middle + 0.5 * last.length)};
    if (hill.length() > kTouching * distance) {
      touching.push_back(hill);
      for (std::size_t i = begin; i < end; ++i) closed[i] = true;
    }
    begin = end;
  }
  return closed;
}

double unknownShare(const RowProfile& profile, const Stretch& stretch) {
  const int from = profile.indexAt(stretch.from);
  const int to = profile.indexAt(stretch.to);
  double known = 0.0;
  for (int i = from; i <= to; ++i) known += profile.known[static_cast<std::size_t>(i)];
  return 1.0 - known / (to - from + 1);
}

/// From which measured step on a gap is more likely than not, in spacings. Far more neighbours
/// stand a little less than 1.5 apart than a little more, and places err: a step that is measured
/// long is likely shorter. How much is by the error's share of how steps vary; of the error it is
/// known that it is no more than how plants lie aside of their line, of which half is taken.
double leastStep(const StandModel& model) {
  constexpr double kMostError = 0.25;
  const double error = model.aside / model.distance;
  const double steps = 2.0 * model.jitter * model.jitter + model.drift * model.drift;
  return 1.0 + (kGapSpacings - 1.0) / (1.0 - std::min(kMostError, error * error / steps));
}

/// From plant to plant; a stretch that could not be counted has plants at both of its ends.
std::vector<Stretch> gapsOf(const RowProfile& profile, const RowPlants& row,
                            const StandModel& model) {
  const double distance = model.distance;
  const double least = leastStep(model) * distance;
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
    if (between.length() < least) continue;
    if (unknownShare(profile, between) <= kMostUnknown) gaps.push_back(between);
  }
  return gaps;
}

}  // namespace

RowPlants findPlants(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                     const RowProfile& profile, const std::vector<Piece>& pieces,
                     const Chain& chain, const StandModel& model) {
  RowPlants row;
  row.variance = chain.variance;
  const std::vector<bool> closed = closedPieces(pieces, model.distance, row.touching);
  for (const PlantGroup& group : chain.candidates) {
    if (closed[group.first]) continue;
    const RowPlace place = line.at(group.middle);
    row.possible.push_back({place.point + group.aside * place.left(), group.probability});
  }
  for (const PlantGroup& group : chain.plants) {
    if (closed[group.first]) continue;
    const Stretch within{pieces[group.first].from, pieces[group.last].to};
    CropPlant plant =
        plantAt(frame, green, line, profile.step, within, group.middle, model.half, model.distance);
    // Beyond the border the curve goes on for a little.
    const Eigen::Vector2d cell = frame.cellOf(plant.place);
    if (!green.contains(static_cast<int>(std::lround(cell.y())),
                        static_cast<int>(std::lround(cell.x())))) {
      continue;
    }
    plant.height = std::numeric_limits<double>::quiet_NaN();
    plant.certainty = 0.0;
    for (const PlantGroup& other : chain.candidates) {
      if (std::abs(other.middle - group.middle) < kSamePlant * model.distance &&
          other.first <= group.last && other.last >= group.first) {
        plant.certainty += other.probability;
      }
    }
    plant.certainty = std::min(1.0, plant.certainty);
    row.plants.push_back(plant);
  }
  row.gaps = gapsOf(profile, row, model);
  return row;
}

}  // namespace agricolmap::crop
