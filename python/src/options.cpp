// Options by name; their types, limits and defaults are the library's own.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <agricolmap/options.hpp>

#include "bindings.hpp"

namespace agricolmap::python {
namespace {

const char* nameOf(OptionInfo::Kind kind) {
  switch (kind) {
    case OptionInfo::Kind::kInteger:
      return "int";
    case OptionInfo::Kind::kFlag:
      return "bool";
    case OptionInfo::Kind::kChoice:
      return "str";
    case OptionInfo::Kind::kNumber:
      break;
  }
  return "float";
}

}  // namespace

void bindOptions(py::module_& module) {
  py::class_<OptionInfo>(module, "OptionInfo")
      .def_readonly("name", &OptionInfo::name)
      .def_readonly("unit", &OptionInfo::unit)
      .def_readonly("limits", &OptionInfo::limits)
      .def_readonly("default", &OptionInfo::default_value)
      .def_readonly("help", &OptionInfo::help)
      .def_readonly("basic", &OptionInfo::basic)
      .def_readonly("low", &OptionInfo::low)
      .def_readonly("high", &OptionInfo::high)
      .def_readonly("choices", &OptionInfo::choices)
      .def_property_readonly("kind", [](const OptionInfo& info) { return nameOf(info.kind); });
  py::class_<Options>(module, "Options")
      .def(py::init<std::string_view>())
      .def(py::init<const Options&>())
      .def_static("presets", &Options::presets)
      .def_property_readonly("preset", &Options::preset)
      .def("set", py::overload_cast<std::string_view, std::string_view>(&Options::set))
      .def("get", &Options::get)
      .def("list", &Options::list)
      .def("prior",
           [](const Options& options) {
             const Prior prior = options.prior();
             return py::make_tuple(prior.translation_m, prior.heading_deg, prior.scale,
                                   prior.anywhere, prior.scale_unknown);
           })
      .def("set_prior",
           [](Options& options, double translation_m, double heading_deg, double scale,
              bool anywhere, bool scale_unknown) {
             options.setPrior({translation_m, heading_deg, scale, anywhere, scale_unknown});
           })
      .def("load", &Options::load)
      .def("save", &Options::save);
}

}  // namespace agricolmap::python
