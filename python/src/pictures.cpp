// The extension module of the component pictures.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <agricolmap/report.hpp>

#include "bindings.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_pictures, module) {
  module.doc() = "Pictures of a registration; a part of the package agricolmap.";
  py::module_::import("agricolmap._core");
  module.def("write_pictures",
             [](const std::filesystem::path& folder, const agricolmap::Registration& registration) {
               const py::gil_scoped_release release;
               return agricolmap::writePictures(folder, registration);
             });
}
