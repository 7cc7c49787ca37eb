// What changed between two maps of a field.
#include <agricolmap/change.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "bindings.hpp"
#include "field_values.hpp"
#include "waiting.hpp"

namespace agricolmap::python {
namespace {

using Error = std::optional<std::pair<double, double>>;  ///< of heights, of places [m]

std::optional<MapError> errorOf(const Error& given) {
  if (!given) return std::nullopt;
  return MapError{given->first, given->second};
}

py::dict valuesOf(const FieldChange::Share& share) {
  py::dict values;
  values["cells"] = share.cells;
  values["area_m2"] = share.area_m2;
  values["volume_m3"] = share.volume_m3;
  values["volume_low_m3"] = share.volume_low_m3;
  values["volume_high_m3"] = share.volume_high_m3;
  values["mean_m"] = share.mean_m;
  values["mean_deviation_m"] = share.mean_deviation_m;
  values["median_m"] = share.median_m;
  return values;
}

py::object valuesOf(const std::optional<FieldChange::Layer>& layer) {
  if (!layer) return py::none();
  py::dict values;
  values["cells"] = layer->cells;
  values["before"] = layer->before;
  values["after"] = layer->after;
  return values;
}

py::dict valuesOf(const FieldChange::Part& part) {
  py::dict values;
  values["compared_m2"] = part.compared_m2;
  values["compared"] = valuesOf(part.compared);
  values["rise"] = valuesOf(part.rise);
  values["fall"] = valuesOf(part.fall);
  values["level_m"] = part.level_m;
  values["more_than_errors"] = part.more_than_errors;
  values["plant_height"] = valuesOf(part.plant_height);
  values["cover"] = valuesOf(part.cover);
  return values;
}

py::object layerOf(const std::vector<float>& layer, const std::vector<py::ssize_t>& shape) {
  if (layer.empty()) return py::none();
  return arrayOf(layer, shape);
}

py::dict layersOf(const FieldChange& change) {
  const std::vector<py::ssize_t> shape{change.rows, change.cols};
  py::dict values;
  values["height_change_m"] = arrayOf(change.height_change_m, shape);
  values["detection_m"] = arrayOf(change.detection_m, shape);
  values["significant"] = arrayOf(change.significant, shape);
  values["plant_height_change_m"] = layerOf(change.plant_height_change_m, shape);
  values["cover_change"] = layerOf(change.cover_change, shape);
  return values;
}

py::dict valuesOf(const FieldChange& change) {
  py::dict values = layersOf(change);
  values["cell_m"] = change.cell_m;
  values["file_from_cell"] = arrayOf(change.file_from_cell);
  values["has_heights"] = change.has_heights;
  values["frame_error_m"] = py::make_tuple(change.frame_error.height_m, change.frame_error.plane_m);
  values["compared"] = valuesOf(change.compared);
  values["rise"] = valuesOf(change.rise);
  values["fall"] = valuesOf(change.fall);
  values["median_detection_m"] = change.median_detection_m;
  values["bare_ground"] =
      change.bare_ground ? py::object(valuesOf(*change.bare_ground)) : py::none();
  values["plant_height"] = valuesOf(change.plant_height);
  values["cover"] = valuesOf(change.cover);
  py::list plots;
  for (const FieldChange::Part& plot : change.plots) plots.append(valuesOf(plot));
  values["plots"] = plots;
  py::list squares;
  for (const FieldChange::Square& square : change.squares) {
    squares.append(py::make_tuple(py::make_tuple(square.corner_m.x(), square.corner_m.y()),
                                  square.side_m, valuesOf(square.change)));
  }
  values["squares"] = squares;
  values["warnings"] = change.warnings;
  return values;
}

py::dict diff(const std::shared_ptr<FieldMap>& map_a, const std::shared_ptr<FieldMap>& map_b,
              const std::tuple<Error, Error, Error>& errors, const NamedPlots& plots, double grid,
              bool same_crs, const py::object& stop, int threads) {
  DiffSettings settings;
  settings.error_a = errorOf(std::get<0>(errors));
  settings.error_b = errorOf(std::get<1>(errors));
  settings.frame_error = errorOf(std::get<2>(errors));
  settings.plots = plotsOf(plots);
  settings.grid_m = grid;
  settings.same_crs = same_crs;
  return valuesOf(waitFor({py::none(), stop}, threads, [&](const Control& control) {
    return diffMaps(*map_a, *map_b, settings, control);
  }));
}

}  // namespace

void bindChange(py::module_& module) { module.def("diff", &diff); }

}  // namespace agricolmap::python
