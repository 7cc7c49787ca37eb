// Detectors and descriptors of OpenCV: ORB, SIFT, and FAST with our BRIEF.
#pragma once

#include <memory>

#include "experiments/methods/features/brief.hpp"
#include "experiments/methods/features/features.hpp"

namespace agricolmap::experiments {

struct OrbOptions {
  int most = 10000;             ///< keypoints; library: 500, too few for 200 m² (our choice)
  double pyramid_factor = 1.2;  ///< library default
  int levels = 8;               ///< library default
  int fast_threshold = 10;  ///< library: 20, tuned on photographs; maps are smoother (our choice)
};

struct FastBriefOptions {
  int threshold = 10;  ///< library default [grey levels]
  int most = 10000;    ///< strongest keypoints kept (our choice)
  BriefOptions brief;
};

struct SiftOptions {
  int most = 10000;        ///< keypoints (our choice); library: all
  double contrast = 0.02;  ///< library: 0.04; maps are smoother than photographs (our choice)
  double edge = 10.0;      ///< library default
  double sigma = 1.6;      ///< library default
};

std::unique_ptr<FeatureExtractor> makeOrb(const OrbOptions& options = {});
std::unique_ptr<FeatureExtractor> makeFastBrief(const FastBriefOptions& options = {});
std::unique_ptr<FeatureExtractor> makeSift(const SiftOptions& options = {});

}  // namespace agricolmap::experiments
