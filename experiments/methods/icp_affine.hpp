// Non-rigid (affine) ICP on the vegetation points, from the noisy guess.
#pragma once

#include <memory>

#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

struct IcpAffineOptions {
  /// Points per cloud at most, merged to squares. Our choice: all of a 10 m strip's at 2 cm.
  std::size_t most_fixed = 60000;
  std::size_t most_moving = 20000;
  /// Pairs further apart do not count [m]. Our choice: about a row's width; without any limit,
  /// plants that the other map lacks pull the strip out of shape.
  double most_distance = 0.3;
  int iterations = 200;      ///< at most; our choice, it converges in 20 to 80
  double stop = 1e-4;        ///< done when no corner of the strip moves further [m]; our choice
  double least_pairs = 0.2;  ///< share of the moving points that must find a partner; our choice
};

/// Alternates nearest neighbours in space and the affine with the least squares between them (Besl
/// & McKay 1992, with an affine in place of the rigid motion). Only the six horizontal parameters
/// are free: near-planar points cannot tell tilt, and a free one would spoil the result. Offset and
/// tilt come from the ground as for the product.
std::unique_ptr<Method> makeIcpAffine(const IcpAffineOptions& options = {});

}  // namespace agricolmap::experiments
