#include "agricolmap/crop/facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

StandFacts totalOf(const View& view, const FieldFacts& field, const RowBands& bands,
                   const std::vector<PlantTop>& tops) {
  const Zones all(view.frame.rows, view.frame.cols, 0);
  return zoneFacts(view.frame, all, 1, field, bands, tops).front();
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
