#include "agricolmap/crop/row_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "agricolmap/core/parabola.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::crop {

void listOptions(OptionTable& table, RowOptions& options) {
  table.number("spacing_min", options.spacing_min, 0.05, 5.0, "m",
               "least distance of rows that are looked for");
  table.number("spacing_max", options.spacing_max, 0.1, 10.0, "m",
               "largest distance of rows that are looked for");
  table.number("break_length", options.break_length, 0.2, 100.0, "m",
               "a row ends where nothing grows for so long");
  table.number("min_length", options.min_length, 0.1, 100.0, "m", "shorter ones are no rows");
}

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kHeadings = 120;     // first look, over half a turn
constexpr int kPeriods = 64;       // per factor of spacing_max / spacing_min
constexpr double kTileRows = 8.0;  // rows across a tile
constexpr double kLeastTile = 4.0;
constexpr double kKnownShare = 0.15;  // of a tile's cells
constexpr double kLeastStrength = 0.12;
constexpr std::size_t kMostSamples = 25;  // tiles that the spacing is measured on

struct TileCells {
  std::vector<Eigen::Vector2d> place;  ///< from the tile's centre
  std::vector<double> green;           ///< less the mean
  double swing = 0.0;                  ///< sum of its absolute values
  Eigen::Vector2d centre;
  double side = 0.0;
};

TileCells cellsOf(const CoarseGreen& field, int row, int col, int size) {
  TileCells tile;
  const GridFrame& frame = field.frame;
  tile.side = size * frame.cell;
  tile.centre = frame.corner + frame.cell * Eigen::Vector2d(col + 0.5 * size, row + 0.5 * size);
  double sum = 0.0;
  for (int r = row; r < std::min(row + size, frame.rows); ++r) {
    for (int c = col; c < std::min(col + size, frame.cols); ++c) {
      const float green = field.green(r, c);
      if (!std::isfinite(green)) continue;
      tile.place.emplace_back(frame.centre(r, c) - tile.centre);
      tile.green.push_back(static_cast<double>(green));
      sum += tile.green.back();
    }
  }
  if (static_cast<double>(tile.green.size()) < kKnownShare * size * size) {
    tile.place.clear();
    tile.green.clear();
    return tile;
  }
  for (double& green : tile.green) {
    green -= sum / static_cast<double>(tile.green.size());
    tile.swing += std::abs(green);
  }
  return tile;
}

/// Greenness summed along a heading, in bins across it.
std::vector<double> profileAt(const TileCells& tile, double heading, double bin) {
  const Eigen::Vector2d left(-std::sin(heading), std::cos(heading));
  const double reach = 0.75 * tile.side;
  std::vector<double> profile(static_cast<std::size_t>(std::ceil(2.0 * reach / bin)) + 1, 0.0);
  for (std::size_t i = 0; i < tile.place.size(); ++i) {
    profile[static_cast<std::size_t>((left.dot(tile.place[i]) + reach) / bin)] += tile.green[i];
  }
  return profile;
}

/// The wave of this period in such a profile; its angle is that of the crest from the centre.
std::complex<double> waveOf(const std::vector<double>& profile, double side, double bin,
                            double period) {
  const double reach = 0.75 * side;
  const std::complex<double> step = std::polar(1.0, -2.0 * kPi * bin / period);
  std::complex<double> turn = std::polar(1.0, -2.0 * kPi * (0.5 * bin - reach) / period);
  std::complex<double> sum = 0.0;
  for (const double value : profile) {
    sum += value * turn;
    turn *= step;
  }
  return sum;
}

std::vector<double> periodsOf(const RowOptions& options) {
  std::vector<double> periods;
  const double ratio = std::max(1.01, options.spacing_max / options.spacing_min);
  for (int k = 0; k <= kPeriods; ++k) {
    periods.push_back(options.spacing_min * std::pow(ratio, static_cast<double>(k) / kPeriods));
  }
  return periods;
}

