#include "agricolmap/crop/field_rows.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/crop/row_trace.hpp"
#include "agricolmap/crop/stand_learning.hpp"

namespace agricolmap::crop {

namespace {

constexpr double kCoarseCell = 0.03;   // that rows are looked for on [m]
constexpr double kRowHalf = 0.30;      // of the row spacing …
constexpr double kMostRowHalf = 0.20;  // … and at most [m]
/// A count that errs by more, one in three times, is none.
constexpr double kMostError = 0.045;
constexpr double kEdgeOfRow = 0.12;  // of the greenness in its middle
constexpr int kRounds = 4;           // in which the field teaches what is usual on it

/// The plants that were found do not stand where the rhythm of the rows has them: where leaves
/// touch, the rhythm is that of two or three plants, and tops are somewhere between. On simulated
/// beets it was 0.17 where they touch and at most 0.03 before.
constexpr double kOffRhythm = 0.08;

/// How far from its line a row's green reaches, as the mean of all rows has it: what lies farther
/// aside adds soil's noise and weeds to the curve, and no plants.
double reachAside(const GridFrame& frame, const Raster<float>& green,
                  const std::vector<RowLine>& lines, double widest, double spacing) {
  const double step = std::max(0.005, frame.cell);
  const auto count = static_cast<std::size_t>(std::ceil(0.5 * spacing / step));
  std::vector<double> sum(count, 0.0);
  std::vector<double> known(count, 0.0);
  for (const RowLine& line : lines) {
    for (double s = 0.0; s < line.length(); s += 2.0 * step) {
      const RowPlace place = line.at(s);
      for (std::size_t i = 0; i < count; ++i) {
        for (const double side : {-1.0, 1.0}) {
          const double t = side * (static_cast<double>(i) + 0.5) * step;
          const auto value =
              static_cast<double>(knownValue(frame, green, place.point + t * place.left()));
          if (!std::isfinite(value)) continue;
          sum[i] += value;
          known[i] += 1.0;
        }
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) sum[i] = known[i] > 0.0 ? sum[i] / known[i] : 0.0;
  const double soil = *std::min_element(sum.begin(), sum.end());
  const double most = *std::max_element(sum.begin(), sum.end());
  std::size_t edge = 0;
  while (edge < count && sum[edge] - soil > kEdgeOfRow * (most - soil)) ++edge;
  return std::clamp(static_cast<double>(edge) * step, 0.25 * widest, widest);
}

/// Of single pieces of a usual height.
StandModel firstModel(const std::vector<std::vector<Piece>>& pieces, double distance, double usual,
                      double half) {
  StandModel model;
  model.distance = distance;
  model.half = half;
  std::vector<double> areas;
  for (const std::vector<Piece>& row : pieces) {
    for (const Piece& piece : row) {
      if (piece.height > 0.5 * usual && piece.area > 0.0) areas.push_back(piece.area);
    }
  }
  if (!areas.empty()) model.area = median(areas);
  return model;
}

/// Nothing is counted anywhere.
void closeAll(FieldRows& field) {
  field.spacing = {};
  for (FieldRow& row : field.rows) {
    row.stand = {};
    row.stand.touching = {{0.0, row.line.length()}};
  }
}

void findAllPlants(const GridFrame& frame, const Raster<float>& green, FieldRows& field) {
  std::vector<RowProfile> profiles;
  for (const FieldRow& row : field.rows) profiles.push_back(row.profile);
  field.spacing = plantSpacing(profiles);
  if (!(field.spacing.distance > 0.0)) return closeAll(field);
  const double usual = usualTop(profiles, field.spacing.distance);
  std::vector<std::vector<Piece>> pieces(field.rows.size());
  std::vector<Chain> chains(field.rows.size());
  parallelFor(field.rows.size(), [&](std::size_t i) {
    pieces[i] = piecesOf(profiles[i], field.spacing.distance, usual);
  });
  StandModel model = firstModel(pieces, field.spacing.distance, usual, field.plant_half);
  if (!(model.area > 0.0)) return closeAll(field);
  for (int round = 0; round <= kRounds; ++round) {
    parallelFor(field.rows.size(), [&](std::size_t i) { chains[i] = chainOf(pieces[i], model); });
    if (round < kRounds) model = relearnt(chains, pieces, model);
    if (std::abs(model.distance / field.spacing.distance - 1.0) > kOffRhythm) {
      return closeAll(field);
    }
  }
  field.spacing.distance = model.distance;
  field.model_error = modelError(chains, model, frame.cell);
  if (field.model_error > kMostError) return closeAll(field);
  parallelFor(field.rows.size(), [&](std::size_t i) {
    FieldRow& row = field.rows[i];
    row.stand = findPlants(frame, green, row.line, row.profile, pieces[i], chains[i], model);
  });
}

}  // namespace

FieldRows findRows(const GridFrame& frame, const Raster<float>& green, const RowOptions& options) {
  FieldRows field;
  const int step =
      std::max(1, static_cast<int>(std::min(kCoarseCell, 0.25 * options.spacing_min) / frame.cell));
  const CoarseGreen coarse = coarseGreen(frame, green, step);
  const std::optional<RowLattice> lattice = findRowLattice(coarse, options);
  if (!lattice) return field;
  field.row_spacing = lattice->spacing;
  field.heading = lattice->heading;
  field.half_width = std::min(kRowHalf * lattice->spacing, kMostRowHalf);
  const std::vector<RowLine> lines = traceRows(coarse, *lattice, options);
  if (lines.empty()) return field;
  field.plant_half = reachAside(frame, green, lines, field.half_width, field.row_spacing);
  field.rows.resize(lines.size());
  parallelFor(lines.size(), [&](std::size_t i) {
    field.rows[i].line = lines[i];
    field.rows[i].profile = profileOf(frame, green, lines[i], field.plant_half, field.row_spacing);
  });
  findAllPlants(frame, green, field);
  return field;
}

}  // namespace agricolmap::crop
