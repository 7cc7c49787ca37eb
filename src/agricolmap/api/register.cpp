// The one place where what the pipeline found becomes what callers see.
#include "agricolmap/register.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "agricolmap/api/checks.hpp"
#include "agricolmap/api/finished.hpp"
#include "agricolmap/api/record.hpp"
#include "agricolmap/api/values.hpp"
#include "agricolmap/config/json.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/monitor.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/report/json/registration_json.hpp"
#include "agricolmap/version.hpp"

namespace agricolmap {
namespace {

Registration::Status statusOf(verdict::Status status) {
  switch (status) {
    case verdict::Status::kAccepted:
      return Registration::Status::kAccepted;
    case verdict::Status::kAmbiguous:
      return Registration::Status::kAmbiguous;
    case verdict::Status::kRejected:
      break;
  }
  return Registration::Status::kRejected;
}

Registration::Parts partsOf(const pipeline::Transform& transform) {
  Registration::Parts parts;
  parts.shift_m = transform.shift;
  parts.centre_m = transform.centre;
  parts.heading_deg = degrees(transform.parts.yaw);
  parts.tilt_x_deg = degrees(transform.tilt.x());
  parts.tilt_y_deg = degrees(transform.tilt.y());
  parts.scale_x = transform.parts.scale_x;
  parts.scale_y = transform.parts.scale_y;
  parts.scale_z = transform.vertical_scale;
  parts.shear = transform.parts.shear;
  return parts;
}

Registration::Uncertainty uncertaintyOf(const Cloud& fixed, const pipeline::Registration& found) {
  const verdict::PoseUncertainty& inside = *found.placed->uncertainty;
  Registration::Uncertainty uncertainty;
  uncertainty.expected_rms_m = inside.expected_rms;
  uncertainty.local_rms_m = inside.local_rms;
  uncertainty.height_deviation_m = inside.height_deviation;
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(uncertainty.covariance.data()) =
      inside.covarianceWithHeight(found.maps.frames.turn);
  const Eigen::Vector3d levelled(inside.centre.x(), inside.centre.y(),
                                 found.placed->heights.offset);
  uncertainty.centre_m = fixed.origin + found.maps.frames.levelled_from_fixed.inverse() * levelled;
  return uncertainty;
}

Registration::Heights heightsOf(const verdict::HeightsVerdict& inside,
                                const refine::VerticalScale& scale) {
  Registration::Heights heights;
  heights.measured = !inside.limited();
  if (inside.limited()) heights.limit = toString(inside.limit);
  heights.words = describe(inside);
  heights.deviation_m = inside.deviation;
  heights.bias_m = inside.bias;
  if (scale.measured()) {
    heights.vertical_scale = scale.value;
    heights.vertical_scale_deviation = scale.deviation;
  }
  return heights;
}

Registration::Evidence evidenceOf(const pipeline::Placed& placed) {
  Registration::Evidence evidence;
  evidence.significance = placed.evidence.significance;
  evidence.uniqueness = placed.evidence.uniqueness;
  evidence.blocks = placed.evidence.blocks.size();
  evidence.agreeing_blocks = placed.evidence.agreeing;
  evidence.overlap = placed.overlap;
  evidence.correlation = placed.correlation;
  return evidence;
}

/// `record` keeps what the displacement is computed from.
Registration::Deformation deformationOf(const Cloud& moving,
                                        std::shared_ptr<const Registration::Record> record) {
  const pipeline::Displacement inside(record->found, moving);
  const deform::Bend& bend = record->found.placed->followed->bend;
  Registration::Deformation deformation;
  deformation.gain = bend.gain;
  deformation.rms_m = bend.rms;
  for (int i = 1; i + 1 < bend.deformation.basis().size(); ++i) {
    const double along = bend.deformation.basis().place(i);
    const Eigen::Vector3d point = inside.pathPoint(along);
    deformation.nodes.push_back({along, inside.place(point), inside.at(point),
                                 inside.covarianceAt(point).diagonal().cwiseSqrt()});
  }
  for (const deform::Slip& slip : bend.deformation.slips) {
    const Eigen::Vector3d offset(slip.offset.x(), slip.offset.y(), 0.0);
    deformation.slips.push_back({slip.along, inside.place(inside.pathPoint(slip.along)),
                                 inside.inFile(offset), slip.deviation});
  }
  deformation.displacement = [record = std::move(record), inside](const Eigen::Vector3d& point) {
    return inside.at(point);
  };
  return deformation;
}

Registration publicResult(const Cloud& fixed, const pipeline::Registration& found) {
  Registration result;
  result.status = statusOf(found.verdict.status);
  result.reasons = found.verdict.reasons;
  result.remedies = found.verdict.remedies;
  result.plane_probability = found.verdict.plane_probability;
  result.place_probability = found.verdict.place_probability;
  if (found.transform) {
    result.fixed_from_moving = found.transform->fixed_from_moving;
    result.parts = partsOf(*found.transform);
    result.heights = heightsOf(found.verdict.heights, found.placed->heights.measured_scale);
  }
  if (found.placed) {
    result.evidence = evidenceOf(*found.placed);
    if (found.transform && found.placed->uncertainty) {
      result.uncertainty = uncertaintyOf(fixed, found);
    }
  }
  for (const pipeline::Alternative& other : found.alternatives) {
    result.alternatives.push_back({other.fixed_from_moving, other.significance});
  }
  return result;
}

void refuseIdle(const Options::Values& values) {
  pipeline::RegistrationOptions options = values.options;
  pipeline::RegistrationOptions preset = pipeline::preset(values.preset);
  const OptionTable table = optionTable(options);
  const OptionTable usual = optionTable(preset);
  for (const OptionField& field : table.fields()) {
    const std::string value = config::optionText(field);
    if (value == config::optionText(*usual.find(field.path))) continue;
    const std::string missing = pipeline::missingFor(options, field.path);
    if (!missing.empty()) {
      throw UsageError(
          fmt::format("option {} = {} would do nothing: it needs {}", field.path, value, missing));
    }
  }
}

nlohmann::ordered_json reportOf(const Cloud& fixed, const Cloud& moving,
                                const pipeline::Registration& found, const Asked& asked,
                                const Monitor& monitor) {
  pipeline::RegistrationOptions in_force = asked.options;
  report::RegistrationReportInfo info;
  info.version = version();
  info.seed = static_cast<std::uint64_t>(in_force.seed);
  info.threads = asked.threads;
  info.preset = asked.preset;
  info.prior = asked.guess;
  // None of its own is what the command line says of a pair without a guess.
  const bool none = asked.guess.matrix().isIdentity(0.0);
  info.prior_source = none ? "coordinates as they stand" : "given by the caller";
  info.options = config::toJson(optionTable(in_force));
  return report::registrationJson(CloudStream(fixed), moving, found, monitor, info);
}

}  // namespace

const char* toString(Registration::Status status) {
  switch (status) {
    case Registration::Status::kAccepted:
      return "accepted";
    case Registration::Status::kAmbiguous:
      return "ambiguous";
    case Registration::Status::kRejected:
      break;
  }
  return "rejected";
}

pipeline::RegistrationOptions optionsInForce(const Options& options) {
  refuseIdle(options.values());
  return pipeline::resolved(options.values().options);
}

Monitor monitorFor(const Control& control) {
  return Monitor(control.stop, [on_stage = control.on_stage](Stage stage) {
    if (on_stage) on_stage(nameOf(stage));
  });
}

Registration finished(const Cloud& fixed, const Cloud& moving, pipeline::Registration found,
                      const Asked& asked, const Monitor& monitor) {
  auto record = std::make_shared<Registration::Record>();
  record->found = std::move(found);
  record->options = asked.options;
  record->preset = asked.preset;
  record->guess = asked.guess;
  record->fixed_name = fixed.name;
  record->moving_name = moving.name;
  record->fixed_origin = fixed.origin;
  record->moving_origin = moving.origin;
  record->fixed_points = fixed.size();
  record->moving_points = moving.size();
  record->fixed_crs = fixed.crs;
  record->fixed_coloured = fixed.hasColour();
  record->moving_coloured = moving.hasColour();
  record->report = reportOf(fixed, moving, record->found, asked, monitor);
  Registration result = publicResult(fixed, record->found);
  for (const StageTime& time : monitor.times()) {
    result.times.push_back({std::string(nameOf(time.stage)), time.seconds});
  }
  result.warnings = report::warningsOf(CloudStream(fixed), moving, monitor);
  result.record = std::move(record);
  if (result.record->found.transform && result.record->found.placed->followed) {
    result.deformation = deformationOf(moving, result.record);
  }
  return result;
}

Registration registerClouds(const Cloud& fixed, const Cloud& moving, const Transform& guess,
                            const Options& options, const Control& control,
                            const std::vector<Eigen::Vector3d>& path) {
  requireProcessor();
  requireWhole(fixed);
  requireWhole(moving);
  const ThreadLimit limit = threadLimit(control);
  const Asked asked{guess, optionsInForce(options), options.preset(), control.threads};
  Monitor monitor = monitorFor(control);
  pipeline::Registration found = pipeline::registerClouds(fixed, moving, Eigen::Affine3d(guess),
                                                          asked.options, monitor, {}, path);
  return finished(fixed, moving, std::move(found), asked, monitor);
}

Cloud alignedCloud(const Cloud& moving, const Registration& registration) {
  requireProcessor();
  if (!registration.fixed_from_moving) {
    throw UsageError("a registration without a transformation lays no cloud anywhere");
  }
  if (!registration.record) {
    throw UsageError("a cloud can only be laid by what registerClouds returned");
  }
  Cloud aligned = pipeline::alignedCloud(registration.record->found, moving);
  aligned.crs = registration.record->fixed_crs;
  return aligned;
}

}  // namespace agricolmap
