#include "agricolmap/simulate/geotag.hpp"

#include <cmath>
#include <numbers>

#include "agricolmap/core/random.hpp"

namespace agricolmap {

Geotag drawGeotag(const GeotagOptions& options, const Eigen::Vector3d& centre, std::uint64_t seed) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  Random random = Random::stream(seed, 7);
  const auto magnitude = [&](double value) {
    const double share = random.uniform();
    return options.uniform ? share * value : value;
  };
  const auto signedError = [&](double value) {
    const double size = magnitude(value);
    return random.chance(0.5) ? size : -size;
  };
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double shift = magnitude(options.translation);
  Eigen::Vector3d error(shift * std::cos(direction), shift * std::sin(direction), 0.0);
  const double heading = kDegree * signedError(options.heading_deg);
  const double scale_x = 1.0 + signedError(options.scale);
  const double scale_y = 1.0 + signedError(options.scale);
  error.z() = signedError(options.z);
  const double roll = kDegree * signedError(options.tilt_deg);
  const double pitch = kDegree * signedError(options.tilt_deg);
  const double axes = kDegree * options.file_heading_deg;
  const Eigen::Vector3d begin(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0),
                              random.uniform(-0.5, 0.5));

  // The prior places the centre `error` away and takes heading, level and scale at face value.
  Geotag tag;
  if (!options.ugv_georeferenced) {
    tag.prior.linear() = Eigen::AngleAxisd(axes, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    tag.prior.translation() = centre + error - tag.prior.linear() * begin;
  }
  const Eigen::Vector3d file_centre = tag.prior.inverse() * Eigen::Vector3d(centre + error);
  // Lengths in the file are those of the field times the scale error.
  const Eigen::Vector3d unscale(1.0 / scale_x, 1.0 / scale_y, 1.0);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  tag.nominal.linear() = tag.prior.linear() * turn * unscale.asDiagonal();
  tag.nominal.translation() = centre - tag.nominal.linear() * file_centre;
  return tag;
}

}  // namespace agricolmap
