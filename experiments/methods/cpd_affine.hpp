// Coherent point drift (affine) on the vegetation points, from the noisy guess.
#pragma once

#include <memory>

#include "agricolmap/paper/cpd/cpd.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// The product's CPD with what makes it a refinement, and not a registration, switched off.
/// 6_refine/cpd.hpp says in what it differs from the article: its roles of the clouds, the cut-off
/// kernel and the speed, which a strip in a larger map needs.
inline paper::CpdOptions peerCpdOptions() {
  paper::CpdOptions options;
  options.model = paper::CpdModel::kAffine;  // the article's affine variant
  options.start_weight = 0.0;                // the article knows no pull towards the start
  options.max_motion = 20.0;                 // nor a limit to the motion
  return options;
}

std::unique_ptr<Method> makeCpdAffine(const paper::CpdOptions& options = peerCpdOptions());

}  // namespace agricolmap::experiments
