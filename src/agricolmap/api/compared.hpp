// Maps of a pair as callers see them.
#pragma once

#include <optional>

#include "agricolmap/maps.hpp"
#include "agricolmap/pipeline/maps.hpp"

namespace agricolmap {

/// What of the clouds their maps do not say.
struct Coloured {
  bool fixed = false;
  bool moving = false;
};

/// `local_fixed_from_moving`: where the moving cloud was laid, local frames; nothing: by the guess.
ComparedMaps comparedMaps(const pipeline::PairMaps& maps,
                          const std::optional<Eigen::Affine3d>& local_fixed_from_moving,
                          const Eigen::Vector3d& fixed_origin, const Coloured& coloured);

}  // namespace agricolmap