/// Per period the strength at the heading where it is greatest.
std::vector<double> strengths(const TileCells& tile, const std::vector<double>& periods,
                              double bin) {
  std::vector<double> best(periods.size(), 0.0);
  for (int h = 0; h < kHeadings; ++h) {
    const std::vector<double> profile = profileAt(tile, kPi * h / kHeadings, bin);
    for (std::size_t k = 0; k < periods.size(); ++k) {
      const double power = std::norm(waveOf(profile, tile.side, bin, periods[k]));
      best[k] = std::max(best[k], power / (tile.swing * tile.swing));
    }
  }
  return best;
}

RowTile rowTile(const TileCells& tile, double spacing, double bin) {
  const auto waveAt = [&](double heading) {
    return waveOf(profileAt(tile, heading, bin), tile.side, bin, spacing);
  };
  RowTile result{tile.centre, tile.side, 0.0, 0.0, 0.0};
  double best = -1.0;
  for (int h = 0; h < kHeadings; ++h) {
    const double power = std::abs(waveAt(kPi * h / kHeadings));
    if (power > best) {
      best = power;
      result.heading = kPi * h / kHeadings;
    }
  }
  for (double step = 0.5 * kPi / kHeadings; step > 0.0005; step *= 0.5) {
    for (const double sign : {-1.0, 1.0}) {
      const double power = std::abs(waveAt(result.heading + sign * step));
      if (power > best) {
        best = power;
        result.heading += sign * step;
        break;
      }
    }
  }
  result.offset = -std::arg(waveAt(result.heading)) * spacing / (2.0 * kPi);
  result.strength = tile.swing > 0.0 ? best / tile.swing : 0.0;
  return result;
}

std::vector<TileCells> tilesOf(const CoarseGreen& field, double side) {
  const int size = std::max(8, static_cast<int>(std::lround(side / field.frame.cell)));
  std::vector<TileCells> tiles;
  // From the middle outwards is no better than from the corner, but tiles must not be cut short.
  for (int row = 0; row < field.frame.rows; row += size) {
    const int first_row = std::max(0, std::min(row, field.frame.rows - size));
    for (int col = 0; col < field.frame.cols; col += size) {
      const int first_col = std::max(0, std::min(col, field.frame.cols - size));
      TileCells tile = cellsOf(field, first_row, first_col, size);
      if (!tile.green.empty() && tile.swing > 0.0) tiles.push_back(std::move(tile));
    }
  }
  return tiles;
}

double spacingOf(const std::vector<TileCells>& tiles, const RowOptions& options, double bin) {
  const std::vector<double> periods = periodsOf(options);
  const std::size_t step = std::max<std::size_t>(1, tiles.size() / kMostSamples);
  const std::size_t count = (tiles.size() + step - 1) / step;
  std::vector<std::vector<double>> parts(count);
  parallelFor(count, [&](std::size_t i) { parts[i] = strengths(tiles[i * step], periods, bin); });
  std::vector<double> sum(periods.size(), 0.0);
  for (const std::vector<double>& part : parts) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
  }
  const auto top = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  const double between =
      top > 0 && top + 1 < sum.size() ? parabolaVertex(sum[top - 1], sum[top], sum[top + 1]) : 0.0;
  return periods[top] * std::pow(periods[1] / periods[0], between);
}

}  // namespace

std::optional<RowLattice> findRowLattice(const CoarseGreen& field, const RowOptions& options) {
  const double bin = field.frame.cell;
  const std::vector<TileCells> first =
      tilesOf(field, std::max(kLeastTile, 0.5 * kTileRows * options.spacing_max));
  if (first.empty()) return std::nullopt;
  RowLattice lattice;
  lattice.spacing = spacingOf(first, options, bin);
  const std::vector<TileCells> cells =
      tilesOf(field, std::max(kLeastTile, kTileRows * lattice.spacing));
  lattice.tiles.resize(cells.size());
  parallelFor(cells.size(),
              [&](std::size_t i) { lattice.tiles[i] = rowTile(cells[i], lattice.spacing, bin); });
  std::erase_if(lattice.tiles, [](const RowTile& tile) { return tile.strength < kLeastStrength; });
  if (lattice.tiles.empty()) return std::nullopt;
  std::stable_sort(lattice.tiles.begin(), lattice.tiles.end(),
                   [](const RowTile& a, const RowTile& b) { return a.strength > b.strength; });
  lattice.heading = lattice.tiles.front().heading;
  return lattice;
}

}  // namespace agricolmap::crop
