#include "agricolmap/crop/facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/crop/zones.hpp"

namespace agricolmap::crop {

void listOptions(OptionTable& table, FactsOptions& options) {
  table.group("rows", options.rows);
  table.group("vegetation", options.vegetation);
  table.number("grid", options.grid, 0.1, 1000.0, "m", "side of the squares").basic();
}

namespace {

constexpr double kTopReach = 0.35;  // of the plants' distance
constexpr double kTopShare = 0.9;   // of a plant's leaves that lie below what is called its top
constexpr double kPatch = 0.25;     // where there are no rows: side of what has a top [m]

/// Height that `kTopShare` of the leaves within `reach` of a place are below; NaN without leaves.
double topAt(const View& view, const Greenness& greenness, const Eigen::Vector2d& place,
             double reach) {
  const Eigen::Vector2d at = view.frame.cellOf(place);
  const int cells = std::max(1, static_cast<int>(reach / view.frame.cell));
  const auto col = static_cast<int>(std::lround(at.x()));
  const auto row = static_cast<int>(std::lround(at.y()));
  std::vector<float> heights;
  for (int r = row - cells; r <= row + cells; ++r) {
    for (int c = col - cells; c <= col + cells; ++c) {
      if (!view.height.contains(r, c) || !std::isfinite(view.height(r, c))) continue;
      if (!(greenness.green(r, c) > greenness.leaf)) continue;
      if ((r - row) * (r - row) + (c - col) * (c - col) > cells * cells) continue;
      heights.push_back(view.height(r, c));
    }
  }
  if (heights.empty()) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(quantile(heights, kTopShare));
}

std::vector<PlantTop> topsOfRows(const View& view, FieldFacts& facts) {
  const double known = facts.rows.spacing.distance;
  const double distance = known > 0.0 ? known : kPatch;
  std::vector<PlantTop> tops;
  for (FieldRow& row : facts.rows.rows) {
    for (CropPlant& plant : row.stand.plants) {
      plant.height = topAt(view, facts.greenness, plant.place, kTopReach * distance);
      tops.push_back({plant.place, plant.height});
    }
    for (const Stretch& stretch : row.stand.touching) {
      for (double s = stretch.from + 0.5 * distance; s < stretch.to; s += distance) {
        const Eigen::Vector2d place = row.line.at(s).point;
        tops.push_back({place, topAt(view, facts.greenness, place, kTopReach * distance)});
      }
    }
  }
  return tops;
}

std::vector<PlantTop> topsEverywhere(const View& view, const Greenness& greenness) {
  std::vector<PlantTop> tops;
  const double width = view.frame.cell * view.frame.cols;
  const double height = view.frame.cell * view.frame.rows;
  for (double y = 0.5 * kPatch; y < height; y += kPatch) {
    for (double x = 0.5 * kPatch; x < width; x += kPatch) {
      const Eigen::Vector2d place = view.frame.corner + Eigen::Vector2d(x, y);
      tops.push_back({place, topAt(view, greenness, place, 0.5 * kPatch)});
    }
  }
  return tops;
}

/// Whether the map shows something near a place that it does not show.
bool atBorder(const GridFrame& frame, const Raster<float>& green, const Eigen::Vector2d& place,
              double reach) {
  if (std::isfinite(knownValue(frame, green, place))) return false;
  for (int k = 0; k < 8; ++k) {
    const double turn = 0.25 * std::numbers::pi * k;
    const Eigen::Vector2d beside = place + reach * Eigen::Vector2d(std::cos(turn), std::sin(turn));
    if (std::isfinite(knownValue(frame, green, beside))) return true;
  }
  return false;
}

constexpr double kBorderStep = 0.1;   // along rows that run along a border [m]
constexpr double kLeastBorder = 1.0;  // less is where a row's end meets one that it crosses [m]

/// Plants of rows that run along the border of what the map shows: it has their leaves, but too
/// little of them for a row.
double plantsAtBorder(const View& view, const FieldFacts& field, const RowBands& bands) {
  const double reach = field.rows.plant_half;
  double length = 0.0;
  for (const FieldRow& row : field.rows.rows) {
    for (const double side : {-1.0, 1.0}) {
      double free = 0.0;
      for (double s = 0.5 * kBorderStep; s < row.line.length(); s += kBorderStep) {
        const RowPlace place = row.line.at(s);
        const Eigen::Vector2d next = place.point + side * field.rows.row_spacing * place.left();
        const Eigen::Vector2d at = view.frame.cellOf(next);
        const auto r = static_cast<int>(std::lround(at.y()));
        const auto c = static_cast<int>(std::lround(at.x()));
        const bool taken = bands.band.contains(r, c) && bands.band(r, c) != Band::kOutside;
        if (!taken && atBorder(view.frame, field.greenness.green, next, reach)) {
          free += kBorderStep;
        }
      }
      if (free >= kLeastBorder) length += free;
    }
  }
  return length / field.rows.spacing.distance;
}

/// Where a row runs so near to the border, for a while, that half of its plants' leaves may lie
/// beyond it; by steps along the row.
std::vector<bool> halfSeen(const GridFrame& frame, const FieldFacts& field, const RowLine& line) {
  const double reach = 0.7 * field.rows.plant_half;
  std::vector<bool> half;
  std::size_t run = 0;
  const auto endRun = [&] {
    if (kBorderStep * static_cast<double>(run) < kLeastBorder) {
      std::fill_n(half.rbegin(), run, false);
    }
    run = 0;
  };
  for (double s = 0.5 * kBorderStep; s < line.length(); s += kBorderStep) {
    const RowPlace place = line.at(s);
    const auto shown = [&](double aside) {
      return std::isfinite(
          knownValue(frame, field.greenness.green, place.point + aside * place.left()));
    };
    const bool here = !shown(-reach) || !shown(reach);
    if (!here) endRun();
    half.push_back(here);
    if (here) ++run;
  }
  endRun();
  return half;
}

/// A row that was found, but runs along the border: plants that were counted may stand beyond it,
/// and as many as fit may have been missed.
void widenAtBorder(const GridFrame& frame, const FieldFacts& field, const FieldRow& row,
                   StandFacts& facts) {
  const std::vector<bool> half = halfSeen(frame, field, row.line);
  const auto steps = static_cast<double>(std::count(half.begin(), half.end(), true));
  double counted = 0.0;
  for (const CropPlant& plant : row.stand.plants) {
    const auto step = static_cast<std::size_t>(std::max(0.0, plant.along) / kBorderStep);
    if (step < half.size() && half[step]) counted += 1.0;
  }
  facts.plants_low = std::max(0.0, facts.plants_low - counted);
  facts.plants_high += std::max(0.0, steps * kBorderStep / field.rows.spacing.distance - counted);
}

StandFacts totalOf(const View& view, const FieldFacts& field, const RowBands& bands,
                   const std::vector<PlantTop>& tops) {
  const Zones all(view.frame.rows, view.frame.cols, 0);
  StandFacts total = zoneFacts(view.frame, all, 1, field, bands, tops).front();
  if (!field.countable) return total;
  for (const FieldRow& row : field.rows.rows) widenAtBorder(view.frame, field, row, total);
  total.plants_high += plantsAtBorder(view, field, bands);
  return total;
}

}  // namespace

FieldFacts factsOf(const View& view, const Eigen::Vector2d& origin, const std::vector<Plot>& plots,
                   const FactsOptions& options) {
  FieldFacts facts;
  facts.greenness = greennessOf(view, options.vegetation);
  facts.per_plot.resize(plots.size());
  if (!facts.greenness.known()) return facts;
  facts.rows = findRows(view.frame, facts.greenness.green, options.rows);
  facts.countable = facts.rows.spacing.distance > 0.0;
  const RowBands bands = rowBands(view.frame, facts.rows);
  facts.weeds = findWeeds(view.frame, facts.greenness, bands);
  std::vector<PlantTop> tops =
      facts.rows.rows.empty() ? topsEverywhere(view, facts.greenness) : topsOfRows(view, facts);
  std::erase_if(tops, [](const PlantTop& top) { return !std::isfinite(top.height); });
  facts.total = totalOf(view, facts, bands, tops);
  facts.per_row = zoneFacts(view.frame, bands.row, facts.rows.rows.size(), facts, bands, tops);
  for (std::size_t i = 0; facts.countable && i < facts.per_row.size(); ++i) {
    widenAtBorder(view.frame, facts, facts.rows.rows[i], facts.per_row[i]);
  }
  std::vector<GridSquare> squares;
  const Zones square_zones = squareZones(view.frame, origin, options.grid, squares);
  const std::vector<StandFacts> per_square =
      zoneFacts(view.frame, square_zones, squares.size(), facts, bands, tops);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    squares[i].facts = per_square[i];
    if (per_square[i].area > 0.0) facts.grid.push_back(squares[i]);
  }
  if (!plots.empty()) {
    const Zones plot_zones = plotZones(view.frame, plots);
    facts.per_plot = zoneFacts(view.frame, plot_zones, plots.size(), facts, bands, tops);
  }
  return facts;
}

}  // namespace agricolmap::crop
