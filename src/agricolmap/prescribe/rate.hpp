// Rates as people say them and as task files count them: whole steps of what the data dictionary
// (ISO 11783-11) has for setpoints of volume, mass and count per area.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace agricolmap::prescribe {

/// A unit of rates, as "kg/ha".
struct RateUnit {
  std::string_view name;
  std::string_view amount;  ///< of product alone, as "kg"
  int ddi = 0;              ///< 1: volume, 6: mass, 11: count per area
  double steps = 0.0;       ///< of the data dictionary that make one of this unit
  double area = 0.0;        ///< that the unit is per [m²]
};

/// Throws UsageError that lists the known ones.
const RateUnit& rateUnit(std::string_view name);
/// Their names, with commas.
std::string rateUnitNames();

/// Nearest whole number of steps. Throws UsageError when it is beyond a task file's 31 bits,
/// negative, or more than a thousandth off: 12 g/ha, where the dictionary goes by 10.
std::int32_t taskValue(double rate, const RateUnit& unit);

/// What the machine is told then, in the unit.
double taskRate(std::int32_t value, const RateUnit& unit);

/// The product that a rate needs on an area [m²], in `unit.amount`.
double amountOn(double area, double rate, const RateUnit& unit);

}  // namespace agricolmap::prescribe
