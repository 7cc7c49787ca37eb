// The calls into Open3D, in a library of their own. Debian builds Open3D for any x86-64; our code
// is built for AVX2, where Eigen aligns its types differently, so nothing of Eigen passes this
// header.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace agricolmap::experiments {

using PlainPoints = std::vector<std::array<double, 3>>;

struct FpfhGicpResult {
  bool found = false;
  std::string why;                     ///< when not
  std::array<double, 16> transform{};  ///< moving → fixed, row-major [m]
  double features_s = 0.0;             ///< seconds
  double global_s = 0.0;
  double gicp_s = 0.0;
};

/// FPFH, fast global registration (Zhou, Park & Koltun 2016) on them, and generalised ICP from
/// there and from the identity (the guess); the one with the smaller error at the end is kept.
/// RANSAC in place of the fast one took 10 to 70 s on a strip of 10 m and did not find it either.
/// Deterministic: what depends on the number of threads runs on one.
FpfhGicpResult registerByFpfhGicp(const PlainPoints& fixed, const PlainPoints& moving);

}  // namespace agricolmap::experiments
