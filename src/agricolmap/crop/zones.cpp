#include "agricolmap/crop/zones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::crop {

namespace {

constexpr double kTwoSided = 1.645;      // of nine in ten
constexpr double kRowEnd = 0.1;          // variance of plants at an end of a row: on the map or off
constexpr double kPieceStep = 0.1;       // of rows, when they are shared out to parts [m]
constexpr double kTouchingError = 0.25;  // of the number that stands for plants that touch

int zoneAt(const GridFrame& frame, const Zones& zones, const Eigen::Vector2d& point) {
  const Eigen::Vector2d at = frame.cellOf(point);
  const auto col = static_cast<int>(std::lround(at.x()));
  const auto row = static_cast<int>(std::lround(at.y()));
  return zones.contains(row, col) ? zones(row, col) : -1;
}

/// What is not yet a share.
struct Sums {
  double green = 0.0;
  double weed = 0.0;
  double plants = 0.0;    ///< expected
  double variance = 0.0;  ///< of them
  std::vector<double> heights;
};

void sumCells(const GridFrame& frame, const Zones& zones, const FieldFacts& field,
              const RowBands& bands, std::vector<StandFacts>& facts, std::vector<Sums>& sums) {
  const double cell = frame.cell * frame.cell;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    if (zones[i] < 0 || !std::isfinite(field.greenness.green[i])) continue;
    const auto z = static_cast<std::size_t>(zones[i]);
    facts[z].area += cell;
    if (field.greenness.green[i] > field.greenness.leaf) sums[z].green += cell;
    if (bands.band.empty() || bands.band[i] == Band::kOutside) continue;
    if (bands.band[i] != Band::kBetween) {
      continue;
    }
    facts[z].between += cell;
    if (field.weeds.mask[i] != 0) sums[z].weed += cell;
  }
}

/// What may be plants, and how uncertain their number is: explanations of a row that differ in one
/// place exclude one another, so a part has its share of the row's variance.
template <typename ZoneAt>
void shareDoubt(const RowPlants& stand, const ZoneAt& at, std::vector<Sums>& sums) {
  double doubt = 0.0;
  for (const PossiblePlant& plant : stand.possible) {
    doubt += plant.probability * (1.0 - plant.probability);
  }
  for (const PossiblePlant& plant : stand.possible) {
    const int zone = at(plant.place);
    if (zone < 0) continue;
    Sums& sum = sums[static_cast<std::size_t>(zone)];
    sum.plants += plant.probability;
    const double own = plant.probability * (1.0 - plant.probability);
    if (doubt > 0.0) sum.variance += stand.variance * own / doubt;
  }
}

void sumRows(const GridFrame& frame, const Zones& zones, const FieldFacts& field,
             std::vector<StandFacts>& facts, std::vector<Sums>& sums) {
  const auto at = [&](const Eigen::Vector2d& point) { return zoneAt(frame, zones, point); };
  const auto share = [&](const RowLine& line, const Stretch& stretch, auto&& add) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(stretch.length() / kPieceStep)));
    for (int i = 0; i < pieces; ++i) {
      const double s = stretch.from + stretch.length() * (i + 0.5) / pieces;
      const int zone = at(line.at(s).point);
      if (zone >= 0) add(static_cast<std::size_t>(zone), stretch.length() / pieces);
    }
  };
  for (const FieldRow& row : field.rows.rows) {
    share(row.line, {0.0, row.line.length()},
          [&](std::size_t zone, double part) { facts[zone].row_length += part; });
    for (const double end : {0.0, row.line.length()}) {
      const int zone = at(row.line.at(end).point);
      if (zone >= 0) sums[static_cast<std::size_t>(zone)].variance += kRowEnd;
    }
    for (const Stretch& stretch : row.stand.touching) {
      share(row.line, stretch,
            [&](std::size_t zone, double part) { facts[zone].uncounted += part; });
    }
    for (const CropPlant& plant : row.stand.plants) {
      const int zone = at(plant.place);
      if (zone < 0) continue;
      const auto z = static_cast<std::size_t>(zone);
      ++facts[z].counted;
    }
    shareDoubt(row.stand, at, sums);
    for (const Stretch& gap : row.stand.gaps) {
      const int zone = at(row.line.at(0.5 * (gap.from + gap.to)).point);
      if (zone < 0) continue;
      ++facts[static_cast<std::size_t>(zone)].gaps;
      facts[static_cast<std::size_t>(zone)].gap_length += gap.length();
    }
  }
}

