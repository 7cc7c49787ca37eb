// Nested branch and bound over rotations and translations (Yang, Li, Campbell & Jia, "Go-ICP: a
// globally optimal solution to 3D ICP point-set registration", TPAMI 2016).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "experiments/methods/go_icp/distance_field.hpp"

namespace agricolmap::experiments {

/// Domain and stopping. The article searches all rotations; here, as every method is told how wrong
/// the guess may be, the cube of rotations that the prior's heading allows (about all three axes)
/// and the cube of translations that its translation allows. The article's ε, 0.001 per point of a
/// cloud scaled to [−1, 1], would be (16 cm)² for a strip of 10 m, which any pose on a field meets:
/// (3 cm)² instead, between the RMS of right poses (2.2–3.4 cm on simulated fields) and of ICP's
/// wrong ones (from 3.3 cm). It trims by overlap: a fifth of the plants is taken to be seen by one
/// map alone.
struct GoIcpSearch {
  double half_rotation = 0.2;     ///< half side of the cube of rotation vectors [rad]
  double half_translation = 5.0;  ///< half side of the cube of translations [m]
  double trim = 0.2;              ///< share of the points with the largest errors left out
  double threshold = 9e-4;        ///< ε per point: stop when no better one is possible [m²]
  std::int64_t most_bounds = 40'000'000;  ///< of translations computed; then the best so far
};

/// A rigid motion: rotation about the origin of the points, then translation.
struct GoIcpPose {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< axis times angle [rad]
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double error = 0.0;  ///< sum of the smallest squared distances [m²]
  Eigen::Isometry3d motion() const;
};

struct GoIcpResult {
  GoIcpPose pose;
  bool proven = false;         ///< within ε of the best there is in the domain
  std::int64_t bounds = 0;     ///< computed
  std::int64_t rotations = 0;  ///< cubes looked into
};

/// Rigid ICP from a pose; called whenever the search finds a better one.
using LocalSearch = std::function<GoIcpPose(const GoIcpPose&)>;

class GoIcpSearcher {
 public:
  /// `moving`: data points about their middle. `deadline_s`: seconds from now.
  GoIcpSearcher(const DistanceField& field, std::vector<Eigen::Vector3d> moving,
                const GoIcpSearch& search, double deadline_s);
  /// Best-first over cubes of rotations; for each, an inner search over cubes of translations.
  GoIcpResult run(const LocalSearch& local) const;
  /// The trimmed error of a pose.
  double errorOf(const GoIcpPose& pose) const;

 private:
  struct Inner;
  /// Least error over the translations, with `slack` [m] per point taken off each distance. Starts
  /// from `best_known`: only what is less by ε is looked for.
  Inner searchTranslations(const std::vector<Eigen::Vector3f>& rotated,
                           const std::vector<float>& slack, double best_known) const;
  std::vector<Eigen::Vector3f> rotated(const Eigen::Vector3d& rotation) const;
  std::vector<float> slackOf(double half_side) const;
  double trimmedSum(std::vector<float>& distances) const;

  const DistanceField& field_;
  std::vector<Eigen::Vector3d> moving_;
  GoIcpSearch search_;
  std::size_t kept_;  ///< points that count
  double epsilon_;
  std::function<bool()> expired_;
};

}  // namespace agricolmap::experiments
