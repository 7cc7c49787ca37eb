// Affine coherent point drift as it was published (Myronenko & Song, "Point set registration:
// coherent point drift", TPAMI 2010), in three dimensions. cpd.hpp has the one that is used by
// default and says why it differs.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "agricolmap/core/options.hpp"

namespace agricolmap::paper {

struct PublishedCpdOptions {
  double outlier_share = 0.1;  ///< w, share of fixed points expected to have no counterpart
  int max_points = 3000;       ///< per cloud; more are merged to squares, for all pairs are visited
  int max_iterations = 150;
  double tolerance = 1e-5;  ///< change of σ and of any point that ends it [m]
};
void listOptions(OptionTable& table, PublishedCpdOptions& options);

/// The article's parameters θ and σ²: x ≈ linear·y + shift.
struct PublishedCpdState {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();  ///< B
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();       ///< t [m]
  double variance = 0.0;                                 ///< σ² [m²]
  double matched = 0.0;                                  ///< N_P, sum of all posteriors
  bool degenerate = false;  ///< the points determine no affine map; the rest is that of before
};

/// σ² before the first iteration: mean squared distance over all pairs and dimensions. Points are
/// columns: the fixed ones X are the data, the moving ones Y the centroids of the mixture.
double publishedCpdVariance(const Eigen::Matrix3Xd& fixed, const Eigen::Matrix3Xd& moving);

/// One expectation and maximisation over all pairs. Kernels are single precision about the data's
/// mean.
PublishedCpdState publishedCpdStep(const Eigen::Matrix3Xd& fixed, const Eigen::Matrix3Xd& moving,
                                   const PublishedCpdState& state, double outlier_share);

struct PublishedCpdResult {
  PublishedCpdState state;
  int iterations = 0;
  bool converged = false;
};

/// Iterates from the identity and publishedCpdVariance until nothing changes by more than the
/// tolerance. Neither cloud may be empty. The same result on any number of threads.
PublishedCpdResult publishedCpd(const Eigen::Matrix3Xd& fixed, const Eigen::Matrix3Xd& moving,
                                const PublishedCpdOptions& options);

}  // namespace agricolmap::paper
