// What stands in a field at a visit, one by one: the truth for whoever counts and measures plants.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "agricolmap/simulate/field/render.hpp"

namespace agricolmap::simulate {

/// A plant of the crop, or a weed, as one visit finds it.
struct TruePlant {
  static constexpr std::int64_t kNoRow = std::numeric_limits<std::int64_t>::min();

  Eigen::Vector3d stem = Eigen::Vector3d::Zero();  ///< its foot; z is the soil's, without clods [m]
  double height = 0.0;                             ///< of its highest leaf above that [m]
  double radius = 0.0;                             ///< how far its leaves reach from the stem [m]
  std::int64_t row = kNoRow;  ///< counted across the rows from the field's middle; weeds: none
  Species species = Species::kSoybean;

  bool weed() const { return isWeed(species); }
};

/// All that grows with its stem in `window`, field frame. Heights and radii are those of the leaves
/// that the visit draws, to the millimetres of kTruthCell.
std::vector<TruePlant> truePlants(const FieldModel& field, const Visit& visit,
                                  const Window& window);

inline constexpr double kTruthCell = 0.005;  ///< [m]

}  // namespace agricolmap::simulate
