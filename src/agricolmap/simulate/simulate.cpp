#include "agricolmap/simulate/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string_view>
#include <type_traits>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/assemble.hpp"
#include "agricolmap/simulate/field/render.hpp"

namespace agricolmap::simulate {

namespace {

std::uint64_t seedOf(const SimulationOptions& options, std::uint64_t purpose) {
  const auto crop = static_cast<std::uint64_t>(options.crop);
  return hashBits(hashBits(0xA6C0 + crop, static_cast<std::uint64_t>(options.seed)), purpose);
}

/// What the strip shows lies so far from the map that no part of it is on the map [m].
Eigen::Vector2d wayBeyond(const SimulationOptions& options, std::uint64_t seed) {
  Random random(seed);
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double nearest = std::hypot(options.field.width, options.field.height) +
                         std::hypot(options.ugv.length, options.ugv.width);
  return (nearest + random.uniform(0.0, 50.0)) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

bool sameValue(const OptionField& a, const OptionField& b) {
  return std::visit(
      [&](const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        const Value& other = std::get<Value>(b.value);
        if constexpr (std::is_same_v<Value, ChoiceRef>) {
          return value.get() == other.get();
        } else {
          return *value == *other;
        }
      },
      a.value);
}

/// Compares the options whose path begins with one of `beginnings`.
bool sameOptions(SimulationOptions a, SimulationOptions b,
                 std::initializer_list<std::string_view> beginnings) {
  const OptionTable first = optionTable(a);
  const OptionTable second = optionTable(b);
  for (std::size_t i = 0; i < first.fields().size(); ++i) {
    const OptionField& field = first.fields()[i];
    const bool asked =
        std::any_of(beginnings.begin(), beginnings.end(),
                    [&](std::string_view begin) { return field.path.starts_with(begin); });
    if (asked && !sameValue(field, second.fields()[i])) return false;
  }
  return true;
}

}  // namespace

bool sameField(const SimulationOptions& a, const SimulationOptions& b) {
  return sameOptions(a, b, {"crop", "field.", "uav.", "geotag.utm", "seed"});
}

SimulatedField::SimulatedField(const SimulationOptions& options)
    : options_(options), field_(options.crop, options.field, seedOf(options, 1)) {
  checkOptions(options);
  const Visit flight = flightOf(options.views, seedOf(options, 2));
  const Canvas canvas = renderVisit(
      field_, flight,
      makeWindow({0.0, 0.0}, 0.0, options.field.width, options.field.height, uavCell(options)));
  uav_ = cloudFromAbove(senseFromAbove(canvas, options.uav, seedOf(options, 5)),
                        madeUpBase(options.geotag));
}

std::vector<TruePlant> SimulatedField::plants() const {
  const Visit flight = flightOf(options_.views, seedOf(options_, 2));
  const Eigen::Vector2d size(options_.field.width, options_.field.height);
  const Window window = makeWindow({0.0, 0.0}, 0.0, size.x(), size.y(), uavCell(options_));
  const MosaicPieces pieces(options_.uav.mosaic, size, seedOf(options_, 5));
  std::vector<TruePlant> plants = truePlants(field_, flight, window);
  for (TruePlant& plant : plants) {
    plant.stem.head<2>() += pieces.displacement(plant.stem.head<2>());
    plant.stem += uav_.origin;
  }
  return plants;
}

SimulatedStrip SimulatedField::strip(const SimulationOptions& options, int index) const {
  checkOptions(options);
  if (!sameField(options, options_)) {
    throw UsageError("a strip needs the settings of the field that it is taken from");
  }
  const auto seed = [&](std::uint64_t purpose) {
    return stripSeed(seedOf(options, purpose), index);
  };
  const Eigen::Vector2d size(options.field.width, options.field.height);
  const StripPlace place = placeStrip(options.ugv, size, field_.rowHeading(), seed(4));
  StripPlace shown = place;
  if (options.beyond_map) shown.centre += wayBeyond(options, seed(9));
  FieldModel driven = field_;
  if (options.other_field) {
    // The same rows' direction, so that only the plants can tell the fields apart.
    FieldOptions other = options.field;
    other.random_row_heading = false;
    other.row_heading_deg = degrees(field_.rowHeading());
    driven = FieldModel(options.crop, other, seed(6));
  }
  const Visit drive = driveOf(options.views, seed(3));
  const auto seenFrom = [&](const StripPlace& from, std::uint64_t purpose) {
    return senseFromGround(renderVisit(driven, drive, stripWindow(from, options.ugv)), options.ugv,
                           seed(purpose));
  };
  FieldPoints below = seenFrom(shown, 7);
  if (options.ugv.back) {
    below = thereAndBack(std::move(below), seenFrom(wayBack(shown, options.ugv), 10), options.ugv);
  }
  if (options.beyond_map) {
    // A slope must not give away that the strip comes from afar.
    const auto lift =
        static_cast<float>(driven.soilHeight(place.centre) - driven.soilHeight(shown.centre));
    for (Eigen::Vector3f& point : below.xyz) point.z() += lift;
  }
  const MosaicPieces pieces(options.uav.mosaic, size, seedOf(options, 5));
  SimulatedStrip strip =
      assembleStrip(options, uav_.origin, place, std::move(below), pieces, seed(8));
  strip.row_heading = field_.rowHeading();
  return strip;
}

SimulatedPair simulatePair(const SimulationOptions& options) {
  SimulatedField field(options);
  SimulatedStrip strip = field.strip(options);
  return SimulatedPair{std::move(strip), std::move(field).takeUav()};
}

}  // namespace agricolmap::simulate
