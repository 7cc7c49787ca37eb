// Clouds, and what goes from and to files.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <agricolmap/io.hpp>
#include <memory>
#include <optional>

#include "bindings.hpp"

namespace agricolmap::python {
namespace {

using Holder = std::shared_ptr<Cloud>;
using Path = std::filesystem::path;

/// Rows of the cloud's own memory, which lives as long as the array does and cannot be written to.
template <typename Value>
py::array_t<Value> view(const Value* data, std::size_t rows, const Holder& cloud) {
  py::array_t<Value> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows), 3}, data,
                           py::cast(cloud));
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

Holder make(const Points& xyz, const std::optional<Colours>& colours, const std::string& name,
            const Crs& crs, const std::vector<std::string>& warnings) {
  const std::span<const Eigen::Vector3d> points = rowsOf(xyz);
  const std::span<const Rgb> rgb = colours ? rowsOf(*colours) : std::span<const Rgb>();
  const py::gil_scoped_release release;
  auto cloud = std::make_shared<Cloud>(makeCloud(points, rgb, name));
  cloud->crs = crs;
  cloud->warnings.insert(cloud->warnings.end(), warnings.begin(), warnings.end());
  return cloud;
}

Points filePoints(const Cloud& cloud) {
  Points points(std::vector<py::ssize_t>{static_cast<py::ssize_t>(cloud.size()), 3});
  double* out = points.mutable_data();
  const py::gil_scoped_release release;
  for (std::size_t i = 0; i < cloud.size(); ++i, out += 3) {
    Eigen::Map<Eigen::Vector3d>(out, 3) = cloud.filePoint(i);
  }
  return points;
}

py::object localPoints(const Holder& cloud) {
  return view(reinterpret_cast<const float*>(cloud->xyz.data()), cloud->size(), cloud);
}

py::object colours(const Holder& cloud) {
  if (!cloud->hasColour()) return py::none();
  return view(reinterpret_cast<const std::uint8_t*>(cloud->rgb.data()), cloud->size(), cloud);
}

Points arrayOfRows(const std::vector<Eigen::Vector3d>& rows) {
  Points points(std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows.size()), 3});
  double* out = points.mutable_data();
  for (const Eigen::Vector3d& row : rows) {
    for (int axis = 0; axis < 3; ++axis) *out++ = row[axis];
  }
  return points;
}

void bindFiles(py::module_& module) {
  module.def("read_cloud", [](const Path& path) {
    const py::gil_scoped_release release;
    return std::make_shared<Cloud>(readCloud(path));
  });
  module.def("write_cloud", [](const Path& path, const Cloud& cloud, const Matrix& matrix) {
    const Transform target_from_file = transformOf(matrix);
    const py::gil_scoped_release release;
    writeCloud(path, cloud, target_from_file);
  });
  module.def("read_matrix", [](const Path& path) { return arrayOf(readMatrix(path)); });
  module.def("write_matrix", [](const Path& path, const Matrix& matrix) {
    writeMatrix(path, transformOf(matrix));
  });
  module.def("read_path", [](const Path& path) { return arrayOfRows(readPath(path)); });
  module.def("read_offset_beside", [](const Path& path) -> std::optional<Matrix> {
    const std::optional<Transform> offset = readOffsetBeside(path);
    if (!offset) return std::nullopt;
    return arrayOf(*offset);
  });
}

}  // namespace

void bindClouds(py::module_& module) {
  py::class_<Crs>(module, "Crs")
      .def(py::init([](const std::string& name, const std::string& wkt) {
        return Crs{.name = name, .wkt = wkt};
      }))
      .def_readonly("name", &Crs::name)
      .def_readonly("wkt", &Crs::wkt);
  py::class_<Cloud, Holder>(module, "Cloud")
      .def("__len__", &Cloud::size)
      .def_readonly("name", &Cloud::name)
      .def_readonly("dropped_points", &Cloud::dropped_points)
      .def_readonly("warnings", &Cloud::warnings)
      .def_readonly("fields", &Cloud::fields)
      .def_readonly("crs", &Cloud::crs)
      .def_property_readonly("origin", [](const Cloud& cloud) { return arrayOf(cloud.origin); })
      .def("file_points", &filePoints)
      .def("local_points", &localPoints)
      .def("colours", &colours);
  module.def("make_cloud", &make);
  bindFiles(module);
}

}  // namespace agricolmap::python
