// The extension module of the core library, its errors and what its units share.
#include <agricolmap/error.hpp>
#include <agricolmap/version.hpp>
#include <algorithm>
#include <exception>
#include <utility>

#include "bindings.hpp"

namespace agricolmap::python {
namespace {

const char* nameOf(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return "UsageError";
    case ErrorKind::kInput:
      return "InputError";
    case ErrorKind::kOutput:
      return "OutputError";
    case ErrorKind::kInterrupted:
      return "Interrupted";
    case ErrorKind::kInternal:
      break;
  }
  return "Error";
}

const char* nameOf(Remedy remedy) {
  switch (remedy) {
    case Remedy::kHeightsAlone:
      return "heights_alone";
    case Remedy::kInitialGuess:
      return "initial_guess";
    case Remedy::kNarrowerGuess:
      return "narrower_guess";
    case Remedy::kOverwrite:
      return "overwrite";
    case Remedy::kPixelSize:
      return "pixel_size";
    case Remedy::kSurfaceModel:
      return "surface_model";
    case Remedy::kRowHeading:
      return "row_heading";
    case Remedy::kWindow:
      return "window";
    case Remedy::kResumeOrOverwrite:
      return "resume_or_overwrite";
    case Remedy::kNone:
      break;
  }
  return "";
}

}  // namespace

std::span<const Eigen::Vector3d> rowsOf(const Points& points) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return {reinterpret_cast<const Eigen::Vector3d*>(points.data()),
          static_cast<std::size_t>(points.shape(0))};
}

std::span<const Rgb> rowsOf(const Colours& colours) {
  static_assert(sizeof(Rgb) == 3);
  return {reinterpret_cast<const Rgb*>(colours.data()), static_cast<std::size_t>(colours.shape(0))};
}

Transform transformOf(const Matrix& matrix) {
  Transform transform;
  for (py::ssize_t row = 0; row < 4; ++row) {
    for (py::ssize_t col = 0; col < 4; ++col) transform(row, col) = matrix.at(row, col);
  }
  return transform;
}

Matrix arrayOf(const Transform& transform) {
  Matrix matrix(std::vector<py::ssize_t>{4, 4});
  for (py::ssize_t row = 0; row < 4; ++row) {
    for (py::ssize_t col = 0; col < 4; ++col) matrix.mutable_at(row, col) = transform(row, col);
  }
  return matrix;
}

py::array_t<double> arrayOf(const Eigen::Vector3d& point) {
  return py::array_t<double>(3, point.data());
}

Colours arrayOf(const std::vector<Rgb>& colours, py::ssize_t rows, py::ssize_t cols) {
  Colours array(std::vector<py::ssize_t>{rows, cols, 3});
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(colours.data());
  std::copy(bytes, bytes + 3 * colours.size(), array.mutable_data());
  return array;
}

void translateErrors() {
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(std::move(pointer));
    } catch (const Error& error) {
      const py::object type = py::module_::import("agricolmap._errors").attr(nameOf(error.kind()));
      const py::object raised = type(error.what(), nameOf(error.remedy()));
      PyErr_SetObject(type.ptr(), raised.ptr());
    }
  });
}

}  // namespace agricolmap::python

PYBIND11_MODULE(_core, module) {
  namespace python = agricolmap::python;
  module.doc() = "What the package agricolmap is made of; import that.";
  python::translateErrors();
  module.def("version", &agricolmap::version);
  python::bindClouds(module);
  python::bindOptions(module);
  python::bindRegistration(module);
  python::bindMaps(module);
  python::bindStages(module);
  python::bindField(module);
  python::bindChange(module);
}
