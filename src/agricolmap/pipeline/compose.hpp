// From a place in the levelled frames to the answer in the coordinates of the files.
#pragma once

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// `scale`: what the moving file was enlarged by before it was gridded; 1 where its scale is known.
Registration compose(const CloudFacts& fixed, const Cloud& moving, PairMaps maps, Outcome outcome,
                     double scale, const RegistrationOptions& options);

}  // namespace agricolmap::pipeline
