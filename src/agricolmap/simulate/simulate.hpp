// Simulated pairs of clouds with exact truth: a drone's map of a crop field and a ground robot's
// strip of it, taken at another time, from another side, with another camera.
#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/simulate/field/field_model.hpp"
#include "agricolmap/simulate/field/plant_truth.hpp"
#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap::simulate {

/// The robot's cloud and where it belongs.
struct SimulatedStrip {
  Cloud ugv;
  /// Per UGV point, where it lies in the UAV file's coordinates [m]: the recorded point, sensor
  /// noise included, without drift and without the errors of scale, level and geotag; in a map of
  /// pieces (MosaicOptions) where its piece shows it.
  std::vector<Eigen::Vector3d> truth;
  Eigen::Affine3d best_affine;  ///< UGV file → UAV file: least squares fit to `truth`
  Eigen::Affine3d nominal;      ///< UGV file → UAV file: exact but for drift and pieces
  Eigen::Affine3d prior;        ///< UGV file → UAV file: the initial guess
  Eigen::Vector3d strip_centre = Eigen::Vector3d::Zero();  ///< UAV file coordinates [m]
  /// Where the robot's odometry says that it drove, UGV file coordinates [m].
  std::vector<Eigen::Vector3d> path;
  double strip_heading = 0.0;  ///< direction of travel in the UAV file [rad]
  double row_heading = 0.0;    ///< direction of the UAV field's rows [rad]
  /// False when the map does not show what the strip does (SimulationOptions::other_field,
  /// beyond_map, mirrored); `truth` is then where it would have lain.
  bool overlaps = true;
};

struct SimulatedPair : SimulatedStrip {
  Cloud uav;  ///< metrically right but for its own noise, dome and pieces
};

/// Whether the drone's clouds of these options show the same field by the same sensor: all that
/// belongs to a strip or to a visit may differ.
bool sameField(const SimulationOptions& a, const SimulationOptions& b);

/// A field as the drone saw it, made once, and any number of strips of it: making the drone's view
/// takes most of the time of a pair.
class SimulatedField {
 public:
  /// Throws UsageError as simulatePair does.
  explicit SimulatedField(const SimulationOptions& options);

  const Cloud& uav() const { return uav_; }
  Cloud takeUav() && { return std::move(uav_); }

  /// Strip number `index` of the field, with its own place, drive, sensor noise and guess. Of
  /// `options`, the field, the drone and the seed must be those of the field (sameField);
  /// everything else may be the strip's own. The flight stays as it was: its sun, its wind and the
  /// share of leaves that it drew for itself are the field's. Strip 0 of the field's own options is
  /// that of simulatePair.
  SimulatedStrip strip(const SimulationOptions& options, int index = 0) const;

  /// The plants and weeds of the field at the flight, in the UAV file's coordinates. In a map of
  /// pieces each is where the piece that it lies in shows it, which near the borders of pieces may
  /// be cut off or shown twice.
  std::vector<TruePlant> plants() const;

 private:
  SimulationOptions options_;
  FieldModel field_;
  Cloud uav_;
};

/// Equal options give equal bits on any number of threads. Throws UsageError when an option is
/// outside its limits or the strip does not fit into the field.
SimulatedPair simulatePair(const SimulationOptions& options);

}  // namespace agricolmap::simulate
