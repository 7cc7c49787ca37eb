// Where the scale of the moving file is not known at all, as of a map from one moving camera
// (structure from motion): the factors that are tried before anything else.
#pragma once

#include <vector>

#include "agricolmap/core/search_space.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// Factors from 0.1 to 10 such that what lies between them is within the scales that a search
/// covers, nearest to 1 first; then those half way between, for files whose two axes differ.
/// Factors at which a moving map of these bounds would be too large for the fixed map, or too small
/// to hold anything that could be recognised, are left out.
std::vector<double> scaleFactors(const map::Box2& moving, const map::Box2& fixed,
                                 const PriorUncertainty& uncertainty);

/// The guess with the moving cloud made larger about its middle (see meanOf).
Eigen::Affine3d scaledGuess(const Eigen::Vector3d& middle, const Eigen::Affine3d& guess,
                            double factor);

/// What one factor led to.
struct ScaleTrial {
  double factor = 1.0;
  PairFrames frames;
  Outcome outcome;
};

/// The factor by which the moving file is to be enlarged, as far as a trial tells.
double scaleOf(const ScaleTrial& trial, const Eigen::Matrix2d& scale_axes);

/// Moves what a trial found from the trial's levelled frame of the moving map into that of
/// `frames`, after the moving cloud was levelled anew: its place as the only placement, and its
/// rivals.
ScaleTrial carriedOver(ScaleTrial trial, const PairFrames& frames);

}  // namespace agricolmap::pipeline
