#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <memory>
#include <set>
#include <utility>

#include "agricolmap/api/checks.hpp"
#include "agricolmap/api/field_rasters.hpp"
#include "agricolmap/api/settings.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/field.hpp"
#include "agricolmap/fuse/fine_layers.hpp"
#include "agricolmap/fuse/shared_map.hpp"

namespace agricolmap {
namespace {

void requireStrips(const Cloud& fixed, const std::vector<LaidStrip>& strips) {
  requireWhole(fixed);
  if (strips.empty()) throw UsageError("there is no strip to fuse; give at least one");
  std::set<std::string> names;
  for (const LaidStrip& strip : strips) {
    if (!strip.cloud) throw UsageError(fmt::format("{}: has no cloud", strip.name));
    requireWhole(*strip.cloud);
    if (!names.insert(strip.name).second) {
      throw UsageError(fmt::format("there are two strips called '{}'; rename one", strip.name));
    }
    const bool errors = strip.plane_error_m >= 0.0 && strip.height_error_m >= 0.0 &&
                        std::isfinite(strip.plane_error_m + strip.height_error_m);
    if (!errors) {
      throw UsageError(fmt::format(
          "{}: an error must be a number of metres from 0 on; it is 1 m where nobody knows",
          strip.name));
    }
  }
}

FieldMap::Fine fineOf(const fuse::SharedMap& map, std::size_t strip, const PointStream& points,
                      bool match_colours) {
  FieldMap::Fine fine;
  if (map.strips[strip].owned_area <= 0.0) return fine;
  const map::GridMap own = fuse::fineMap(map, strip, points);
  const fuse::FineLayers layers = fuse::fineLayers(map, strip, own, match_colours);
  fine.rows = own.frame.rows;
  fine.cols = own.frame.cols;
  fine.cell_m = own.frame.cell;
  fine.file_from_cell = fileFromCell(own.frame, map.layers.origin);
  fine.plant_height_m = valuesOf(layers.plant_height);
  fine.excess_green = valuesOf(layers.exg);
  fine.cover = valuesOf(layers.cover);
  fine.density = valuesOf(layers.density);
  return fine;
}

FieldMap publicMap(const fuse::SharedMap& map) {
  const fuse::Layers& layers = map.layers;
  FieldMap field;
  field.rows = layers.frame.rows;
  field.cols = layers.frame.cols;
  field.cell_m = layers.frame.cell;
  field.file_from_cell = fileFromCell(layers.frame, layers.origin);
  field.surface_m = valuesOf(layers.surface);
  field.ground_m = valuesOf(layers.ground);
  field.plant_height_m = valuesOf(layers.plant_height);
  field.excess_green = valuesOf(layers.exg);
  field.cover = valuesOf(layers.cover);
  field.density = valuesOf(layers.density);
  field.plane_error_m = valuesOf(layers.plane_error);
  field.height_error_m = valuesOf(layers.height_error);
  field.colour = valuesOf(layers.colour);
  field.source = valuesOf(layers.source);
  field.date = valuesOf(layers.date);
  field.has_heights = !map.flat;
  for (const fuse::FusedStrip& strip : map.strips) {
    field.strips.push_back(
        {strip.id, strip.code, strip.moved, strip.seen_area, strip.owned_area, {}});
  }
  field.warnings = map.warnings;
  return field;
}

/// Heights of a map that has none mean nothing.
void forgetHeights(FieldMap& field) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  const auto cells = static_cast<std::size_t>(field.rows) * static_cast<std::size_t>(field.cols);
  for (std::vector<float>* layer :
       {&field.surface_m, &field.ground_m, &field.plant_height_m, &field.height_error_m}) {
    layer->assign(cells, kNothing);
  }
}

}  // namespace

LaidStrip laidStrip(const std::string& name, const Cloud& moving, const Registration& registration,
                    int date) {
  // What nobody knows is as good as the search: a strip of which that much is said owns little.
  constexpr double kUnknown = 1.0;
  LaidStrip strip;
  strip.name = name;
  strip.cloud = std::make_shared<const Cloud>(alignedCloud(moving, registration));
  if (registration.uncertainty) {
    strip.plane_error_m = std::min(kUnknown, registration.uncertainty->expected_rms_m);
  }
  if (registration.heights) {
    strip.height_error_m = std::min(kUnknown, registration.heights->deviation_m);
    strip.heights_limited = !registration.heights->measured;
  }
  strip.date = date;
  return strip;
}

std::vector<OptionInfo> fuseOptions() {
  fuse::FuseOptions options;
  return infosOf(optionTable(options));
}

FieldMap fuseClouds(const Cloud& fixed, const std::vector<LaidStrip>& strips,
                    const Settings& options, const Control& control, int fixed_date) {
  requireProcessor();
  requireStrips(fixed, strips);
  const auto in_force = chosen<fuse::FuseOptions>(options);
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  std::list<CloudStream> streams;
  std::vector<fuse::StripInput> inputs;
  for (const LaidStrip& strip : strips) {
    inputs.push_back({strip.name,
                      &streams.emplace_back(*strip.cloud),
                      strip.date,
                      {strip.plane_error_m, strip.height_error_m},
                      strip.heights_limited});
  }
  const fuse::SharedMap map =
      fuse::shareMap(CloudStream(fixed), fixed_date, inputs, in_force, [&](std::string_view step) {
        if (control.on_stage) control.on_stage(step);
      });
  FieldMap field = publicMap(map);
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    throwIfInterrupted();
    const auto input = std::ranges::find(inputs, map.strips[i].id, &fuse::StripInput::id);
    field.strips[i].fine = fineOf(map, i, *input->points, in_force.match_colours);
  }
  if (map.flat) forgetHeights(field);
  field.crs = fixed.crs;
  field.fixed = {fixed.name, fixed.size() + fixed.dropped_points, fixed_date};
  return field;
}

}  // namespace agricolmap
