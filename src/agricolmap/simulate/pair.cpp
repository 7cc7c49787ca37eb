#include "agricolmap/simulate/pair.hpp"

#include <cmath>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kUavCell = 0.007;  // the UAV's surface is rendered at half its usual spacing
constexpr double kMargin = 1.6;     // around the strip: what may hide it or shade it [m]

/// The geotag's errors of one pair.
struct GeotagError {
  Eigen::Vector3d shift;
  double yaw, roll, pitch, scale_x, scale_y;
};

GeotagError drawGeotag(const SimulationOptions& options) {
  const GeotagOptions& o = options.geotag;
  Random random = Random::stream(static_cast<std::uint64_t>(options.seed), 0x6E0);
  const auto magnitude = [&](double limit) {
    const double share = random.uniform();
    return limit * (o.uniform ? share : 1.0);
  };
  const auto sign = [&] { return random.chance(0.5) ? 1.0 : -1.0; };
  GeotagError error{};
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double distance = magnitude(o.translation);
  error.shift = {distance * std::cos(direction), distance * std::sin(direction),
                 sign() * magnitude(o.vertical)};
  error.yaw = sign() * magnitude(o.heading_deg) * kRadians;
  error.scale_x = 1.0 + sign() * magnitude(o.scale);
  error.scale_y = 1.0 + sign() * magnitude(o.scale);
  error.roll = random.normal(o.tilt_deg) * kRadians;
  error.pitch = random.normal(o.tilt_deg) * kRadians;
  return error;
}

Cloud cloudFrom(const std::vector<SensedPoint>& points, const Eigen::Affine3d& file_from_field,
                const char* name) {
  Cloud cloud;
  cloud.name = name;
  cloud.xyz.reserve(points.size());
  cloud.rgb.reserve(points.size());
  for (const SensedPoint& p : points) {
    cloud.xyz.push_back((file_from_field * p.measured).cast<float>());
    cloud.rgb.push_back(p.colour);
  }
  return cloud;
}

}  // namespace

StripPose placeStrip(const Eigen::AlignedBox2d& extent, double row_heading,
                     const SimulationOptions& options) {
  const UgvOptions& o = options.ugv;
  Random random = Random::stream(static_cast<std::uint64_t>(options.seed), 0x571);
  StripPose strip;
  strip.heading = row_heading + o.strip_heading_deg * kRadians +
                  (random.chance(0.5) ? std::numbers::pi : 0.0) + random.normal(1.0 * kRadians);
  const Eigen::Vector2d half(0.5 * (std::abs(std::cos(strip.heading)) * o.length +
                                    std::abs(std::sin(strip.heading)) * o.width),
                             0.5 * (std::abs(std::sin(strip.heading)) * o.length +
                                    std::abs(std::cos(strip.heading)) * o.width));
  const Eigen::Vector2d room =
      (0.5 * extent.sizes() - half - Eigen::Vector2d::Constant(o.margin)).cwiseMax(0.0);
  strip.centre = extent.center() + Eigen::Vector2d(random.uniform(-room.x(), room.x()),
                                                   random.uniform(-room.y(), room.y()));
  return strip;
}

SimulatedPair assemblePair(const std::vector<SensedPoint>& uav, const std::vector<SensedPoint>& ugv,
                           const StripPose& strip, const SimulationOptions& options) {
  const auto seed = static_cast<std::uint64_t>(options.seed);
  Random random = Random::stream(seed, 0x0FF);
  SimulatedPair pair;
  pair.overlaps = !options.other_field;
  // The UAV's file is the field frame; its offset says where that lies in UTM.
  pair.world_from_uav = Eigen::Affine3d(Eigen::Translation3d(
      468000.0 + random.uniform(0, 900), 5255000.0 + random.uniform(0, 900), 540.25));
  pair.uav = cloudFrom(uav, Eigen::Affine3d::Identity(), "uav");

  // The UGV's file begins near the strip's start, its x axis roughly along the path.
  const GeotagError error = drawGeotag(options);
  const double file_heading = strip.heading + random.uniform(-10.0, 10.0) * kRadians;
  const Eigen::Vector3d centre(strip.centre.x(), strip.centre.y(), 0.0);
  const Eigen::Vector3d arm(0.5 * options.ugv.length, 0.0, 0.0);
  const Eigen::AngleAxisd file_turn(file_heading, Eigen::Vector3d::UnitZ());
  // Claimed: what the geotag says. True: heading, tilt and scales of the file corrected.
  pair.prior = Eigen::Translation3d(centre + error.shift) * file_turn * Eigen::Translation3d(-arm);
  pair.nominal = Eigen::Translation3d(centre) *
                 Eigen::AngleAxisd(file_heading + error.yaw, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(error.pitch, Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(error.roll, Eigen::Vector3d::UnitX()) *
                 Eigen::Scaling(1.0 / error.scale_x, 1.0 / error.scale_y, 1.0) *
                 Eigen::Translation3d(-arm);
  pair.world_from_ugv = pair.world_from_uav * pair.prior;
  pair.ugv = cloudFrom(ugv, pair.nominal.inverse(), "ugv");
  pair.truth.reserve(ugv.size());
  for (const SensedPoint& p : ugv) pair.truth.push_back(p.truth);
  pair.centre = centre;
  return pair;
}

SimulatedPair simulatePair(const SimulationOptions& options) {
  SimulationOptions checked = options;
  optionTable(checked).check();
  const auto seed = static_cast<std::uint64_t>(options.seed);
  const Scene field(options, seed);
  std::vector<SensedPoint> uav;
  {
    const double cell = std::min(kUavCell, options.uav.spacing);
    uav = senseFromAbove(renderCanopy(field, View::kUav, field.extent(), cell), options, seed);
  }
  const Scene other(options, options.other_field ? seed + 0x5EED0000ULL : seed);
  const Scene& driven = options.other_field ? other : field;
  const StripPose strip = placeStrip(driven.extent(), driven.rowHeading(), options);
  const double half = 0.5 * std::hypot(options.ugv.length, options.ugv.width) + kMargin;
  const Eigen::Vector2d along(std::abs(std::cos(strip.heading)), std::abs(std::sin(strip.heading)));
  const Eigen::Vector2d reach(
      std::min(half,
               0.5 * (along.x() * options.ugv.length + along.y() * options.ugv.width) + kMargin),
      std::min(half,
               0.5 * (along.y() * options.ugv.length + along.x() * options.ugv.width) + kMargin));
  const Canopy canopy = renderCanopy(
      driven, View::kUgv, Eigen::AlignedBox2d(strip.centre - reach, strip.centre + reach),
      std::max(options.ugv.spacing, 0.004));
  const std::vector<SensedPoint> ugv = senseFromGround(canopy, strip, options, seed);
  if (ugv.size() < 100) throw InputError("the simulated strip sees nothing; check ugv.* options");
  return assemblePair(uav, ugv, strip, options);
}

}  // namespace agricolmap
