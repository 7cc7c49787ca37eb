#include "agricolmap/change/comparison.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::change {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

enum class Summary { kMedian, kMean };

double summaryOf(std::vector<float>& values, Summary summary, double of_none) {
  if (values.empty()) return of_none;
  if (summary == Summary::kMedian) return static_cast<double>(median(values));
  double sum = 0.0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

/// `among`: the cells that summaries are of; nothing: all.
LayerChange changeOf(LayerTimes times, Summary summary, std::optional<Raster<std::uint8_t>> among) {
  LayerChange found{std::move(times), {}, std::move(among)};
  const LayerTimes& pair = found.times;
  found.change = Raster<float>(pair.before.rows(), pair.before.cols());
  std::vector<float> before;
  std::vector<float> after;
  for (std::size_t i = 0; i < found.change.size(); ++i) {
    found.change[i] = pair.after[i] - pair.before[i];
    if (!found.counts(i)) continue;
    before.push_back(pair.before[i]);
    after.push_back(pair.after[i]);
  }
  found.cells = before.size();
  found.before = summaryOf(before, summary, 0.0);
  found.after = summaryOf(after, summary, 0.0);
  return found;
}

/// 1 where more than half of the cell is vegetation in both maps.
Raster<std::uint8_t> plantsIn(const LayerTimes& covers) {
  Raster<std::uint8_t> plants(covers.before.rows(), covers.before.cols());
  for (std::size_t i = 0; i < plants.size(); ++i) {
    plants[i] = covers.before[i] > 0.5F && covers.after[i] > 0.5F ? 1 : 0;
  }
  return plants;
}

std::vector<PartLayer> partsOf(const std::optional<LayerChange>& layer, Summary summary,
                               const Raster<std::int32_t>& zones, std::size_t count) {
  std::vector<std::vector<float>> before(count);
  std::vector<std::vector<float>> after(count);
  for (std::size_t i = 0; layer && i < zones.size(); ++i) {
    if (zones[i] < 0 || !layer->counts(i)) continue;
    before[static_cast<std::size_t>(zones[i])].push_back(layer->times.before[i]);
    after[static_cast<std::size_t>(zones[i])].push_back(layer->times.after[i]);
  }
  std::vector<PartLayer> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t cells = before[i].size();
    parts.push_back(
        {cells, summaryOf(before[i], summary, kNone), summaryOf(after[i], summary, kNone)});
  }
  return parts;
}

}  // namespace

bool LayerChange::counts(std::size_t cell) const {
  return !std::isnan(change[cell]) && (!among || (*among)[cell] != 0);
}

MapHeights noHeights(const GridFrame& grid) {
  const Raster<float> none(grid.rows, grid.cols, std::numeric_limits<float>::quiet_NaN());
  return {none, none, none, Raster<std::uint16_t>(grid.rows, grid.cols)};
}

std::size_t Comparison::comparedCells() const {
  if (!flat) return totals.compared.cells;
  return cover ? cover->cells : 0;
}

Comparison compareMaps(MapLayers a, MapLayers b, double cell, const FrameError& frames, bool flat) {
  Comparison found;
  found.cell = cell;
  found.frames = frames;
  found.flat = flat;
  std::optional<Raster<std::uint8_t>> bare;
  std::optional<Raster<std::uint8_t>> planted;
  if (a.cover && b.cover) {
    bare = bareGround(*a.cover, *b.cover);
    LayerTimes covers{*std::move(a.cover), *std::move(b.cover)};
    planted = plantsIn(covers);
    found.cover = changeOf(std::move(covers), Summary::kMean, {});
  }
  if (!flat && a.plant_height && b.plant_height) {
    found.plant_height = changeOf({*std::move(a.plant_height), *std::move(b.plant_height)},
                                  Summary::kMedian, std::move(planted));
  }
  found.before = std::move(a.heights);
  found.after = std::move(b.heights);
  found.heights = heightChange(found.before, found.after, cell, frames);
  found.totals =
      totalsOf(found.heights, found.before, found.after, cell, frames, bare ? &*bare : nullptr);
  return found;
}

std::string bareGroundWarning(const Totals& totals) {
  const auto& bare = totals.stable;
  if (!bare || bare->cells == 0) return {};
  const double expected = kLevel95 * bare->meanDeviation();
  if (std::abs(bare->mean()) <= expected) return {};
  return fmt::format(
      "bare ground changed by {:.1f} cm on average, and no more than {:.1f} cm is expected: it was "
      "worked, or the maps lie further apart than their errors say",
      100.0 * bare->mean(), 100.0 * expected);
}

bool PartChange::moreThanErrors() const { return std::abs(heights.compared.mean()) > level(); }

std::vector<PartChange> partChanges(const Comparison& compared, const Raster<std::int32_t>& zones,
                                    std::size_t count) {
  const std::vector<ZoneChange> changed =
      zoneChanges(compared.heights, compared.before, compared.after, compared.cell, compared.frames,
                  zones, count);
  const std::vector<PartLayer> heights =
      partsOf(compared.plant_height, Summary::kMedian, zones, count);
  const std::vector<PartLayer> covers = partsOf(compared.cover, Summary::kMean, zones, count);
  std::vector<PartChange> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const double area = compared.flat
                            ? static_cast<double>(covers[i].cells) * compared.cell * compared.cell
                            : changed[i].compared.area;
    parts.push_back({area, changed[i], heights[i], covers[i]});
  }
  return parts;
}

}  // namespace agricolmap::change
