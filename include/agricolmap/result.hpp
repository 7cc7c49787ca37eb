// What a registration found: a verdict with its reasons and, where there is any, a transformation.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"

namespace agricolmap {

struct Registration {
  enum class Status {
    kAccepted,
    kRejected,
    kAmbiguous,  ///< the clouds fit, but in several places that the data cannot tell apart
  };

  /// What the transformation adds to the initial guess, at the middle of the moving cloud.
  struct Parts {
    Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< that middle, in the fixed file
    double heading_deg = 0.0;
    double tilt_x_deg = 0.0;  ///< between the ground planes
    double tilt_y_deg = 0.0;
    double scale_x = 1.0;  ///< along the moving file's axes
    double scale_y = 1.0;
    double scale_z = 1.0;
    double shear = 0.0;
  };

  /// How accurate the transformation is, if it is right.
  struct Uncertainty {
    double expected_rms_m = 0.0;  ///< horizontally, over the moving cloud
    double local_rms_m = 0.0;     ///< part of that which no affine undoes: drift, wind
    /// Row-major, of (shift x, y, z [m], heading [rad], scale x, y [relative]) about `centre_m`.
    std::array<double, 36> covariance{};
    Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< fixed file coordinates
    double height_deviation_m = 0.0;
  };

  /// How the moving cloud is bent beside the transformation: drift and slips of the odometry along
  /// its path. Only what parts of the cloud confirm that took no part in finding it.
  struct Deformation {
    /// A place of the path.
    struct Node {
      double along_m = 0.0;                                      ///< path length
      Eigen::Vector3d place_m = Eigen::Vector3d::Zero();         ///< fixed file coordinates
      Eigen::Vector3d displacement_m = Eigen::Vector3d::Zero();  ///< fixed file's axes
      Eigen::Vector3d deviation_m = Eigen::Vector3d::Zero();     ///< of the place, per axis
    };
    /// All that lies behind is displaced against all before.
    struct Slip {
      double along_m = 0.0;
      Eigen::Vector3d place_m = Eigen::Vector3d::Zero();   ///< fixed file coordinates
      Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< fixed file's axes
      double deviation_m = 0.0;                            ///< of the offset, per axis
    };
    std::vector<Node> nodes;  ///< in order along the path
    std::vector<Slip> slips;
    double gain = 0.0;   ///< by which left-out parts confirm it, in standard errors
    double rms_m = 0.0;  ///< of the displacements in the plane
    /// Displacement of a point of the moving file, along the fixed file's axes [m]: it lies at
    /// fixed_from_moving * point + displacement(point). Any thread may call it.
    std::function<Eigen::Vector3d(const Eigen::Vector3d&)> displacement;
  };

  /// What speaks for it, measured on the clouds themselves.
  struct Evidence {
    double significance = 0.0;  ///< the peak over the deviation of the score
    double uniqueness = 0.0;    ///< the peak over the highest other one
    std::size_t blocks = 0;     ///< parts of the moving cloud that were placed alone
    std::size_t agreeing_blocks = 0;
    double overlap = 0.0;  ///< share of the moving map that the fixed map sees
    double correlation = 0.0;
  };

  /// Whether heights are as good as the place; acceptance does not hang on it.
  struct Heights {
    bool measured = false;
    std::string limit;         ///< "flat", "no_ground", "canopy" or "uneven"; empty when measured
    std::string words;         ///< the same in plain words
    double deviation_m = 0.0;  ///< of the height, bias included; infinite without heights
    double bias_m = 0.0;       ///< part of it that all of the cloud has in common
    /// Metres up in the fixed cloud for one in the moving one, where the relief of the ground tells
    /// it; the transformation follows it where it is clearly not 1.
    std::optional<double> vertical_scale;
    double vertical_scale_deviation = 0.0;  ///< of that; 0 without
  };

  /// Another place where the moving cloud fits.
  struct Alternative {
    Transform fixed_from_moving = Transform::Identity();
    double significance = 0.0;
  };

  struct StageTime {
    std::string stage;
    double seconds = 0.0;
  };

  bool accepted() const { return status == Status::kAccepted; }

  Status status = Status::kRejected;
  std::vector<std::string> reasons;   ///< why, in plain words; never empty
  std::vector<std::string> remedies;  ///< what may help where it is not accepted
  double plane_probability = 0.0;     ///< that the result is within 5 cm RMS in the plane
  double place_probability = 0.0;     ///< calibrated, that it is the right place, however exact

  /// Moving file → fixed file coordinates [m]. A rejected registration may have one, too: the best
  /// that was found. Nothing: no place at all.
  std::optional<Transform> fixed_from_moving;
  std::optional<Parts> parts;              ///< as long as there is a transformation
  std::optional<Deformation> deformation;  ///< on top of the transformation; nothing: none
  std::optional<Uncertainty> uncertainty;  ///< nothing where too few blocks can be compared
  std::optional<Heights> heights;          ///< as long as there is a transformation
  Evidence evidence;
  std::vector<Alternative> alternatives;  ///< of an ambiguous one, most significant first

  std::vector<StageTime> times;
  std::vector<std::string> warnings;  ///< about the clouds and the way to the result

  /// What reports and pictures are made from.
  struct Record;
  std::shared_ptr<const Record> record;
};

/// "accepted", "rejected" or "ambiguous".
AGRICOLMAP_EXPORT const char* toString(Registration::Status status);

// The library is built for a newer processor than its users may be (-march), and Eigen aligns its
// types by that: none that it aligns may be part of what is handed over.
static_assert(alignof(Registration) == alignof(double) && alignof(Cloud) == alignof(double));

}  // namespace agricolmap
