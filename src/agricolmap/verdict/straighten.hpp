// Stage judge: a strip that drift has bent. The dense refinement locks on to the part that fits a
// single affine and leaves the rest beside its plants; the blocks of the evidence, each placed
// alone, tell how far.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "agricolmap/verdict/evidence.hpp"

namespace agricolmap::verdict {

/// The pose that fits all blocks best whose displacements fit their neighbours', so not the odd one
/// that fell for another plant: rotation, two scales along `scale_axes` (see SearchSpace) and a
/// shift, levelled moving → levelled fixed. Nothing when no such block disagrees with the pose that
/// the evidence was measured at: then that pose is the better one, because blocks are placed to
/// centimetres only.
std::optional<Eigen::Affine2d> straightenedPose(const Evidence& evidence,
                                                const Eigen::Matrix2d& scale_axes);

}  // namespace agricolmap::verdict