HeightRanks ranksOf(std::vector<double>& heights) {
  if (heights.empty()) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, none};
  }
  return {quantile(heights, 0.1), median(heights), quantile(heights, 0.9)};
}

void finish(const FieldFacts& field, StandFacts& facts, Sums& sums) {
  facts.cover = facts.area > 0.0 ? sums.green / facts.area : 0.0;
  facts.weeds = facts.between > 0.0 ? sums.weed / facts.between : 0.0;
  facts.height = ranksOf(sums.heights);
  const double distance = field.rows.spacing.distance;
  if (!field.countable) return;
  const double touching = facts.uncounted / distance;
  facts.plants = sums.plants + touching;
  const double error = kTouchingError * touching;
  const double model = field.rows.model_error * facts.plants;
  const double spread = kTwoSided * std::sqrt(sums.variance + error * error + model * model);
  facts.plants_low = std::max(0.0, facts.plants - spread);
  facts.plants_high = facts.plants + spread;
}

}  // namespace

Zones squareZones(const GridFrame& frame, const Eigen::Vector2d& origin, double side,
                  std::vector<GridSquare>& squares) {
  Zones zones(frame.rows, frame.cols, -1);
  std::map<std::pair<std::int64_t, std::int64_t>, std::int32_t> numbers;
  for (int r = 0; r < frame.rows; ++r) {
    const auto y =
        static_cast<std::int64_t>(std::floor((frame.centre(r, 0).y() + origin.y()) / side));
    std::int64_t last = std::numeric_limits<std::int64_t>::min();
    std::int32_t number = -1;
    for (int c = 0; c < frame.cols; ++c) {
      const auto x =
          static_cast<std::int64_t>(std::floor((frame.centre(r, c).x() + origin.x()) / side));
      if (x != last) {
        number =
            numbers.try_emplace({y, x}, static_cast<std::int32_t>(numbers.size())).first->second;
        last = x;
      }
      zones(r, c) = number;
    }
  }
  squares.resize(numbers.size());
  for (const auto& [place, number] : numbers) {
    GridSquare& square = squares[static_cast<std::size_t>(number)];
    square.side = side;
    square.corner = side * Eigen::Vector2d(static_cast<double>(place.second),
                                           static_cast<double>(place.first)) -
                    origin;
  }
  return zones;
}

Zones plotZones(const GridFrame& frame, const std::vector<Plot>& plots) {
  Zones zones(frame.rows, frame.cols, -1);
  for (std::size_t k = 0; k < plots.size(); ++k) {
    const std::vector<Eigen::Vector2d>& corners = plots[k].corners;
    for (int r = 0; r < frame.rows; ++r) {
      // Where the border crosses the line of the cells' centres, west to east: in, out, in, out.
      const double y = frame.centre(r, 0).y();
      std::vector<double> crossings;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d& a = corners[i];
        const Eigen::Vector2d& b = corners[(i + 1) % corners.size()];
        if ((a.y() <= y) == (b.y() <= y)) continue;
        crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        const double from = std::ceil(frame.cellOf({crossings[i], y}).x());
        const double to = std::floor(frame.cellOf({crossings[i + 1], y}).x());
        const int first = static_cast<int>(std::clamp(from, 0.0, static_cast<double>(frame.cols)));
        const int last = static_cast<int>(std::clamp(to, -1.0, frame.cols - 1.0));
        for (int c = first; c <= last; ++c) zones(r, c) = static_cast<std::int32_t>(k);
      }
    }
  }
  return zones;
}

std::vector<StandFacts> zoneFacts(const GridFrame& frame, const Zones& zones, std::size_t count,
                                  const FieldFacts& field, const RowBands& bands,
                                  const std::vector<PlantTop>& tops) {
  std::vector<StandFacts> facts(count);
  std::vector<Sums> sums(count);
  sumCells(frame, zones, field, bands, facts, sums);
  sumRows(frame, zones, field, facts, sums);
  for (const WeedPatch& patch : field.weeds.patches) {
    const int zone = zoneAt(frame, zones, patch.place);
    if (zone >= 0) ++facts[static_cast<std::size_t>(zone)].patches;
  }
  for (const PlantTop& top : tops) {
    const int zone = zoneAt(frame, zones, top.place);
    if (zone >= 0) sums[static_cast<std::size_t>(zone)].heights.push_back(top.height);
  }
  for (std::size_t i = 0; i < count; ++i) finish(field, facts[i], sums[i]);
  return facts;
}

}  // namespace agricolmap::crop
