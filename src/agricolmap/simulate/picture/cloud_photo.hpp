// A coloured cloud as a camera straight above it would see it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/report/draw/view.hpp"

namespace agricolmap::simulate {

/// Colours of a cloud, drawn in any view of the ground.
class CloudPhoto {
 public:
  /// Refers to `cloud`, which must outlive the photo. `ground_from_cloud`: its local coordinates →
  /// the ground of the views, z up. Throws UsageError for a cloud that is empty or has no colours.
  CloudPhoto(const Cloud& cloud, const Eigen::Affine3d& ground_from_cloud);

  /// Distance of neighbouring points where there are any [m].
  double spacing() const { return spacing_; }
  /// Convex hull of the ground that the points cover, single flying ones aside [m].
  const std::vector<Eigen::Vector2d>& outline() const { return outline_; }

  /// What a pixel shows where there are no points.
  static constexpr std::uint32_t kNothing = 0xFF000000;
  /// Colours for the pixels of `view`, top row first: 0x00RRGGBB or kNothing. The highest points
  /// count most, as leaves hide the soil under them; gaps of the size of the spacing are closed.
  Raster<std::uint32_t> shoot(const report::View& view) const;

 private:
  void survey();

  const Cloud& cloud_;
  Eigen::Affine3d ground_from_cloud_;
  double spacing_ = 0.0;
  std::vector<Eigen::Vector2d> outline_;
};

}  // namespace agricolmap::simulate
