#include "agricolmap/prescribe/rate.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "agricolmap/core/error.hpp"

namespace agricolmap::prescribe {
namespace {

constexpr double kHectare = 1e4;             // [m²]
constexpr double kAcre = 4046.8564224;       // [m²]
constexpr double kVolumeSteps = 1e6 / 0.01;  // 0.01 mm³/m² in a litre per m²
constexpr double kMassSteps = 1e6;           // 1 mg/m² in a kilogram per m²
constexpr double kCountSteps = 1.0 / 0.001;  // 0.001/m² in one per m²
constexpr double kGallon = 3.785411784;      // of the United States [l]
constexpr double kPound = 0.45359237;        // [kg]
constexpr double kTolerance = 1e-3;          // of a rate, by rounding

constexpr std::array<RateUnit, 12> kUnits{{
    {"L/ha", "L", 1, kVolumeSteps / kHectare, kHectare},
    {"mL/ha", "mL", 1, 1e-3 * kVolumeSteps / kHectare, kHectare},
    {"m3/ha", "m3", 1, 1e3 * kVolumeSteps / kHectare, kHectare},
    {"gal/ac", "gal", 1, kGallon* kVolumeSteps / kAcre, kAcre},
    {"kg/ha", "kg", 6, kMassSteps / kHectare, kHectare},
    {"g/ha", "g", 6, 1e-3 * kMassSteps / kHectare, kHectare},
    {"t/ha", "t", 6, 1e3 * kMassSteps / kHectare, kHectare},
    {"lb/ac", "lb", 6, kPound* kMassSteps / kAcre, kAcre},
    {"seeds/m2", "seeds", 11, kCountSteps, 1.0},
    {"seeds/ha", "seeds", 11, kCountSteps / kHectare, kHectare},
    {"plants/ha", "plants", 11, kCountSteps / kHectare, kHectare},
    {"seeds/ac", "seeds", 11, kCountSteps / kAcre, kAcre},
}};

}  // namespace

std::string rateUnitNames() {
  std::string names;
  for (const RateUnit& unit : kUnits) {
    if (!names.empty()) names += ", ";
    names += unit.name;
  }
  return names;
}

const RateUnit& rateUnit(std::string_view name) {
  for (const RateUnit& unit : kUnits) {
    if (unit.name == name) return unit;
  }
  throw UsageError(fmt::format("'{}' is no unit of rates; there are {}", name, rateUnitNames()));
}

std::int32_t taskValue(double rate, const RateUnit& unit) {
  if (!std::isfinite(rate) || rate < 0.0) {
    throw UsageError(fmt::format("a rate of {:g} {} cannot be applied", rate, unit.name));
  }
  const double steps = std::round(rate * unit.steps);
  if (steps > static_cast<double>(std::numeric_limits<std::int32_t>::max())) {
    throw UsageError(fmt::format("a rate of {:g} {} is more than a task file can say ({:g})", rate,
                                 unit.name, std::numeric_limits<std::int32_t>::max() / unit.steps));
  }
  if (std::abs(steps - rate * unit.steps) > kTolerance * rate * unit.steps) {
    throw UsageError(
        fmt::format("a task file has no rate of {:g} {}: it goes by {:.4g}; the nearest is {:.6g}",
                    rate, unit.name, 1.0 / unit.steps, steps / unit.steps));
  }
  return static_cast<std::int32_t>(steps);
}

double taskRate(std::int32_t value, const RateUnit& unit) { return value / unit.steps; }

double amountOn(double area, double rate, const RateUnit& unit) { return area / unit.area * rate; }

}  // namespace agricolmap::prescribe
