// One map of a field from a drone's cloud and the strips that robots drove through it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/fuse/adjustment.hpp"
#include "agricolmap/fuse/drone_heights.hpp"
#include "agricolmap/fuse/layers.hpp"
#include "agricolmap/fuse/options.hpp"
#include "agricolmap/fuse/strip_cells.hpp"
#include "agricolmap/fuse/tone.hpp"

namespace agricolmap::fuse {

/// A strip that lies in the coordinates of the fixed cloud's file already.
struct StripInput {
  std::string id;
  const PointStream* points = nullptr;
  std::int32_t date = 0;         ///< YYYYMMDD; 0: nobody said
  StripErrors errors;            ///< what its registration states
  bool heights_limited = false;  ///< as it says: its heights say nothing of the fixed cloud's
};

/// What became of a strip.
struct FusedStrip {
  std::string id;
  std::uint16_t code = kNoSource;  ///< in the layer `source`
  std::int32_t date = 0;
  StripErrors errors;
  StripCells cells;
  Greenness greenness;
  Tone tone;
  bool flat = false;                                ///< has no heights
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();  ///< by the adjustment [m]
  double seen_area = 0.0;                           ///< [m²]
  double owned_area = 0.0;                          ///< what it has in the map [m²]
};

struct SharedMap {
  Lattice lattice;
  Layers layers;
  Raster<float> correction;  ///< of the fixed cloud's heights [m]
  std::optional<HeightBias> bias;
  Greenness fixed_greenness;
  bool flat = false;  ///< the fixed cloud has no heights, so the layers of heights mean nothing
  std::vector<FusedStrip> strips;
  std::vector<Disagreement> overlaps;
  std::vector<std::string> warnings;
};

/// Hears what is done next.
using StepListener = std::function<void(std::string_view)>;

/// Robots' cells replace the drone's where robots have seen, the drone's heights are led to theirs
/// and corrected over plants as strips show; a function of the set of strips, whatever their order.
/// Throws InputError when the clouds have no extent, or no strip touches the fixed cloud.
SharedMap shareMap(const PointStream& fixed, std::int32_t fixed_date,
                   std::vector<StripInput> strips, const FuseOptions& options,
                   const StepListener& on_step = {});

/// Strip number `strip` in the strips' cells, where it lies in the map.
map::GridMap fineMap(const SharedMap& map, std::size_t strip, const PointStream& points);

}  // namespace agricolmap::fuse
