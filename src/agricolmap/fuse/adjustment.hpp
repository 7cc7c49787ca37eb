// Strips that overlap, compared with each other, and moved to where they agree best.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "agricolmap/fuse/strip_cells.hpp"

namespace agricolmap::fuse {

/// Farther apart than this two strips are not searched for [m].
inline constexpr double kFarthest = 0.3;

/// Two strips where both saw the field.
struct Disagreement {
  std::size_t first = 0;
  std::size_t second = 0;
  double area = 0.0;  ///< that both saw [m²]
  /// What must be added to the first one's places for the two to agree [m].
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  double correlation = 0.0;  ///< of heights and greenness there, −1…1
  double deviation = 0.0;    ///< to which the offset is told, per axis of the plane [m]
  double sigmas = 0.0;       ///< how large the offset is, in deviations that the errors allow
  /// Within what the errors allow (3.5 deviations); else one of the two is wrong, and neither moved
  /// for it.
  bool plausible() const { return sigmas <= 3.5; }
};

/// Expected RMS of a strip in the plane and in height [m].
struct StripErrors {
  double plane = 0.0;
  double height = 0.0;
};

/// Strip number i in the strips' cells, `factor` of which make one of the map's along each axis.
struct FineStrips {
  int factor = 1;
  std::function<map::GridMap(std::size_t i)> of;
};

/// Compares all pairs that share at least 0.5 m² and are alike enough there for their offset to be
/// told: correlation of the surfaces and of the greenness, within kFarthest and where half of what
/// both saw is left, between cells by parabolas. A small overlap tells it less well.
std::vector<Disagreement> compareStrips(const std::vector<const StripCells*>& strips,
                                        const FineStrips& fine,
                                        const std::vector<StripErrors>& errors);

/// Where each strip moves [m]: the least squares of all offsets that are plausible and of the
/// strips' own errors, so that good strips stay and bad ones come to them.
std::vector<Eigen::Vector3d> adjustedShifts(const std::vector<Disagreement>& offsets,
                                            const std::vector<StripErrors>& errors);

}  // namespace agricolmap::fuse
