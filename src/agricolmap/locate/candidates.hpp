// Placements found by the correlation search and which of them are one and the same.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/locate/hypotheses.hpp"
#include "agricolmap/map/blocks.hpp"

namespace agricolmap::locate {

/// A hypothesis with the shift that fits it best somewhere.
struct Candidate {
  Hypothesis hypothesis;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< of the search space's centre [m]
  double score = 0.0;                               ///< in deviations of chance; larger is better
  /// What chance gives a sum over all cells of the moving map under this hypothesis (of the map's
  /// whitened values times the strip's): rows that lie on rows make it larger.
  double deviation = 1.0;
};

/// Where a candidate puts a point of the moving map.
inline Eigen::Affine2d poseOf(const Candidate& candidate, const SearchSpace& space) {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  pose.linear() = candidate.hypothesis.linear(space.scale_axes);
  pose.translation() = space.centre + candidate.shift - pose.linear() * space.centre;
  return pose;
}

/// The best `most` candidates of which no two put all corners of the strip nearer to one another
/// than `separation` [m], best first.
std::vector<Candidate> distinctCandidates(std::vector<Candidate> all, int most, double separation,
                                          const map::StripFrame& strip, const SearchSpace& space);

}  // namespace agricolmap::locate
