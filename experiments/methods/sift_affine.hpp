// SIFT and a robust affine: what OpenCV offers for laying one picture of the ground on another.
#pragma once

#include <memory>

#include "experiments/methods/features/opencv_features.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

struct SiftAffineOptions {
  SiftOptions sift;
  double ratio = 0.9;         ///< Lowe: 0.8, which leaves too few where all plants are alike
  double threshold = 3.0;     ///< of an inlier [cells]; library default
  int iterations = 100000;    ///< at most; few of the matches are right (our choice)
  double confidence = 0.999;  ///< library examples
  int least = 10;             ///< inliers to stand by the result; library's tutorial
};

/// Keypoints and descriptors on the Excess Green maps, nearest neighbours within what the guess
/// allows with Lowe's ratio, and an affine by USAC with the MAGSAC++ score (Barath et al. 2020).
/// Offset and tilt come from the ground as for the product.
std::unique_ptr<Method> makeSiftAffine(const SiftAffineOptions& options = {});

}  // namespace agricolmap::experiments
