// The field itself: where the plants stand, how the ground lies.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "agricolmap/simulate/noise.hpp"
#include "agricolmap/simulate/options.hpp"

namespace agricolmap {

/// A plant; its leaves are drawn from `id` when a view needs them.
struct Plant {
  std::uint64_t id = 0;
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();  ///< field frame [m]
  double size = 1.0;                               ///< of the crop's nominal size
  bool weed = false;
};

/// A field of `options`, centred at the origin of its frame (x east, y north, metres).
class Scene {
 public:
  Scene(const SimulationOptions& options, std::uint64_t seed);

  const std::vector<Plant>& plants() const { return plants_; }
  double rowHeading() const { return row_heading_; }  ///< [rad]
  std::uint64_t seed() const { return seed_; }
  const SimulationOptions& options() const { return options_; }
  /// Height of the bare soil without clods [m].
  double ground(double x, double y) const;
  /// Box of the field.
  Eigen::AlignedBox2d extent() const;

 private:
  void plantRows();
  void sowWeeds();

  SimulationOptions options_;
  std::uint64_t seed_;
  double row_heading_;
  SmoothNoise relief_;
  SmoothNoise fine_relief_;
  std::vector<Plant> plants_;
};

}  // namespace agricolmap
