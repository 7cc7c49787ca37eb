// The registration: from two clouds and an initial guess to a transformation and a verdict.
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"
#include "agricolmap/options.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

/// How a caller follows a registration while it runs.
struct Control {
  std::stop_token stop;  ///< when it asks to stop, Interrupted is thrown soon after
  /// Called at the beginning of each stage, from the thread that registers.
  std::function<void(std::string_view stage)> on_stage;
  int threads = 0;  ///< at most so many; 0: all cores. The result does not depend on it
};

/// Finds the transformation that lays `moving` (the ground robot's cloud) into `fixed` (the
/// drone's). `guess`: moving file → fixed file coordinates, as wrong as `options.prior()` allows.
/// z points up to within 45° in both; they need colours unless the option `geometry_only` is set.
/// `path`: where the robot drove, in order, in the moving file's coordinates; it serves strips
/// longer than the option `pieces.from` whose shape does not tell it. Empty: the shape must.
///
/// Throws InputError for clouds that cannot be used, UsageError for options that make no sense
/// beside one another or would do nothing, Interrupted. A registration that fails is a rejected
/// result, not an exception.
AGRICOLMAP_EXPORT Registration registerClouds(const Cloud& fixed, const Cloud& moving,
                                              const Transform& guess,
                                              const Options& options = Options(),
                                              const Control& control = {},
                                              const std::vector<Eigen::Vector3d>& path = {});

/// The moving cloud where a registration lays it, in the fixed file's coordinates: transformation
/// and deformation. Throws UsageError for a registration without a transformation, or that
/// registerClouds did not return.
AGRICOLMAP_EXPORT Cloud alignedCloud(const Cloud& moving, const Registration& registration);

}  // namespace agricolmap
