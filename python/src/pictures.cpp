// The extension module of the component pictures.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <agricolmap/report.hpp>
#include <memory>

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
  module.def(
      "write_page",
      [](const std::filesystem::path& folder, const agricolmap::Registration& registration,
         const std::vector<std::string>& pictures, const std::shared_ptr<agricolmap::Cloud>& fixed,
         const std::shared_ptr<agricolmap::Cloud>& moving) {
        const py::gil_scoped_release release;
        if (fixed && moving) {
          agricolmap::writePage(folder, registration, pictures, *fixed, *moving);
        } else {
          agricolmap::writePage(folder, registration, pictures);
        }
      });
}
