// From light to the 8-bit colours of one camera, one flight or drive.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap::simulate {

class ColourResponse {
 public:
  /// Draws white balance, tone curve and brightness field of one cloud. `mean_light` is the scene's
  /// mean radiance, for the automatic exposure.
  ColourResponse(const ColourOptions& options, double mean_light, std::uint64_t seed);
  /// Colour of a radiance seen at a place [m]; noise from `random`.
  Rgb operator()(const std::array<float, 3>& radiance, const Eigen::Vector2d& place,
                 Random& random) const;

 private:
  ColourOptions options_;
  std::uint64_t seed_;
  std::array<float, 3> gains_{};
  std::vector<float> curve_;  ///< 8-bit value by linear light in [0, 1]
};

}  // namespace agricolmap::simulate
