// registration.json read again: what of it lays clouds.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/deform/file_deformation.hpp"

namespace agricolmap::report {

struct StoredRegistration {
  std::string status;  ///< "accepted", "rejected" or "ambiguous"
  std::vector<std::string> reasons;
  /// Moving file → fixed file coordinates [m]; nothing where there is no answer at all.
  std::optional<Eigen::Affine3d> fixed_from_moving;
  /// On top of it: the very function that the registration had.
  std::optional<deform::FileDeformation> deformation;
  Crs crs;                             ///< of all coordinates here, in metres; empty: nobody said
  std::optional<Crs> moving_file_crs;  ///< of the moving file itself, before it was brought there
  Eigen::Vector3d moving_origin = Eigen::Vector3d::Zero();  ///< about where it lies [m]

  /// Expected RMS in the plane and deviation in height [m]; infinite where nobody knows.
  double plane_error = std::numeric_limits<double>::infinity();
  double height_error = std::numeric_limits<double>::infinity();
  bool heights_limited = true;

  bool accepted() const { return status == "accepted"; }
};

/// `run`: the folder that a registration was written to, or the file itself. Throws InputError that
/// names the file and what is wrong: it is missing or damaged, of a newer version, or of one that
/// does not tell the deformation in full.
StoredRegistration readRegistration(const std::filesystem::path& run);

}  // namespace agricolmap::report
