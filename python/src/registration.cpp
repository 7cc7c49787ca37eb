// The registration and its result.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <agricolmap/register.hpp>
#include <agricolmap/report.hpp>
#include <memory>

#include "bindings.hpp"
#include "waiting.hpp"

namespace agricolmap::python {
namespace {

using Result = Registration;

py::object partsOf(const Result& result) {
  if (!result.parts) return py::none();
  const Result::Parts& parts = *result.parts;
  py::dict made;
  made["shift_m"] = arrayOf(parts.shift_m);
  made["centre_m"] = arrayOf(parts.centre_m);
  made["heading_deg"] = parts.heading_deg;
  made["tilt_x_deg"] = parts.tilt_x_deg;
  made["tilt_y_deg"] = parts.tilt_y_deg;
  made["scale_x"] = parts.scale_x;
  made["scale_y"] = parts.scale_y;
  made["scale_z"] = parts.scale_z;
  made["shear"] = parts.shear;
  return made;
}

py::object uncertaintyOf(const Result& result) {
  if (!result.uncertainty) return py::none();
  const Result::Uncertainty& uncertainty = *result.uncertainty;
  py::dict made;
  made["expected_rms_m"] = uncertainty.expected_rms_m;
  made["local_rms_m"] = uncertainty.local_rms_m;
  made["covariance"] =
      py::array_t<double>(std::vector<py::ssize_t>{6, 6}, uncertainty.covariance.data());
  made["centre_m"] = arrayOf(uncertainty.centre_m);
  made["height_deviation_m"] = uncertainty.height_deviation_m;
  return made;
}

py::object deformationOf(const Result& result) {
  if (!result.deformation) return py::none();
  py::list nodes;
  for (const Result::Deformation::Node& node : result.deformation->nodes) {
    nodes.append(py::make_tuple(node.along_m, arrayOf(node.place_m), arrayOf(node.displacement_m),
                                arrayOf(node.deviation_m)));
  }
  py::list slips;
  for (const Result::Deformation::Slip& slip : result.deformation->slips) {
    slips.append(py::make_tuple(slip.along_m, arrayOf(slip.place_m), arrayOf(slip.offset_m),
                                slip.deviation_m));
  }
  py::dict made;
  made["nodes"] = nodes;
  made["slips"] = slips;
  made["gain"] = result.deformation->gain;
  made["rms_m"] = result.deformation->rms_m;
  return made;
}

py::object heightsOf(const Result& result) {
  if (!result.heights) return py::none();
  const Result::Heights& heights = *result.heights;
  py::dict made;
  made["measured"] = heights.measured;
  made["limit"] = heights.limit;
  made["words"] = heights.words;
  made["deviation_m"] = heights.deviation_m;
  made["bias_m"] = heights.bias_m;
  made["vertical_scale"] = heights.vertical_scale;
  made["vertical_scale_deviation"] = heights.vertical_scale_deviation;
  return made;
}

py::dict evidenceOf(const Result& result) {
  const Result::Evidence& evidence = result.evidence;
  py::dict made;
  made["significance"] = evidence.significance;
  made["uniqueness"] = evidence.uniqueness;
  made["blocks"] = evidence.blocks;
  made["agreeing_blocks"] = evidence.agreeing_blocks;
  made["overlap"] = evidence.overlap;
  made["correlation"] = evidence.correlation;
  return made;
}

/// All that is plain values.
py::dict valuesOf(const Result& result) {
  py::list alternatives;
  for (const Result::Alternative& other : result.alternatives) {
    alternatives.append(py::make_tuple(arrayOf(other.fixed_from_moving), other.significance));
  }
  py::dict times;
  for (const Result::StageTime& time : result.times) times[py::str(time.stage)] = time.seconds;
  py::dict values;
  values["status"] = toString(result.status);
  values["reasons"] = result.reasons;
  values["remedies"] = result.remedies;
  values["plane_probability"] = result.plane_probability;
  values["place_probability"] = result.place_probability;
  values["transform"] = result.fixed_from_moving ? py::object(arrayOf(*result.fixed_from_moving))
                                                 : py::object(py::none());
  values["parts"] = partsOf(result);
  values["deformation"] = deformationOf(result);
  values["uncertainty"] = uncertaintyOf(result);
  values["heights"] = heightsOf(result);
  values["evidence"] = evidenceOf(result);
  values["alternatives"] = alternatives;
  values["times"] = times;
  values["warnings"] = result.warnings;
  return values;
}

/// Of points of the moving file, one row each.
Points displacements(const Result& result, const Points& points) {
  const std::span<const Eigen::Vector3d> rows = rowsOf(points);
  Points moved(std::vector<py::ssize_t>{points.shape(0), 3});
  double* out = moved.mutable_data();
  const py::gil_scoped_release release;
  for (const Eigen::Vector3d& row : rows) {
    Eigen::Map<Eigen::Vector3d>(out, 3) = result.deformation->displacement(row);
    out += 3;
  }
  return moved;
}

std::shared_ptr<Result> registerInto(const std::shared_ptr<Cloud>& fixed,
                                     const std::shared_ptr<Cloud>& moving, const Matrix& guess,
                                     const Options& options, const Points& path,
                                     const py::object& progress, const py::object& stop,
                                     int threads) {
  const Transform fixed_from_moving = transformOf(guess);
  // Copies, as another thread of Python may set options, or write into the array, meanwhile.
  const auto rows = rowsOf(path);
  const std::vector<Eigen::Vector3d> places(rows.begin(), rows.end());
  return std::make_shared<Result>(
      waitFor({progress, stop}, threads, [&, chosen = options](const Control& control) {
        return registerClouds(*fixed, *moving, fixed_from_moving, chosen, control, places);
      }));
}

}  // namespace

void bindRegistration(py::module_& module) {
  py::class_<Result, std::shared_ptr<Result>>(module, "Registration")
      .def("values", &valuesOf)
      .def("displacements", &displacements)
      .def("report_text", &reportText)
      .def("write_report",
           [](const Result& result, const std::filesystem::path& folder,
              const std::vector<std::string>& pictures) { writeReport(folder, result, pictures); });
  module.def("register", &registerInto);
  module.def("aligned_cloud", [](const Cloud& moving, const Result& result) {
    const py::gil_scoped_release release;
    return std::make_shared<Cloud>(alignedCloud(moving, result));
  });
}

}  // namespace agricolmap::python
