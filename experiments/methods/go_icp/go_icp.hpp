// Go-ICP on the vegetation points: rigid, by branch and bound.
#pragma once

#include <memory>

#include "experiments/methods/go_icp/branch_and_bound.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

struct GoIcpOptions {
  std::size_t most_fixed = 60000;   ///< points in the distance field; our choice: all at 2 cm
  std::size_t most_moving = 500;    ///< data points of the search; the article: 100 to 1000
  std::size_t most_polish = 20000;  ///< data points of the last ICP; our choice
  double field_cell = 0.05;         ///< of the distance field [m]; the article: 1/300 of the extent
  double field_margin = 0.5;        ///< around the fixed points [m]; our choice
  int icp_iterations = 100;         ///< at most; our choice
  double icp_stop = 1e-4;           ///< done when no point moves further [m]; our choice
  /// Domain and stopping. The article searches all rotations; here, as every method is told how
  /// wrong the guess may be, the cube of rotations that the prior's heading allows (about all three
  /// axes) and the cube of translations that its translation allows. The article's ε, 0.001 per
  /// point of a cloud scaled to [−1, 1], would be (16 cm)² for a strip of 10 m, which any pose on a
  /// field meets: (3 cm)² instead, between the RMS of right poses (2.2–3.4 cm on simulated fields)
  /// and of ICP's wrong ones (from 3.3 cm). It trims by overlap: a fifth of the plants is taken to
  /// be seen by one map alone.
  GoIcpSearch search;
};

/// The search, then ICP on all moving points. Of the rigid motion the horizontal part counts;
/// offset and tilt come from the ground as for the product.
std::unique_ptr<Method> makeGoIcp(const GoIcpOptions& options = {});

}  // namespace agricolmap::experiments
