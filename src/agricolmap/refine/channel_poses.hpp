// Plants and soil as two witnesses of one pose: they err differently, and by how far they
// contradict one another either may.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "agricolmap/refine/dense_refine.hpp"

namespace agricolmap::refine {

/// By how far [m], root mean square over the moving map's cells, `pose` may be wrong because the
/// greenness and heights alone, and the luminance alone, refine it to different places: plants
/// grow, lean and hide the ground; shadows move. Either may be right, as likely as it is weighty,
/// by how well the maps agree in it; the pose lies between them by the same weights. Nothing where
/// one of the two cannot be followed.
std::optional<double> disagreementOfChannels(const map::SignalMap& fixed,
                                             const map::SignalMap& moving,
                                             const Eigen::Affine2d& pose,
                                             const DenseRefineOptions& options);

}  // namespace agricolmap::refine
