#include "agricolmap/report/page/page_facts.hpp"

#include <algorithm>

#include "agricolmap/config/text.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

template <typename Derived>
Json vectorJson(const Eigen::MatrixBase<Derived>& vector) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) json.push_back(vector(i));
  return json;
}

Eigen::Vector2d inLocal(const pipeline::Registration& registration, const Eigen::Vector2d& place) {
  return (registration.maps.frames.levelled_from_fixed.inverse() *
          Eigen::Vector3d(place.x(), place.y(), 0.0))
      .head<2>();
}

}  // namespace

Json optionsFacts(const pipeline::RegistrationOptions& in_force, const std::string& preset) {
  pipeline::RegistrationOptions options = in_force;
  pipeline::RegistrationOptions defaults = pipeline::resolved(pipeline::preset(preset));
  const OptionTable table = optionTable(options);
  const OptionTable default_table = optionTable(defaults);
  Json json = Json::array();
  for (const OptionField& field : table.fields()) {
    json.push_back({{"path", field.path},
                    {"value", config::optionText(field)},
                    {"default", config::optionText(*default_table.find(field.path))},
                    {"unit", field.unit},
                    {"help", field.help}});
  }
  return json;
}

Json blocksFacts(const pipeline::Registration& registration) {
  Json json = Json::array();
  if (!registration.placed) return json;
  const verdict::Evidence& evidence = registration.placed->evidence;
  // The strip's axes as the pose lays them.
  const Eigen::Vector2d along =
      (registration.placed->pose.linear() * evidence.strip.axes.col(0)).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  for (const verdict::BlockEvidence& block : evidence.blocks) {
    const Eigen::Vector2d local = evidence.strip.local(block.moving);
    json.push_back({{"place_m", vectorJson(inLocal(registration, block.place))},
                    {"best_m", vectorJson(inLocal(registration, block.place + block.offset))},
                    {"along_m", local.x() + evidence.strip.half_extent.x()},
                    {"across_m", local.y()},
                    {"offset_along_m", along.dot(block.offset)},
                    {"offset_across_m", across.dot(block.offset)},
                    {"agrees", block.agrees}});
  }
  return json;
}

Json stripFacts(const pipeline::Registration& registration) {
  if (!registration.placed) return nullptr;
  const map::StripFrame& strip = registration.placed->evidence.strip;
  const Eigen::Vector2d along = registration.placed->pose.linear() * strip.axes.col(0);
  const Eigen::Vector2d direction =
      registration.maps.frames.levelled_from_fixed.linear().inverse().topLeftCorner<2, 2>() * along;
  return {{"length_m", 2.0 * strip.half_extent.x()},
          {"width_m", 2.0 * strip.half_extent.y()},
          {"direction", vectorJson(direction.normalized())}};
}

Json rigidFacts(const CloudOrigins& origins, const pipeline::Registration& registration) {
  if (!registration.transform) return nullptr;
  const Eigen::Affine3d& affine = registration.transform->local_fixed_from_moving;
  const map::Box2& box = registration.maps.moving_box;
  const Eigen::Affine3d local_from_levelled =
      registration.maps.frames.levelled_from_moving.inverse();
  const auto inMoving = [&](const Eigen::Vector2d& place) -> Eigen::Vector3d {
    return local_from_levelled * Eigen::Vector3d(place.x(), place.y(), 0.0);
  };
  const Eigen::Vector3d middle = inMoving(box.center());
  const Eigen::Matrix3d rotation = nearestRotation(affine.linear());
  const Eigen::Vector3d shift = affine * middle - rotation * middle;
  double off = 0.0;
  for (const auto corner :
       {map::Box2::BottomLeft, map::Box2::BottomRight, map::Box2::TopLeft, map::Box2::TopRight}) {
    const Eigen::Vector3d point = inMoving(box.corner(corner));
    off = std::max(off, (affine * point - (rotation * point + shift)).norm());
  }
  const Eigen::Quaterniond quaternion(rotation);
  const Eigen::Vector3d file_shift = origins.fixed + shift - rotation * origins.moving;
  return {{"quaternion_xyzw", {quaternion.x(), quaternion.y(), quaternion.z(), quaternion.w()}},
          {"local_shift_m", vectorJson(shift)},
          {"file_shift_m", vectorJson(file_shift)},
          {"most_off_m", off}};
}

}  // namespace agricolmap::report
