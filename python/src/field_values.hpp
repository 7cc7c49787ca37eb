// Plots as the package in Python hands them over.
#pragma once

#include <pybind11/stl.h>

#include <agricolmap/field.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"

namespace agricolmap::python {

/// Names and corners, N×2, one row after the other.
using NamedPlots = std::vector<std::pair<std::string, py::array_t<double, py::array::c_style>>>;

std::vector<Plot> plotsOf(const NamedPlots& named);

}  // namespace agricolmap::python
