// Crop facts as things on a map, as JSON and as words.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "agricolmap/crop/facts.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::report {

/// Facts, and where their frame lies.
struct PlacedFacts {
  const crop::FieldFacts& facts;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< file coordinates of the frame's zero [m]
  const std::vector<crop::Plot>& plots;              ///< as facts.per_plot
  Crs crs;                                           ///< empty: nobody said
  std::string source;                                ///< what was looked at
};

/// rows, plants, gaps, weeds, uncountable, grid and, where there are any, plots. Rows are numbered
/// from 1, to the left of their heading; plants and gaps along them.
std::vector<io::VectorLayer> factsLayers(const PlacedFacts& placed);

/// All totals with their intervals, and what they rest on.
nlohmann::ordered_json factsJson(const PlacedFacts& placed);

/// Plots (else squares) as a GeoJSON whose features are BrAPI v2 observation units with their
/// observations; coordinates are longitude and latitude. Null where the coordinate system is not
/// known.
nlohmann::ordered_json brapiJson(const PlacedFacts& placed);

/// A few lines for people.
std::string factsText(const PlacedFacts& placed);

}  // namespace agricolmap::report
