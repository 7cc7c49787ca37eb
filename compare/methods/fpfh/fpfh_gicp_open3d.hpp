// The calls into Open3D, in a library of their own. Debian builds Open3D for any x86-64; our code
// is built for AVX2, where Eigen aligns its types differently, so nothing of Eigen passes this
// header.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace agricolmap::compare {

using PlainPoints = std::vector<std::array<double, 3>>;

struct FpfhGicpParameters {
  /// Side of the cubes that points are merged to [m]. The library's tutorial on global registration
  /// has 5 cm, for a room; plants are of that size, so it is kept. All other lengths follow from
  /// it.
  double voxel = 0.05;
  double normal_radius = 2.0;        ///< [voxels]; tutorial
  int normal_neighbours = 30;        ///< tutorial
  double feature_radius = 5.0;       ///< [voxels]; tutorial
  int feature_neighbours = 100;      ///< tutorial
  double ransac_distance = 1.5;      ///< [voxels]; tutorial
  double edge_length = 0.9;          ///< similarity of edges of a sample; tutorial
  int ransac_points = 3;             ///< tutorial
  int ransac_iterations = 100000;    ///< tutorial
  double ransac_confidence = 0.999;  ///< tutorial
  /// Of pairs of the refinement [voxels]. The tutorial has 0.4, after a rougher ICP: a room's walls
  /// forgive what plants do not (our choice).
  double gicp_distance = 1.5;
  int gicp_iterations = 100;  ///< library: 30, not always enough (our choice)
  int seed = 1;               ///< of RANSAC
};

struct FpfhGicpResult {
  bool found = false;
  std::string why;                     ///< when not
  std::array<double, 16> transform{};  ///< moving → fixed, row-major [m]
  bool from_ransac = false;            ///< whether RANSAC's pose led there, or the guess
  double ransac_fitness = 0.0;         ///< share of moving points with a fixed one near
  double fitness = 0.0;                ///< the same in the end
  double rmse = 0.0;                   ///< of these [m]
  double features_s = 0.0;             ///< seconds
  double ransac_s = 0.0;
  double gicp_s = 0.0;
};

/// FPFH, RANSAC on mutual matches, and generalised ICP from RANSAC's pose and from the identity
/// (the guess); the one with the smaller error at the end is kept. Deterministic: what depends on
/// the number of threads runs on one.
FpfhGicpResult registerByFpfhGicp(const PlainPoints& fixed, const PlainPoints& moving,
                                  const FpfhGicpParameters& parameters);

}  // namespace agricolmap::compare
