#include "agricolmap/crop/field_rows.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/crop/row_trace.hpp"

namespace agricolmap::crop {

namespace {

constexpr double kCoarseCell = 0.03;   // that rows are looked for on [m]
constexpr double kRowHalf = 0.30;      // of the row spacing …
constexpr double kMostRowHalf = 0.20;  // … and at most [m]

/// The plants that were found do not stand where the rhythm of the rows has them: where leaves
/// touch, the rhythm is that of two or three plants, and tops are somewhere between. On simulated
/// beets it was 0.17 where they touch and at most 0.03 before.
constexpr double kOffRhythm = 0.08;

/// Median distance of neighbouring plants that stand about one spacing apart.
double refinedDistance(const std::vector<FieldRow>& rows, double distance) {
  std::vector<double> steps;
  for (const FieldRow& row : rows) {
    for (std::size_t i = 0; i + 1 < row.stand.plants.size(); ++i) {
      const double step = row.stand.plants[i + 1].along - row.stand.plants[i].along;
      if (std::abs(step / distance - 1.0) < 0.4) steps.push_back(step);
    }
  }
  return steps.size() < 20 ? distance : median(steps);
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
  for (int round = 0; round < 2; ++round) {
    const double usual = usualTop(profiles, field.spacing.distance);
    parallelFor(field.rows.size(), [&](std::size_t i) {
      FieldRow& row = field.rows[i];
      row.stand = findPlants(frame, green, row.line, row.profile, field.half_width,
                             field.spacing.distance, usual);
    });
    if (round > 0) break;
    const double refined = refinedDistance(field.rows, field.spacing.distance);
    if (std::abs(refined / field.spacing.distance - 1.0) > kOffRhythm) return closeAll(field);
    field.spacing.distance = refined;
  }
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
  field.rows.resize(lines.size());
  parallelFor(lines.size(), [&](std::size_t i) {
    field.rows[i].line = lines[i];
    field.rows[i].profile = profileOf(frame, green, lines[i], field.half_width, field.row_spacing);
  });
  findAllPlants(frame, green, field);
  return field;
}

}  // namespace agricolmap::crop
