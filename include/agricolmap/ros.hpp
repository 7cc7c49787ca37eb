// Clouds as robots send them: the layout of ROS's sensor_msgs/PointCloud2, without ROS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"

namespace agricolmap {

/// sensor_msgs/PointField. `datatype`: 1 int8, 2 uint8, 3 int16, 4 uint16, 5 int32, 6 uint32,
/// 7 float32, 8 float64.
struct PointField {
  std::string name;
  std::uint32_t offset = 0;  ///< from the beginning of a point [bytes]
  std::uint8_t datatype = 7;
  std::uint32_t count = 1;
};

/// sensor_msgs/PointCloud2 without its header; it looks at the message's bytes and keeps none.
struct PointCloud2View {
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;  ///< [bytes]
  std::uint32_t row_step = 0;    ///< [bytes]
  std::span<const std::byte> data;
};

/// Points in the frame and the metres of the message: fields x, y, z (float32 or float64), colours
/// from `rgb` or `rgba` (packed in four bytes, as PCL and the depth cameras' drivers do) or from
/// `r`, `g`, `b` (uint8), none without either. Points that are not finite are left out and counted.
/// `name` stands for the cloud in messages: a topic. Throws InputError when a field is missing, of
/// a type that has no meaning here or not within the data, and when no point is usable.
AGRICOLMAP_EXPORT Cloud readPointCloud2(const PointCloud2View& message,
                                        const std::string& name = "PointCloud2");

/// What is seen of a message of ROS 1 or ROS 2, whose members have these names. The message must
/// outlive it.
template <typename Message>
PointCloud2View viewOf(const Message& message) {
  PointCloud2View view;
  view.height = message.height;
  view.width = message.width;
  for (const auto& field : message.fields) {
    view.fields.push_back({field.name, field.offset, field.datatype, field.count});
  }
  view.is_bigendian = message.is_bigendian != 0;
  view.point_step = message.point_step;
  view.row_step = message.row_step;
  view.data = std::as_bytes(std::span(message.data.data(), message.data.size()));
  return view;
}

}  // namespace agricolmap
