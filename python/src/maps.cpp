// Maps of cells as arrays.
#include <agricolmap/maps.hpp>

#include "bindings.hpp"
#include "waiting.hpp"

namespace agricolmap::python {

py::dict mapValuesOf(const CellMap& map) {
  const std::vector<py::ssize_t> shape{map.rows, map.cols};
  py::dict values;
  values["cell_m"] = map.cell_m;
  values["file_from_cell"] = arrayOf(map.file_from_cell);
  values["height_m"] = arrayOf(map.height_m, shape);
  values["excess_green"] = arrayOf(map.excess_green, shape);
  values["weight"] = arrayOf(map.weight, shape);
  values["colour"] = arrayOf(map.colour, map.rows, map.cols);
  return values;
}

void bindMaps(py::module_& module) {
  module.def("compared_maps", [](const Registration& registration) {
    const ComparedMaps maps = [&] {
      const py::gil_scoped_release release;
      return comparedMaps(registration);
    }();
    return py::make_tuple(mapValuesOf(maps.fixed), mapValuesOf(maps.moving));
  });
  module.def("map_cloud", [](const std::shared_ptr<Cloud>& cloud, const Options& options,
                             const py::object& stop, int threads) {
    return mapValuesOf(
        waitFor({py::none(), stop}, threads, [&, chosen = options](const Control& control) {
          return mapCloud(*cloud, chosen, control);
        }));
  });
}

}  // namespace agricolmap::python
