// The simplest thing that works: exhaustive correlation over heading and scales, then dense
// Gauss-Newton for an affine.
#pragma once

#include <memory>

#include "agricolmap/refine/dense_refine.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// All values are our choice.
struct FftAffineOptions {
  int factor = 6;       ///< cells of the correlation in grid cells: 12 cm
  double step = 1.5;    ///< by which a step of heading or scale moves the strip's ends [cells]
  int candidates = 30;  ///< best hypotheses that are refined
  double apart = 0.3;   ///< by which two of them lay a corner apart at least [m]
  double least_energy = 0.5;  ///< of the fixed map under the strip, in its mean: keeps off the rim
  refine::DenseRefineOptions dense;
};

/// For every heading and pair of scales that the guess allows, in steps that move the ends of the
/// strip by a cell, the strip's Excess Green is correlated with the fixed map by FFT, normalised by
/// the energy under the strip; a peak counts by its correlation times the root of the cells it
/// rests on. The best few are refined on the maps through 12 and 6 cm, the one that then correlates
/// best through 4 and 2 cm. No whitening, no verdict: what the product's default adds is left out.
std::unique_ptr<Method> makeFftAffine(const FftAffineOptions& options = {});

}  // namespace agricolmap::experiments
