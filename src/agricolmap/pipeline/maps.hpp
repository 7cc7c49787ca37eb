// Levelled and gridded: the two maps of a pair, which all that follows looks at.
#pragma once

#include <optional>

#include "agricolmap/core/monitor.hpp"
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
  /// What the moving cloud was laid straight by before it was drawn, levelled moving frame.
  std::optional<pieces::Bend> bend;
};

/// Both clouds levelled under the guess (Sec. II, assumption 5) and drawn as multimodal grid maps
/// (Sec. III-A), the fixed one as far as the moving one can reach. At an unknown scale the whole
/// fixed map, and no moving one: see `mapMoving`. Throws InputError for clouds that cannot be used.
PairMaps mapPair(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const RegistrationOptions& options, Monitor& monitor);

/// Levels and grids the moving cloud again, under another guess; the fixed map stays.
void mapMoving(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
               const RegistrationOptions& options, Monitor& monitor, PairMaps& maps);

/// Lays the moving cloud straight and grids it again; its levelled frame stays.
void bendMoving(const Cloud& moving, const pieces::Bend& bend, Monitor& monitor, PairMaps& maps);

}  // namespace agricolmap::pipeline
