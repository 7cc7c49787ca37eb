// The two clouds as coherent point drift works on them: centred, and merged level by level.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "agricolmap/paper/cpd/cpd.hpp"
#include "agricolmap/paper/cpd/cpd_kernel.hpp"

namespace agricolmap::paper {

/// Both clouds about origins of their own, so that float kernels lose nothing.
struct CpdClouds {
  std::vector<map::VegetationPoint> fixed;
  std::vector<map::VegetationPoint> moving;
  Eigen::Vector2d fixed_origin;
  Eigen::Vector2d moving_origin;
  std::array<Eigen::Vector2d, 4> corners;  ///< of the moving points' box
  double density = 0.0;                    ///< fixed weight per covered ground [1/m²]
  double height_range = 0.0;               ///< of the fixed points, as of a uniform spread [m]
};

/// Crops, thins and centres the clouds, `start` laying one into the other.
CpdClouds makeCpdClouds(const std::vector<map::VegetationPoint>& fixed,
                        const std::vector<map::VegetationPoint>& moving, const CpdPose& start,
                        const CpdOptions& options);

/// A moving point at the resolution of one σ.
struct CpdDatum {
  map::VegetationPoint point;
  Eigen::Vector3d mean;  ///< of the moving points around it, itself included [m]
};

/// The clouds at the resolution of one σ.
struct CpdLevel {
  double sigma;
  CpdMixture fixed;
  std::vector<CpdDatum> data;
};

/// The clouds merged to squares of σ/2, or unmerged on the last level; centred poses.
CpdLevel makeCpdLevel(const CpdClouds& clouds, const CpdPose& pose, double sigma, bool last,
                      const CpdOptions& options);

/// Where a pose puts a point.
inline Eigen::Vector3d applyPose(const CpdPose& pose, const Eigen::Vector2d& position,
                                 double height) {
  const Eigen::Vector2d moved = pose.plane * position;
  return {moved.x(), moved.y(), height + pose.height_offset};
}

}  // namespace agricolmap::paper
