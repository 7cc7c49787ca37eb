// FPFH, fast global registration and generalised ICP on the clouds themselves: what a practitioner
// would run today.
#pragma once

#include <memory>

#include "experiments/methods/fpfh/fpfh_gicp_open3d.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// All points take part, ground and plants, levelled and cut to what the guess allows. Rigid: the
/// transform is the library's own, in three dimensions. Accepted when it lies within the limits of
/// the guess: a field fits itself nearly everywhere, so its fitness tells nothing.
std::unique_ptr<Method> makeFpfhGicp(const FpfhGicpParameters& parameters = {});

}  // namespace agricolmap::experiments
