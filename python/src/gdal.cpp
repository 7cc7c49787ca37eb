// The extension module of the component gdal: loaded where files are read, since GDAL brings a
// hundred libraries.
#include <pybind11/stl.h>

#include <agricolmap/field.hpp>
#include <agricolmap/io.hpp>
#include <memory>

#include "bindings.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_gdal, module) {
  module.doc() = "Files with coordinate systems; a part of the package agricolmap.";
  py::module_::import("agricolmap._core");
  module.def("read_pair", [](const std::string& fixed, const std::string& fixed_crs,
                             const std::string& moving, const std::string& moving_crs) {
    agricolmap::CloudPair pair = [&] {
      const py::gil_scoped_release release;
      return agricolmap::readPair({fixed, fixed_crs}, {moving, moving_crs});
    }();
    return py::make_tuple(std::make_shared<agricolmap::Cloud>(std::move(pair.fixed)),
                          std::make_shared<agricolmap::Cloud>(std::move(pair.moving)));
  });
  module.def("read_beside", [](const agricolmap::Crs& frame, const std::string& path) {
    const py::gil_scoped_release release;
    return std::make_shared<agricolmap::Cloud>(agricolmap::readBeside(frame, {path}));
  });
  module.def("read_field_map", [](const std::string& path) {
    const py::gil_scoped_release release;
    return std::make_shared<agricolmap::FieldMap>(agricolmap::readFieldMap(path));
  });
  module.def("same_crs", &agricolmap::sameCrs);
  module.def("read_map",
             [](const std::string& path, const std::string& crs, const std::string& target) {
               const py::gil_scoped_release release;
               return std::make_shared<agricolmap::Cloud>(agricolmap::readMap({path, crs}, target));
             });
}
