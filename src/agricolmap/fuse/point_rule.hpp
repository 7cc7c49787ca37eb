// Which points of the clouds are in the fused one, and where.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "agricolmap/fuse/shared_map.hpp"

namespace agricolmap::fuse {

struct FusedPoint {
  Eigen::Vector3f place;  ///< about the map's origin [m]
  Rgb colour;
  float raised = 0.0F;       ///< by how much its height was changed [m]
  float plane_error = 0.0F;  ///< as the layers have them, NaN where nobody knows [m]
  float height_error = 0.0F;
};

/// A point is in the fused cloud where its source owns the cell that it lies in.
class PointRule {
 public:
  /// `map` must outlive it.
  PointRule(const SharedMap& map, const FuseOptions& options) : map_(map), options_(options) {}

  /// Of the fixed cloud; `place` about the map's origin.
  std::optional<FusedPoint> ofFixed(const Eigen::Vector3f& place, Rgb colour) const;
  /// Of strip number `index`, before it was adjusted.
  std::optional<FusedPoint> ofStrip(std::size_t index, const Eigen::Vector3f& place,
                                    Rgb colour) const;

 private:
  std::optional<std::size_t> cellOf(const Eigen::Vector3f& place) const;
  const SharedMap& map_;
  FuseOptions options_;
};

}  // namespace agricolmap::fuse
