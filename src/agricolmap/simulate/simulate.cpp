#include "agricolmap/simulate/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/assemble.hpp"
#include "agricolmap/simulate/render.hpp"

namespace agricolmap {

namespace {

std::uint64_t seedOf(const SimulationOptions& options, std::uint64_t purpose) {
  const auto crop = static_cast<std::uint64_t>(options.crop);
  return hashBits(hashBits(0xA6C0 + crop, static_cast<std::uint64_t>(options.seed)), purpose);
}

}  // namespace

SimulatedPair simulatePair(const SimulationOptions& options) {
  checkOptions(options);
  const FieldModel field(options.crop, options.field, seedOf(options, 1));
  const Visit flight = flightOf(options.views, seedOf(options, 2));
  const Visit drive = driveOf(options.views, seedOf(options, 3));
  const Eigen::Vector2d size(options.field.width, options.field.height);
  const StripPlace strip = placeStrip(options.ugv, size, field.rowHeading(), seedOf(options, 4));

  FieldPoints above;
  {
    const Canvas canvas = renderVisit(
        field, flight, makeWindow({0.0, 0.0}, 0.0, size.x(), size.y(), uavCell(options)));
    above = senseFromAbove(canvas, options.uav, seedOf(options, 5));
  }
  const Window window = stripWindow(strip, options.ugv);
  FieldModel driven = field;
  if (options.other_field) {
    // The same rows' direction, so that only the plants can tell the fields apart.
    FieldOptions other = options.field;
    other.random_row_heading = false;
    other.row_heading_deg = field.rowHeading() * 180.0 / std::numbers::pi;
    driven = FieldModel(options.crop, other, seedOf(options, 6));
  }
  FieldPoints below =
      senseFromGround(renderVisit(driven, drive, window), options.ugv, seedOf(options, 7));
  SimulatedPair pair = assemblePair(options, madeUpBase(options.geotag), strip, std::move(above),
                                    std::move(below), seedOf(options, 8));
  pair.row_heading = field.rowHeading();
  pair.overlaps = !options.other_field;
  return pair;
}

}  // namespace agricolmap
