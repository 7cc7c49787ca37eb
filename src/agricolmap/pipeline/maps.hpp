// Levelled and gridded: the two maps of a pair, which all that follows looks at.
#pragma once

#include <optional>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/deform/path.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/pieces/bend.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/pipeline/pair_maps.hpp"

namespace agricolmap::pipeline {

struct PairMaps {
  PairFrames frames;
  map::Box2 fixed_box;  ///< of the clouds in the levelled frames [m]
  map::Box2 moving_box;
  map::GridOptions grid;  ///< with the cell that both clouds fill
  SearchSpace space;      ///< where the guess leaves the moving map
  map::GridMap fixed;
  map::GridMap moving;
  /// Where the robot drove, in the moving map; nothing: not known, straight through the strip.
  std::optional<deform::Path> path = std::nullopt;
};

/// Both clouds levelled under the guess (Sec. II, assumption 5) and drawn as multimodal grid maps
/// (Sec. III-A), the fixed one as far as the moving one can reach. At an unknown scale the whole
/// fixed map, and no moving one: see `mapMoving`. Throws InputError for clouds that cannot be used.
PairMaps mapPair(const FixedCloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const RegistrationOptions& options, Monitor& monitor);

/// Levels and grids the moving cloud again, under another guess; the fixed map stays.
void mapMoving(const CloudFacts& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
               const RegistrationOptions& options, Monitor& monitor, PairMaps& maps);

/// The moving map of a cloud that is laid straight before it is gridded; its levelled frame stays.
map::GridMap straightMap(const Cloud& moving, const pieces::Bend& bend, const PairMaps& maps,
                         Monitor& monitor);

}  // namespace agricolmap::pipeline
