// The calls into Open3D, in a library of their own. Debian builds Open3D for any x86-64; our code
// is built for AVX2, where Eigen aligns its types differently, so nothing of Eigen passes this
// header.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace agricolmap::experiments {

using PlainPoints = std::vector<std::array<double, 3>>;

struct FpfhGicpParameters {
  /// Side of the cubes that points are merged to for the features [m]; the tutorial has 5 cm, for a
  /// room. Our choice: features then reach half a metre, to the next plants and rows, in seconds.
  double voxel = 0.10;
  /// And for the refinement [m], which the tutorial, too, does on finer points.
  double fine_voxel = 0.05;
  double normal_radius = 2.0;    ///< [voxels]; tutorial
  int normal_neighbours = 30;    ///< tutorial
  double feature_radius = 5.0;   ///< [voxels]; tutorial
  int feature_neighbours = 100;  ///< tutorial
  double fgr_distance = 0.5;     ///< of a correspondence [voxels]; tutorial
  int fgr_iterations = 64;       ///< library default
  int fgr_tuples = 1000;         ///< library default
  /// Of pairs of the refinement [fine voxels]. The tutorial has 0.4, after a rougher ICP: a room's
  /// walls forgive what plants do not (our choice).
  double gicp_distance = 1.5;
  int gicp_iterations = 100;  ///< library: 30, not always enough (our choice)
  int seed = 1;               ///< of the draw of tuples
};

struct FpfhGicpResult {
  bool found = false;
  std::string why;                     ///< when not
  std::array<double, 16> transform{};  ///< moving → fixed, row-major [m]
  bool from_features = false;          ///< whether the features led there, or the guess
  double fitness = 0.0;                ///< share of moving points with a fixed one near, in the end
  double rmse = 0.0;                   ///< of these [m]
  double features_s = 0.0;             ///< seconds
  double global_s = 0.0;
  double gicp_s = 0.0;
};

/// FPFH, fast global registration (Zhou, Park & Koltun 2016) on them, and generalised ICP from
/// there and from the identity (the guess); the one with the smaller error at the end is kept.
/// RANSAC in place of the fast one took 10 to 70 s on a strip of 10 m and did not find it either.
/// Deterministic: what depends on the number of threads runs on one.
FpfhGicpResult registerByFpfhGicp(const PlainPoints& fixed, const PlainPoints& moving,
                                  const FpfhGicpParameters& parameters);

}  // namespace agricolmap::experiments
