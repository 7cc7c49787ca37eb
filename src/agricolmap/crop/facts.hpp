// What a farmer asks of a field: how many plants, where they are missing, how high they are, how
// much of the ground is green and how much of that is weeds; of the whole, of rows, of squares and
// of plots.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/crop/row_bands.hpp"

namespace agricolmap::crop {

struct FactsOptions {
  RowOptions rows;
  map::VegetationOptions vegetation;
  double grid = 2.0;  ///< side of the squares [m]
};
void listOptions(OptionTable& table, FactsOptions& options);

/// Heights of plants that a tenth, half and nine tenths are below [m]; NaN where none is known.
struct HeightRanks {
  double low = 0.0;
  double middle = 0.0;
  double high = 0.0;
};

/// Of a part of the field.
struct StandFacts {
  double area = 0.0;         ///< that the map shows [m²]
  double cover = 0.0;        ///< share of it that is green
  double between = 0.0;      ///< of it between rows [m²]
  double weeds = 0.0;        ///< share of that under weeds
  std::size_t patches = 0;   ///< of weeds
  double row_length = 0.0;   ///< [m]
  double uncounted = 0.0;    ///< of it where plants cannot be told apart [m]
  std::size_t counted = 0;   ///< plants told apart
  double plants = 0.0;       ///< expected, and one per spacing where they cannot be told apart
  double plants_low = 0.0;   ///< hold the truth nine times in ten, on simulated fields
  double plants_high = 0.0;  ///< (docs/crop-facts.md)
  std::size_t gaps = 0;      ///< whose middle is here
  double gap_length = 0.0;   ///< of these [m]
  HeightRanks height;
};

/// A polygon and what it is called.
struct Plot {
  std::string id;
  std::vector<Eigen::Vector2d> corners;  ///< of the frame; not closed
};

struct GridSquare {
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< south-west, of the frame [m]
  double side = 0.0;
  StandFacts facts;
};

struct FieldFacts {
  Greenness greenness;
  FieldRows rows;
  Weeds weeds;
  bool countable = false;  ///< plants could be told apart somewhere
  StandFacts total;
  std::vector<StandFacts> per_row;   ///< as rows.rows
  std::vector<GridSquare> grid;      ///< those that the map shows something of
  std::vector<StandFacts> per_plot;  ///< as the plots given
};

/// Corners of the squares lie on multiples of their side in `origin` + the view's coordinates.
/// The heights of `view` are above the ground. A field without plants, or without rows, has facts
/// too: cover and heights.
FieldFacts factsOf(const View& view, const Eigen::Vector2d& origin, const std::vector<Plot>& plots,
                   const FactsOptions& options);

}  // namespace agricolmap::crop
