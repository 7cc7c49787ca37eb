// SURF (Bay et al. 2008), of dlib.
#pragma once

#include <memory>

#include "experiments/methods/features/features.hpp"

namespace agricolmap::experiments {

struct SurfOptions {
  long most = 10000;  ///< keypoints; library default
  /// Of the Hessian's determinant; library: 30, tuned on photographs (our choice).
  double threshold = 5.0;
  /// The picture is enlarged beforehand, as the article does in its finest variant: leaves are a
  /// few cells wide, the smallest blob that the detector sees is larger (our choice).
  int enlarge = 2;
};

std::unique_ptr<FeatureExtractor> makeSurf(const SurfOptions& options = {});

}  // namespace agricolmap::experiments
