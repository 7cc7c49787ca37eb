#include "agricolmap/simulate/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/field/drift.hpp"
#include "agricolmap/simulate/geotag.hpp"

namespace agricolmap::simulate {

namespace {

constexpr double kStripMargin = 0.3;   // between strip and border of the field [m]
constexpr double kHidingMargin = 0.5;  // canvas around the strip [m]

/// Half the size of the box around a strip at this heading, with its border.
Eigen::Vector2d halfBox(const UgvOptions& options, double heading) {
  const double c = std::abs(std::cos(heading));
  const double s = std::abs(std::sin(heading));
  const double width = options.width + (options.back ? std::abs(options.back_aside) : 0.0);
  return {0.5 * (options.length * c + width * s) + kStripMargin,
          0.5 * (options.length * s + width * c) + kStripMargin};
}

bool insideField(const Eigen::Vector2d& point, const Eigen::Vector2d& size) {
  return point.x() >= 0.0 && point.y() >= 0.0 && point.x() <= size.x() && point.y() <= size.y();
}

/// What the robot drove: a straight line, or there and back again, and what its odometry made of
/// it.
class Way {
 public:
  Way(const UgvOptions& options, std::uint64_t seed)
      : options_(options),
        drift_(options.back ? 2.0 * options.length : options.length, options.drift, seed) {}

  /// Of a point `local`, in metres along the strip and to the left of its middle, in these axes.
  Eigen::Vector3d drift(const Eigen::Vector3d& local, bool back) const {
    if (!back) return drift_.at(local.x(), local.y());
    // The robot's own ahead and left are the strip's behind and right.
    const Eigen::Vector3d own =
        drift_.at(2.0 * options_.length - local.x(), options_.back_aside - local.y());
    return {-own.x(), -own.y(), own.z()};
  }
  /// Places that it passed, in order, and whether on the way back.
  std::vector<std::pair<Eigen::Vector3d, bool>> middle() const {
    std::vector<std::pair<Eigen::Vector3d, bool>> places;
    const int steps = std::max(1, static_cast<int>(std::ceil(options_.length / kPathStep)));
    for (const bool back : {false, true}) {
      if (back && !options_.back) break;
      for (int i = 0; i <= steps; ++i) {
        const double along = options_.length * (back ? steps - i : i) / steps;
        places.push_back({{along, back ? options_.back_aside : 0.0, 0.0}, back});
      }
    }
    return places;
  }

