// Parts of the strip that lie elsewhere than the whole says: the odometry slipped, or maps of parts
// of the way were joined badly. A refinement locks on to the larger part and fits it well.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/verdict/slices.hpp"
#include "agricolmap/verdict/slip.hpp"

namespace agricolmap::verdict {

/// What the parts of a strip may be displaced by, root mean square over all of it [m].
inline constexpr double kMostDisplaced = 0.05;

/// A part of the strip that fits better beside where the whole puts it.
struct DisplacedPart {
  double begin = 0.0;  ///< along the strip, from the low end of its frame [m]
  double end = 0.0;
  /// From where the pose puts it to where it fits, fixed levelled frame [m].
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  /// Its peak there in deviations of what chance gives to this part, and over the highest other one
  /// within 1.6 m.
  double significance = 0.0;
  double uniqueness = 0.0;
};

struct PartsReport {
  double length = 0.0;  ///< of the strip [m]
  double turn = 0.0;    ///< of the levelled frame against the compass, see SearchSpace [rad]
  /// From the low end to the high end as the pose lays them, fixed levelled frame, unit length.
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  std::vector<DisplacedPart> displaced;  ///< in order along the strip; empty: none is
  /// Where its slices lie beside where the pose puts them, in order; none where no part is
  /// displaced.
  std::vector<SliceOffset> slices;
  /// How far the strip lies beside where the pose puts it, root mean square over its slices [m]; 0
  /// when no part is displaced.
  double rms = 0.0;
  /// That all parts lie where the whole says, by their scores and how often strips slip.
  double probability = 1.0;
  /// Where that is more than kMostDisplaced, and the pose a compromise between two parts: the pose
  /// that lays the larger one alone, to a centimetre or two.
  std::optional<Eigen::Affine2d> larger;

  /// Whether the strip, in place otherwise, is in parts.
  bool apart() const { return rms > kMostDisplaced; }
};

/// Looks for every part of the strip within 1 m of where `pose` (levelled moving → levelled fixed)
/// puts it. What chance gives, and how much a slice of the strip can tell, comes from the pair's
/// own scores; slices that tell nothing, as those beyond the map, abstain.
PartsReport findDisplacedParts(const correlation::StripScore& score, const Eigen::Affine2d& pose);

/// The part that is displaced most, in plain words by the fixed file's compass (x east, y north):
/// "the 4.0 m at the strip's western end lie 0.31 m further north than the whole says". Empty when
/// none is.
std::string describe(const PartsReport& report);

}  // namespace agricolmap::verdict
