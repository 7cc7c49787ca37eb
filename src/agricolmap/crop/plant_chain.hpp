// Which hills of a row's curve are plants: the explanation of the whole row that is most likely.
#pragma once

#include <vector>

#include "agricolmap/crop/plant_pieces.hpp"

namespace agricolmap::crop {

/// What is usual on this field, of plants and of what is none. Learnt from the field itself.
struct StandModel {
  double distance = 0.0;     ///< of plants [m]
  double jitter = 0.12;      ///< deviation of a plant from its place in the rhythm, in distances
  double drift = 0.15;       ///< deviation of the rhythm itself, from place to place
  double missing = 0.08;     ///< share of places without a plant
  double area = 0.0;         ///< of a plant [m²]: e to the mean of its logarithm
  double area_spread = 0.5;  ///< deviation of the logarithm
  double aside = 0.02;       ///< deviation across the row [m]
  double half = 0.15;        ///< of what is looked at as a row [m]
  double clutter = 0.05;     ///< share of pieces that are no plants
  double valley = -8.1;      ///< log odds that a valley is one between plants, beside its looks
};

/// Pieces of a row that are one plant.
struct PlantGroup {
  std::size_t first = 0;
  std::size_t last = 0;      ///< included
  double middle = 0.0;       ///< along the row [m]
  double area = 0.0;         ///< [m²]
  double aside = 0.0;        ///< [m]
  double probability = 1.0;  ///< that just these pieces are one plant
};

struct Chain {
  std::vector<PlantGroup> plants;      ///< of the likeliest explanation, in order
  std::vector<PlantGroup> candidates;  ///< of all explanations
  std::vector<double> between;         ///< that the valley after each piece is no plant's own
  double expected = 0.0;               ///< plants, over all explanations
  double variance = 0.0;
};

/// Each piece is of a plant, with pieces beside it or alone, or clutter.
Chain chainOf(const std::vector<Piece>& pieces, const StandModel& model);

/// Log odds that plants stand on either side of the valley between two pieces, by the valley alone:
/// plants of one drill seldom stand nearer than half a spacing, leaves of one plant do.
double clearness(const Piece& a, const Piece& b, const StandModel& model);

inline constexpr double kLeastDrift = 0.07;  ///< in distances; the rhythm is looked at in bins

}  // namespace agricolmap::crop
