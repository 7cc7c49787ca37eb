// Plants made of leaves: drawn from random numbers, per view.
#pragma once

#include <array>

#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/field/field_model.hpp"

namespace agricolmap::simulate {

/// What one visit changes about plants.
struct VisitPlants {
  std::uint64_t seed = 0;                          ///< of what this visit draws for itself
  double leaf_unshared = 0.0;                      ///< fraction of leaves drawn from it
  double growth = 1.0;                             ///< factor on sizes
  double wind = 0.0;                               ///< deviation of a plant's top per axis [m]
  double growth_spread = 0.0;                      ///< deviation of growth from plant to plant
  double ripeness = 0.0;                           ///< see ViewOptions::ripeness
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();  ///< of all plants, per height above the soil

  /// How far plants reach at most, over what is usual for their size.
  double reach() const;
};

enum class LeafShape : std::uint8_t { kOval, kBlade, kTrifoliate, kStraw };

/// A leaf as a bent ribbon: it leaves its base at `elevation` and bends down by `bend` in all.
struct Leaf {
  LeafShape shape = LeafShape::kOval;
  float azimuth = 0.0F;                             ///< field frame [rad]
  float elevation = 0.0F;                           ///< above the horizon at the base [rad]
  float bend = 0.0F;                                ///< loss of elevation from base to tip [rad]
  float length = 0.0F;                              ///< with stalk [m]
  float width = 0.0F;                               ///< greatest [m]
  float stalk = 0.0F;                               ///< fraction of the length that is stalk
  float roll = 0.0F;                                ///< about its axis [rad]
  float base_z = 0.0F;                              ///< above the soil [m]
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();  ///< wind at the leaf's height [m]
  float shade = 1.0F;  ///< reflectance of this leaf against the plant's
  float ripe = 0.0F;   ///< 0 green, from 0.25 on yellow, from 1.25 on brown
};

/// Up to kMaxLeaves leaves.
struct Foliage {
  static constexpr int kMaxLeaves = 16;
  std::array<Leaf, kMaxLeaves> leaves;
  int count = 0;
  std::array<float, 3> albedo{};

  /// Reflectance of one of its leaves.
  std::array<float, 3> albedoOf(const Leaf& leaf) const;
};

Foliage growFoliage(const Plant& plant, const VisitPlants& visit);

}  // namespace agricolmap::simulate
