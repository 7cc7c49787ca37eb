// A prescription as things on a map, as JSON and as words.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/io/vector/vector_layer.hpp"
#include "agricolmap/prescribe/task_data.hpp"

namespace agricolmap::report {

/// A plan, and where it comes from and goes to.
struct PlacedPlan {
  const prescribe::Plan& plan;
  const prescribe::TaskGrid& grid;
  prescribe::GridKind kind = prescribe::GridKind::kZones;
  std::string source;  ///< map, and the layer in it
  std::string layer;
  std::string unit;  ///< of the layer's values; empty where it has none
  std::string product;
  Crs crs;                            ///< of the map
  prescribe::SquareOptions squares;   ///< sides as they were asked for
  std::optional<double> heading_deg;  ///< of turned squares
};

/// "0.1 to 0.2 m", "below 0.1 m", "from 0.2 m".
std::string classRange(const PlacedPlan& placed, std::size_t index);
/// "12.34 kg", "12345 L".
std::string amountText(double amount, const prescribe::RateUnit& unit);

/// 0xRRGGBB of a class: from low to high values; grey where the rate is 0.
std::uint32_t classColour(const prescribe::Plan& plan, std::size_t index);

/// Areas of one class that hang together, in longitude and latitude, with their rate. Names of at
/// most ten letters: it is to become a shapefile. `degrees_from_file`: of Earth.
io::VectorLayer prescriptionLayer(const PlacedPlan& placed,
                                  const prescribe::Earth::Turn& degrees_from_file);

nlohmann::ordered_json prescriptionJson(const PlacedPlan& placed);

/// A line for each class and one for all.
std::string prescriptionText(const PlacedPlan& placed);

}  // namespace agricolmap::report
