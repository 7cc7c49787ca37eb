#include "agricolmap/simulate/ortho/ortho.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/assemble.hpp"
#include "agricolmap/simulate/field/light.hpp"
#include "agricolmap/simulate/ortho/ortho_scene.hpp"

namespace agricolmap::simulate {

namespace {

std::uint64_t seedOf(const SimulationOptions& options, std::uint64_t purpose) {
  return hashBits(hashBits(0x0E70, static_cast<std::uint64_t>(options.seed)), purpose);
}

/// A place whose strip is all valid but for 2 %.
StripPlace placeOnMosaic(const OrthoField& field, const OrthoScene& scene,
                         const SimulationOptions& options, std::uint64_t seed) {
  const Eigen::Vector2d size(scene.width(), scene.height());
  const double heading = stripHeading(options.ugv, field.row_heading);
  if (stripRoom(options.ugv, size, heading).minCoeff() < 0.0) {
    throw InputError(
        fmt::format(
            "{}: {:.1f} x {:.1f} m of it are too small for a strip of {} x {} m at {:.0f} degrees; "
            "shorten ugv.length and ugv.width, change ugv.heading_deg, or take more of the mosaic: "
            "field.width and field.height, or a window of it",
            field.name, size.x(), size.y(), options.ugv.length, options.ugv.width,
            degrees(heading)),
        Remedy::kWindow);
  }
  for (std::uint64_t attempt = 0; attempt < 500; ++attempt) {
    const StripPlace strip =
        placeStrip(options.ugv, size, field.row_heading, hashBits(seed, attempt));
    if (options.ugv.overhang > 0.0) return strip;
    int good = 0;
    int count = 0;
    const Eigen::Rotation2Dd turn(strip.heading);
    for (double x = -0.5; x <= 0.501; x += 0.02) {
      for (double y = -0.5; y <= 0.501; y += 0.1) {
        const Eigen::Vector2d local(x * options.ugv.length, y * options.ugv.width);
        good += scene.valid(strip.centre + turn * local, options.other_field) ? 1 : 0;
        ++count;
      }
    }
    if (good >= 0.98 * count) return strip;
  }
  throw InputError(fmt::format(
      "{}: no place for a strip of {} x {} m among the valid pixels; shorten ugv.length or change "
      "ugv.heading_deg",
      field.name, options.ugv.length, options.ugv.width));
}

}  // namespace

SimulatedOrtho::SimulatedOrtho(OrthoField field, const SimulationOptions& options)
    : field_(std::move(field)), options_(options) {
  checkOptions(options);
  scene_ = std::make_unique<OrthoScene>(field_, options, seedOf(options, 11));
  // The flight's wind is in the mosaic already.
  Visit still = flightOf(options.views, seedOf(options, 2));
  still.wind = 0.0;
  still.lean.setZero();
  const double cell = std::max(uavCell(options), std::min(field_.gsd, options.uav.gsd));
  Canvas canvas = scene_->draw(makeWindow({0.0, 0.0}, 0.0, scene_->width(), scene_->height(), cell),
                               still, 0.0, false);
  lightCanvas(canvas, sunDirection(still.solar_hour), 1.0);
  Eigen::Vector3d base = madeUpBase(options.geotag);
  if (options.geotag.utm && field_.corner) {
    base << *field_.corner, scene_->zero();
  }
  uav_ = cloudFromAbove(senseFromAbove(canvas, options.uav, seedOf(options, 5)), base);
}

SimulatedOrtho::~SimulatedOrtho() = default;

SimulatedStrip SimulatedOrtho::strip(const SimulationOptions& options, int index) const {
  checkOptions(options);
  if (!sameField(options, options_)) {
    throw UsageError("a strip needs the settings of the field that it is taken from");
  }
  if (options.beyond_map) {
    throw UsageError("beyond_map needs a simulated field: a mosaic ends where its map does");
  }
  if (options.ugv.back) {
    throw UsageError("ugv.back needs a simulated field: of a mosaic one pass is taken");
  }
  const auto seed = [&](std::uint64_t purpose) {
    return stripSeed(seedOf(options, purpose), index);
  };
  Visit drive = driveOf(options.views, seed(3));
  // The flight's wind is in the mosaic already: the drive takes the whole difference.
  drive.wind = options.views.wind / std::sqrt(2.0);
  const bool mirror = options.other_field;
  const StripPlace place = placeOnMosaic(field_, *scene_, options, seed(4));
  Canvas canvas =
      scene_->draw(stripWindow(place, options.ugv), drive, options.views.leaf_unshared, mirror);
  // The mosaic's own light stays; light from another side is added as the sun moves away.
  const double moved = std::min(1.0, std::abs(options.views.sun_hours) / 3.0);
  lightCanvas(canvas, sunDirection(drive.solar_hour),
              1.0 - 0.5 * moved * (1.0 - options.views.overcast));
  const MosaicPieces pieces(options.uav.mosaic, {scene_->width(), scene_->height()},
                            seedOf(options, 5));
  SimulatedStrip strip = assembleStrip(
      options, uav_.origin, place, senseFromGround(canvas, options.ugv, seed(7)), pieces, seed(8));
  strip.row_heading = field_.row_heading;
  return strip;
}

SimulatedPair simulateFromOrtho(const OrthoField& field, const SimulationOptions& options) {
  SimulatedOrtho flown(field, options);
  return SimulatedPair{flown.strip(options), std::move(flown).takeUav()};
}

}  // namespace agricolmap::simulate
