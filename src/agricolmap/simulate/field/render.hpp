// One visit to the field, drawn into a window: soil, straw, weeds and plants, with light.
#pragma once

#include "agricolmap/simulate/field/field_model.hpp"
#include "agricolmap/simulate/field/plant.hpp"

namespace agricolmap::simulate {

/// What one visit changes. The UAV's is the first, the UGV's the second.
struct Visit : VisitPlants {
  double soil_unshared = 0.0;  ///< fraction of fine soil texture drawn from its seed
  double soil_contrast = 1.0;  ///< factor on the deviation of the soil's brightness
  double weeds_pulled = 0.0;   ///< fraction of weeds gone
  double weeds_new = 0.0;      ///< fraction of weeds not there yet
  double plants_lost = 0.0;    ///< fraction of the crop's plants gone
  double solar_hour = 12.0;    ///< [h]
  double overcast = 0.3;       ///< the sky's share of light
};

/// Whether this visit does not find the plant.
bool goneFor(const Visit& visit, const Plant& plant);

Canvas renderVisit(const FieldModel& field, const Visit& visit, const Window& window);

}  // namespace agricolmap::simulate
