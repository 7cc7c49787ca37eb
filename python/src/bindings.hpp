// What the translation units of the extension modules share. The modules hand plain values to the
// package in Python around them, which checks arguments, documents, and is what users see.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <agricolmap/cloud.hpp>
#include <agricolmap/maps.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace agricolmap::python {

namespace py = pybind11;

/// N×3, one row after the other: the package sees to that.
using Points = py::array_t<double, py::array::c_style>;
using Colours = py::array_t<std::uint8_t, py::array::c_style>;
using Matrix = py::array_t<double, py::array::c_style>;  ///< 4×4

/// The rows as they lie in the array, for as long as it lives.
std::span<const Eigen::Vector3d> rowsOf(const Points& points);
std::span<const Rgb> rowsOf(const Colours& colours);

Transform transformOf(const Matrix& matrix);
Matrix arrayOf(const Transform& transform);
py::array_t<double> arrayOf(const Eigen::Vector3d& point);

/// A copy of the values, as an array of that shape.
template <typename Value>
py::array_t<Value> arrayOf(const std::vector<Value>& values, std::vector<py::ssize_t> shape) {
  return py::array_t<Value>(std::move(shape), values.data());
}
/// rows × columns × 3.
Colours arrayOf(const std::vector<Rgb>& colours, py::ssize_t rows, py::ssize_t cols);

/// All that a map has, by name.
py::dict mapValuesOf(const CellMap& map);

void bindChange(py::module_& module);
void bindClouds(py::module_& module);
void bindField(py::module_& module);
void bindMaps(py::module_& module);
void bindOptions(py::module_& module);
void bindRegistration(py::module_& module);
void bindStages(py::module_& module);
/// The library's errors become those of the package.
void translateErrors();

}  // namespace agricolmap::python