 private:
  static constexpr double kPathStep = 0.5;  // [m]
  UgvOptions options_;
  Drift drift_;
};

void checkSeen(const FieldPoints& points) {
  if (!points.xyz.empty()) return;
  throw UsageError(
      "the simulated sensors saw no point; raise uav.density, ugv.edge_density or "
      "ugv.camera_height");
}

}  // namespace

double stripHeading(const UgvOptions& options, double row_heading) {
  return row_heading + radians(options.heading_deg);
}

Eigen::Vector2d stripRoom(const UgvOptions& options, const Eigen::Vector2d& field_size,
                          double heading) {
  return field_size - 2.0 * halfBox(options, heading);
}

StripPlace placeStrip(const UgvOptions& options, const Eigen::Vector2d& field_size,
                      double row_heading, std::uint64_t seed) {
  Random random = Random::stream(seed, 9);
  StripPlace strip;
  strip.heading = stripHeading(options, row_heading);
  const Eigen::Vector2d half = halfBox(options, strip.heading);
  const Eigen::Vector2d room = stripRoom(options, field_size, strip.heading);
  if (room.minCoeff() < 0.0) {
    throw UsageError(fmt::format(
        "a strip of {} x {} m at {:.0f} degrees does not fit into a field of {} x {} m; enlarge "
        "field.width and field.height or shorten ugv.length",
        options.length, options.width, degrees(strip.heading), field_size.x(), field_size.y()));
  }
  strip.centre = half + Eigen::Vector2d(random.uniform() * room.x(), random.uniform() * room.y());
  if (options.back) {
    strip.centre += 0.5 * options.back_aside *
                    Eigen::Vector2d(std::sin(strip.heading), -std::cos(strip.heading));
  }
  if (options.overhang > 0.0) {
    // Forwards until the share asked for lies beyond the border.
    const Eigen::Vector2d ahead(std::cos(strip.heading), std::sin(strip.heading));
    const double last_inside = options.length * (0.5 - options.overhang);
    while (insideField(strip.centre + last_inside * ahead, field_size))
      strip.centre += 0.02 * ahead;
  }
  return strip;
}

StripPlace wayBack(const StripPlace& there, const UgvOptions& options) {
  const Eigen::Vector2d left(-std::sin(there.heading), std::cos(there.heading));
  return {there.centre + options.back_aside * left, there.heading + std::numbers::pi};
}

FieldPoints thereAndBack(FieldPoints there, const FieldPoints& back, const UgvOptions& options) {
  const auto length = static_cast<float>(options.length);
  const auto aside = static_cast<float>(options.back_aside);
  there.there = there.xyz.size();
  for (const Eigen::Vector3f& p : back.xyz) {
    there.xyz.emplace_back(length - p.x(), aside - p.y(), p.z());
  }
  there.rgb.insert(there.rgb.end(), back.rgb.begin(), back.rgb.end());
  return there;
}

Window stripWindow(const StripPlace& strip, const UgvOptions& options) {
  const double width = options.length + 2.0 * kHidingMargin;
  const double height = options.width + 2.0 * kHidingMargin;
  const Eigen::Vector2d corner =
      strip.centre - Eigen::Rotation2Dd(strip.heading) * Eigen::Vector2d(0.5 * width, 0.5 * height);
  return makeWindow(corner, strip.heading, width, height,
                    std::clamp(options.spacing, 0.003, 0.008));
}

double uavCell(const SimulationOptions& options) {
  const double blocks = std::max(2.0, std::ceil(options.uav.gsd / options.uav.canvas));
  return options.uav.gsd / blocks;
}

Visit flightOf(const ViewOptions& views, std::uint64_t seed) {
  Visit visit;
  visit.seed = seed;
  visit.leaf_unshared = views.leaf_unshared;
  visit.soil_unshared = views.leaf_unshared * (1.0 - views.soil_kept);
  // Half of the variance between the views comes from each; two axes share it.
  visit.wind = 0.5 * views.wind;
  Random random = Random::stream(seed, 21);
  const double downwind = random.uniform(0.0, 2.0 * std::numbers::pi);
  visit.lean =
      std::tan(radians(views.lean_deg)) * Eigen::Vector2d(std::cos(downwind), std::sin(downwind));
  visit.ripeness = views.ripeness;
  visit.weeds_new = views.weeds_new;
  visit.solar_hour = views.sun_hour;
  visit.overcast = views.overcast;
  return visit;
}

Visit driveOf(const ViewOptions& views, std::uint64_t seed) {
  Visit visit = flightOf(views, seed);
  visit.growth = views.growth;
  visit.growth_spread = views.growth_spread;
  visit.ripeness = views.ripeness + views.ripening;
  visit.soil_contrast = views.soil_contrast;
  visit.weeds_new = 0.0;
  visit.plants_lost = views.plants_lost;
  visit.weeds_pulled = views.weeds_pulled;
  visit.solar_hour = views.sun_hour + views.sun_hours;
  return visit;
}

Eigen::Vector3d madeUpBase(const GeotagOptions& options) {
  return options.utm ? Eigen::Vector3d(352417.36, 4815306.82, 118.64) : Eigen::Vector3d::Zero();
}

std::uint64_t stripSeed(std::uint64_t pair_seed, int index) {
  return index == 0 ? pair_seed : hashBits(pair_seed, static_cast<std::uint64_t>(index));
}

Cloud cloudFromAbove(FieldPoints above, const Eigen::Vector3d& base) {
  checkSeen(above);
  Cloud cloud;
  cloud.name = "simulated UAV cloud";
  cloud.origin = base;
  cloud.xyz = std::move(above.xyz);
  cloud.rgb = std::move(above.rgb);
  return cloud;
}

SimulatedStrip assembleStrip(const SimulationOptions& options, const Eigen::Vector3d& base,
                             const StripPlace& strip, FieldPoints below, const MosaicPieces& pieces,
                             std::uint64_t seed) {
  checkSeen(below);
  if (options.mirrored) {
    for (Eigen::Vector3f& point : below.xyz) point.y() = -point.y();
  }
  SimulatedStrip pair;
  pair.overlaps = !options.other_field && !options.beyond_map && !options.mirrored;

  const std::size_t count = below.xyz.size();
  const double mean_z = parallelSum(count, 1U << 15, 0.0,
                                    [&](std::size_t begin, std::size_t end) {
                                      double sum = 0.0;
                                      for (std::size_t i = begin; i < end; ++i) {
                                        sum += static_cast<double>(below.xyz[i].z());
                                      }
                                      return sum;
                                    }) /
                        static_cast<double>(count);
  pair.strip_centre = base + Eigen::Vector3d(strip.centre.x(), strip.centre.y(), mean_z);
  pair.strip_heading = strip.heading;
  const double across_rows =
      strip.heading - stripHeading(options.ugv, 0.0) + 0.5 * std::numbers::pi;
  const Geotag tag = drawGeotag(options.geotag, pair.strip_centre, across_rows, seed);
  pair.nominal = tag.nominal;
  pair.prior = tag.prior;

  const Way way(options.ugv, hashBits(seed, 1));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(strip.heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d begin = base + Eigen::Vector3d(strip.centre.x(), strip.centre.y(), 0.0) -
                                turn * Eigen::Vector3d(0.5 * options.ugv.length, 0.0, 0.0);
  const Eigen::Affine3d file_from_uav = tag.nominal.inverse(Eigen::Affine);
  pair.ugv.name = "simulated UGV cloud";
  pair.ugv.origin = (file_from_uav * pair.strip_centre).array().round().matrix();
  pair.ugv.rgb = std::move(below.rgb);
  pair.ugv.xyz.resize(count);
  pair.truth.resize(count);
  parallelFor(
      count,
      [&](std::size_t i) {
        const Eigen::Vector3d local = below.xyz[i].cast<double>();
        const Eigen::Vector3d place = begin + turn * local;
        pair.truth[i] = place;
        pair.truth[i].head<2>() += pieces.displacement((place - base).head<2>());
        const Eigen::Vector3d drifted = place + turn * way.drift(local, i >= below.there);
        pair.ugv.xyz[i] = (file_from_uav * drifted - pair.ugv.origin).cast<float>();
      },
      1U << 14);
  for (const auto& [local, back] : way.middle()) {
    const Eigen::Vector3d at = begin + turn * (local + way.drift(local, back));
    pair.path.emplace_back(file_from_uav * Eigen::Vector3d(at.x(), at.y(), mean_z + base.z()));
  }
  pair.best_affine = fitAffine(pair.ugv, pair.truth);
  return pair;
}

}  // namespace agricolmap::simulate
