// One visit to the field, drawn into a window: soil, straw, weeds and plants, with light.
#pragma once

#include "agricolmap/simulate/field/field_model.hpp"

namespace agricolmap::simulate {

/// What one visit changes. The UAV's is the first, the UGV's the second.
struct Visit {
  std::uint64_t seed = 0;      ///< of what this visit draws for itself
  double leaf_unshared = 0.0;  ///< fraction of leaves and fine soil texture drawn from it
  double growth = 1.0;         ///< factor on plant sizes
  double wind = 0.0;           ///< deviation of a plant's top per axis [m]
  double weeds_pulled = 0.0;   ///< fraction of weeds gone
  double solar_hour = 12.0;    ///< [h]
  double overcast = 0.3;       ///< the sky's share of light
};

Canvas renderVisit(const FieldModel& field, const Visit& visit, const Window& window);

}  // namespace agricolmap::simulate
