// From a place in the levelled frames to the answer in the coordinates of the files.
#pragma once

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// Turns poses of the levelled frames into transforms of the files. Large coordinates cancel in
/// double, at the very end. All references must outlive it.
class FrameChange {
 public:
  FrameChange(const Eigen::Vector3d& fixed_origin, const Eigen::Vector3d& moving_origin,
              const PairFrames& frames)
      : fixed_origin_(fixed_origin), moving_origin_(moving_origin), frames_(frames) {}

  Eigen::Affine3d local(const Eigen::Affine3d& levelled) const {
    return frames_.levelled_from_fixed.inverse() * levelled * frames_.levelled_from_moving;
  }
  Eigen::Affine3d inFiles(const Eigen::Affine3d& local) const {
    return Eigen::Translation3d(fixed_origin_) * local * Eigen::Translation3d(-moving_origin_);
  }
  /// The other way round.
  Eigen::Affine3d levelled(const Eigen::Affine3d& in_files) const {
    const Eigen::Affine3d local =
        Eigen::Translation3d(-fixed_origin_) * in_files * Eigen::Translation3d(moving_origin_);
    return frames_.levelled_from_fixed * local * frames_.levelled_from_moving.inverse();
  }

 private:
  const Eigen::Vector3d& fixed_origin_;
  const Eigen::Vector3d& moving_origin_;
  const PairFrames& frames_;
};

/// `scale`: what the moving file was enlarged by before it was gridded; 1 where its scale is known.
Registration compose(const CloudFacts& fixed, const Cloud& moving, PairMaps maps, Outcome outcome,
                     double scale, const RegistrationOptions& options);

}  // namespace agricolmap::pipeline
