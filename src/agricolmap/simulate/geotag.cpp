#include "agricolmap/simulate/geotag.hpp"

#include <cmath>
#include <numbers>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::simulate {

Geotag drawGeotag(const GeotagOptions& options, const Eigen::Vector3d& centre, double across_rows,
                  std::uint64_t seed) {
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
  const double heading = radians(signedError(options.heading_deg));
  const double scale_x = 1.0 + signedError(options.scale);
  const double scale_y = 1.0 + signedError(options.scale);
  error.z() = signedError(options.z);
  const double roll = radians(signedError(options.tilt_deg));
  const double pitch = radians(signedError(options.tilt_deg));
  const double axes = radians(options.file_heading_deg);
  const Eigen::Vector3d begin(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0),
                              random.uniform(-0.5, 0.5));
  const double aside = random.chance(0.5) ? options.across_rows : -options.across_rows;
  error += aside * Eigen::Vector3d(std::cos(across_rows), std::sin(across_rows), 0.0);
  const double factor = std::pow(options.unknown_scale, random.uniform(-1.0, 1.0));
  // Last, so that what is drawn before stays as it was.
  const double scale_z = 1.0 + signedError(options.vertical_scale);

  // The prior places the centre `error` away and takes heading, level and scale at face value.
  Geotag tag;
  if (!options.ugv_georeferenced) {
    tag.prior.linear() = Eigen::AngleAxisd(axes, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    tag.prior.translation() = centre + error - tag.prior.linear() * begin;
  }
  const Eigen::Vector3d file_centre = tag.prior.inverse() * Eigen::Vector3d(centre + error);
  // Lengths in the file are those of the field times the scale error, by `factor` too small.
  const Eigen::Vector3d unscale(factor / scale_x, factor / scale_y, factor / scale_z);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  tag.nominal.linear() = tag.prior.linear() * turn * unscale.asDiagonal();
  tag.nominal.translation() = centre - tag.nominal.linear() * file_centre;
  return tag;
}

}  // namespace agricolmap::simulate
