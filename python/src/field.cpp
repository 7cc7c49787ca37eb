// Maps of a field, and what stands on it.
#include <agricolmap/field.hpp>
#include <algorithm>
#include <memory>

#include "bindings.hpp"
#include "field_values.hpp"
#include "waiting.hpp"

namespace agricolmap::python {
namespace {

using Stand = CropFacts::Stand;

py::dict valuesOf(const Stand& stand) {
  py::dict values;
  values["area_m2"] = stand.area_m2;
  values["cover"] = stand.cover;
  values["weeds"] = stand.weeds;
  values["patches"] = stand.patches;
  values["row_length_m"] = stand.row_length_m;
  values["plants"] = stand.plants;
  values["plants_low"] = stand.plants_low;
  values["plants_high"] = stand.plants_high;
  values["counted"] = stand.counted;
  values["uncounted_m"] = stand.uncounted_m;
  values["gaps"] = stand.gaps;
  values["gap_length_m"] = stand.gap_length_m;
  values["height_low_m"] = stand.height_low_m;
  values["height_middle_m"] = stand.height_middle_m;
  values["height_high_m"] = stand.height_high_m;
  return values;
}

/// A column for each of the fields, so that thousands of plants are a few arrays.
template <typename Item, typename Field>
auto column(const std::vector<Item>& items, const Field& field) {
  using Value = std::decay_t<decltype(field(items.front()))>;
  py::array_t<Value> values(static_cast<py::ssize_t>(items.size()));
  std::transform(items.begin(), items.end(), values.mutable_data(), field);
  return values;
}

template <typename Item>
py::array_t<double> places(const std::vector<Item>& items,
                           Eigen::Vector2d Item::*place = &Item::place_m) {
  py::array_t<double> xy(std::vector<py::ssize_t>{static_cast<py::ssize_t>(items.size()), 2});
  double* out = xy.mutable_data();
  for (const Item& item : items) {
    *out++ = (item.*place).x();
    *out++ = (item.*place).y();
  }
  return xy;
}

py::array_t<double> arrayOf(const std::vector<Eigen::Vector2d>& line) {
  py::array_t<double> xy(std::vector<py::ssize_t>{static_cast<py::ssize_t>(line.size()), 2});
  double* out = xy.mutable_data();
  for (const Eigen::Vector2d& point : line) {
    *out++ = point.x();
    *out++ = point.y();
  }
  return xy;
}

std::int64_t number(std::size_t value) { return static_cast<std::int64_t>(value); }

py::dict plantsOf(const CropFacts& facts) {
  using Plant = CropFacts::Plant;
  py::dict plants;
  plants["place_m"] = places(facts.plants);
  plants["row"] = column(facts.plants, [](const Plant& plant) { return number(plant.row); });
  plants["along_m"] = column(facts.plants, [](const Plant& plant) { return plant.along_m; });
  plants["area_m2"] = column(facts.plants, [](const Plant& plant) { return plant.area_m2; });
  plants["height_m"] = column(facts.plants, [](const Plant& plant) { return plant.height_m; });
  plants["certainty"] = column(facts.plants, [](const Plant& plant) { return plant.certainty; });
  return plants;
}

py::dict gapsOf(const CropFacts& facts) {
  using Gap = CropFacts::Gap;
  py::dict gaps;
  gaps["place_m"] = places(facts.gaps);
  gaps["row"] = column(facts.gaps, [](const Gap& gap) { return number(gap.row); });
  gaps["from_m"] = column(facts.gaps, [](const Gap& gap) { return gap.from_m; });
  gaps["to_m"] = column(facts.gaps, [](const Gap& gap) { return gap.to_m; });
  return gaps;
}

py::dict valuesOf(const CropFacts& facts) {
  py::list rows;
  for (const CropFacts::Row& row : facts.rows) {
    rows.append(py::make_tuple(arrayOf(row.line), valuesOf(row.stand)));
  }
  py::list squares;
  for (const CropFacts::Square& square : facts.squares) {
    squares.append(py::make_tuple(py::make_tuple(square.corner_m.x(), square.corner_m.y()),
                                  square.side_m, valuesOf(square.stand)));
  }
  py::list plots;
  for (const Stand& plot : facts.plots) plots.append(valuesOf(plot));
  py::dict weeds;
  weeds["place_m"] = places(facts.weeds);
  weeds["area_m2"] = column(facts.weeds, [](const CropFacts::Weed& weed) { return weed.area_m2; });
  py::dict values;
  values["countable"] = facts.countable;
  values["row_spacing_m"] = facts.row_spacing_m;
  values["row_heading_deg"] = facts.row_heading_deg;
  values["plant_spacing_m"] = facts.plant_spacing_m;
  values["total"] = valuesOf(facts.total);
  values["rows"] = rows;
  values["plants"] = plantsOf(facts);
  values["gaps"] = gapsOf(facts);
  values["weeds"] = weeds;
  values["squares"] = squares;
  values["plots"] = plots;
  return values;
}

py::object valuesOf(const FieldMap::Fine& fine) {
  if (fine.rows == 0) return py::none();
  const std::vector<py::ssize_t> shape{fine.rows, fine.cols};
  py::dict values;
  values["plant_height_m"] = python::arrayOf(fine.plant_height_m, shape);
  values["excess_green"] = python::arrayOf(fine.excess_green, shape);
  values["cover"] = python::arrayOf(fine.cover, shape);
  values["density"] = python::arrayOf(fine.density, shape);
  values["cell_m"] = fine.cell_m;
  values["file_from_cell"] = python::arrayOf(fine.file_from_cell);
  return values;
}

py::dict valuesOf(const FieldMap& map) {
  const std::vector<py::ssize_t> shape{map.rows, map.cols};
  py::dict values;
  values["cell_m"] = map.cell_m;
  values["file_from_cell"] = python::arrayOf(map.file_from_cell);
  values["surface_m"] = python::arrayOf(map.surface_m, shape);
  values["ground_m"] = python::arrayOf(map.ground_m, shape);
  values["plant_height_m"] = python::arrayOf(map.plant_height_m, shape);
  values["excess_green"] = python::arrayOf(map.excess_green, shape);
  values["cover"] = python::arrayOf(map.cover, shape);
  values["density"] = python::arrayOf(map.density, shape);
  values["plane_error_m"] = python::arrayOf(map.plane_error_m, shape);
  values["height_error_m"] = python::arrayOf(map.height_error_m, shape);
  values["colour"] = python::arrayOf(map.colour, map.rows, map.cols);
  values["source"] = python::arrayOf(map.source, shape);
  values["date"] = python::arrayOf(map.date, shape);
  values["has_heights"] = map.has_heights;
  py::list strips;
  for (const FieldMap::Strip& strip : map.strips) {
    strips.append(py::make_tuple(strip.name, strip.source, python::arrayOf(strip.moved_m),
                                 strip.seen_m2, strip.owned_m2, valuesOf(strip.fine)));
  }
  values["strips"] = strips;
  values["warnings"] = map.warnings;
  return values;
}

/// Name, cloud in the fixed one's coordinates, errors in the plane and in height, whether heights
/// are limited, date.
using Strip = std::tuple<std::string, std::shared_ptr<Cloud>, double, double, bool, int>;

std::shared_ptr<FieldMap> fuse(const std::shared_ptr<Cloud>& fixed, const std::vector<Strip>& given,
                               const Settings& settings, int date, const py::object& progress,
                               const py::object& stop, int threads) {
  std::vector<LaidStrip> strips;
  for (const auto& [name, cloud, plane, height, limited, day] : given) {
    strips.push_back({name, cloud, plane, height, limited, day});
  }
  return std::make_shared<FieldMap>(waitFor({progress, stop}, threads, [&](const Control& control) {
    return fuseClouds(*fixed, strips, settings, control, date);
  }));
}

template <typename Source>
py::dict facts(const std::shared_ptr<Source>& source, const Settings& settings,
               const NamedPlots& named, const py::object& stop, int threads) {
  const std::vector<Plot> plots = plotsOf(named);
  return valuesOf(waitFor({py::none(), stop}, threads, [&](const Control& control) {
    return cropFacts(*source, settings, plots, control);
  }));
}

}  // namespace

std::vector<Plot> plotsOf(const NamedPlots& named) {
  std::vector<Plot> plots;
  for (const auto& [name, corners] : named) {
    Plot& plot = plots.emplace_back(Plot{name, {}});
    for (py::ssize_t i = 0; i < corners.shape(0); ++i) {
      plot.corners.emplace_back(corners.at(i, 0), corners.at(i, 1));
    }
  }
  return plots;
}

void bindField(py::module_& module) {
  py::class_<FieldMap, std::shared_ptr<FieldMap>>(module, "FieldMap")
      .def("values", [](const FieldMap& map) { return valuesOf(map); })
      .def_readonly("crs", &FieldMap::crs);
  module.def("fuse_options", &fuseOptions);
  module.def("facts_options", &factsOptions);
  module.def("laid_strip", [](const Cloud& moving, const Registration& registration) {
    const LaidStrip strip = [&] {
      const py::gil_scoped_release release;
      return laidStrip({}, moving, registration);
    }();
    return py::make_tuple(std::const_pointer_cast<Cloud>(strip.cloud), strip.plane_error_m,
                          strip.height_error_m, strip.heights_limited);
  });
  module.def("fuse", &fuse);
  module.def("facts", &facts<Cloud>);
  module.def("facts", &facts<FieldMap>);
}

}  // namespace agricolmap::python
