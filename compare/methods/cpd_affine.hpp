// Coherent point drift (affine) on the vegetation points, from the noisy guess.
#pragma once

#include <memory>

#include "agricolmap/6_refine/cpd.hpp"
#include "methods/method.hpp"

namespace agricolmap::compare {

/// The product's CPD with what makes it a refinement, and not a registration, switched off.
/// 6_refine/cpd.hpp says in what it differs from the article: its roles of the clouds, the cut-off
/// kernel and the speed, which a strip in a larger map needs.
inline CpdOptions peerCpdOptions() {
  CpdOptions options;
  options.model = CpdModel::kAffine;  // the article's affine variant
  options.start_weight = 0.0;         // the article knows no pull towards the start
  options.max_motion = 20.0;          // nor a limit to the motion
  return options;
}

std::unique_ptr<Method> makeCpdAffine(const CpdOptions& options = peerCpdOptions());

}  // namespace agricolmap::compare
