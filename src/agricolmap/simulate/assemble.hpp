// The parts that every kind of simulated pair shares: where the strip lies, the two visits, and
// turning points of the field into files with their truth.
#pragma once

#include "agricolmap/simulate/field/mosaic_pieces.hpp"
#include "agricolmap/simulate/field/render.hpp"
#include "agricolmap/simulate/field/views.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap::simulate {

/// Middle of the strip in the field and direction of travel.
struct StripPlace {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double heading = 0.0;
};

/// Direction of travel in a field with rows in this direction [rad].
double stripHeading(const UgvOptions& options, double row_heading);

/// How much wider and higher the field is than the strip with its border [m]; negative where it
/// does not fit.
Eigen::Vector2d stripRoom(const UgvOptions& options, const Eigen::Vector2d& field_size,
                          double heading);

/// A random place inside a field of the given size, or overhanging its border by the share asked
/// for. Throws UsageError when the strip does not fit.
StripPlace placeStrip(const UgvOptions& options, const Eigen::Vector2d& field_size,
                      double row_heading, std::uint64_t seed);

/// The second pass of a robot that drives back, see UgvOptions::back.
StripPlace wayBack(const StripPlace& there, const UgvOptions& options);
/// The points of both passes in the coordinates of the first.
FieldPoints thereAndBack(FieldPoints there, const FieldPoints& back, const UgvOptions& options);

/// The strip with a border wide enough for what can hide it.
Window stripWindow(const StripPlace& strip, const UgvOptions& options);

/// Cell of the UAV's canvas [m]: at least two per ground sampling distance, at most
/// `uav.canvas`.
double uavCell(const SimulationOptions& options);

Visit flightOf(const ViewOptions& views, std::uint64_t seed);
Visit driveOf(const ViewOptions& views, std::uint64_t seed);

/// Where the UAV file's coordinates begin in a field that is nowhere: like UTM, or at zero.
Eigen::Vector3d madeUpBase(const GeotagOptions& options);

/// The seed of a strip's own random numbers; strip 0 has the pair's.
std::uint64_t stripSeed(std::uint64_t pair_seed, int index);

/// The drone's file. `base` is the field frame's zero in its coordinates; throws UsageError when
/// there is no point.
Cloud cloudFromAbove(FieldPoints above, const Eigen::Vector3d& base);

/// The robot's file, its truth in a map of these pieces and affines, from points as senseFromGround
/// gives them. Mirrors it where the options say so. Throws UsageError when there is no point.
SimulatedStrip assembleStrip(const SimulationOptions& options, const Eigen::Vector3d& base,
                             const StripPlace& place, FieldPoints below, const MosaicPieces& pieces,
                             std::uint64_t seed);

}  // namespace agricolmap::simulate
