// The expectation step of coherent point drift: Gaussian sums over near points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace agricolmap::paper {

/// Widths of the kernel and where it ends.
struct CpdWidths {
  float sigma = 0.1F;         ///< horizontal [m]
  float sigma_height = 0.1F;  ///< vertical [m]; 0: heights play no part
};

/// What the mixture says about one query point.
struct CpdSums {
  float weight = 0.0F;  ///< S = Σ wₙ·exp(−d²/2σ² − dz²/2σ_z²)
  Eigen::Vector3f mean_offset{0.0F, 0.0F, 0.0F};  ///< Σ(pₙ − q)·…/S [m]
  float square = 0.0F;                            ///< Σ d²·…/S, horizontal [m²]
};

/// Points in bins of a grid, row by row, so that the neighbours of a query are a few runs of
/// consecutive memory.
class CpdMixture {
 public:
  /// `bin`: side of the bins [m]; a third to a half of the search radius is best.
  CpdMixture(const std::vector<Eigen::Vector4f>& points_and_weights, float bin);

  /// Sums over the points within 3σ of `query`.
  CpdSums at(const Eigen::Vector3f& query, const CpdWidths& widths) const;

 private:
  Eigen::Vector2f corner_;
  float bin_;
  int rows_ = 0;
  int cols_ = 0;
  std::vector<std::size_t> begin_;  ///< per bin, plus the end
  std::vector<float> x_, y_, z_, weight_;
};

}  // namespace agricolmap::paper
