#include "agricolmap/ros.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io.hpp"

namespace agricolmap {
namespace {

constexpr std::uint8_t kUint8 = 2;
constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint8_t kFloat64 = 8;
constexpr std::size_t kPacked = 4;  ///< bytes of a packed colour, whatever its type is called

/// Where in a point its parts are.
struct Places {
  std::array<std::size_t, 3> xyz{};
  bool doubles = false;
  std::optional<std::array<std::size_t, 3>> rgb;
};

const PointField* find(const PointCloud2View& message, const char* name) {
  const auto found = std::ranges::find(message.fields, name, &PointField::name);
  return found == message.fields.end() ? nullptr : &*found;
}

std::string namesOf(const PointCloud2View& message) {
  std::string names;
  for (const PointField& field : message.fields) names += (names.empty() ? "" : ", ") + field.name;
  return names.empty() ? "no fields" : names;
}

std::size_t placeOf(const PointCloud2View& message, const PointField& field, std::size_t bytes,
                    const std::string& name) {
  if (std::size_t{field.offset} + bytes > message.point_step) {
    throw InputError(fmt::format("{}: field {} lies at byte {} of points of {} bytes", name,
                                 field.name, field.offset, message.point_step));
  }
  return field.offset;
}

void findPosition(const PointCloud2View& message, const std::string& name, Places& places) {
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const PointField* field = find(message, kNames[i]);
    if (field == nullptr) {
      throw InputError(
          fmt::format("{}: has no field {}, but {}", name, kNames[i], namesOf(message)));
    }
    if (field->datatype != kFloat32 && field->datatype != kFloat64) {
      throw InputError(
          fmt::format("{}: field {} is of type {}; float32 (7) or float64 (8) is needed", name,
                      field->name, field->datatype));
    }
    const bool doubles = field->datatype == kFloat64;
    if (i > 0 && doubles != places.doubles) {
      throw InputError(fmt::format("{}: x, y and z are of different types", name));
    }
    places.doubles = doubles;
    places.xyz[i] = placeOf(message, *field, doubles ? sizeof(double) : sizeof(float), name);
  }
}

void findColour(const PointCloud2View& message, const std::string& name, Places& places) {
  for (const char* packed : {"rgb", "rgba"}) {
    if (const PointField* field = find(message, packed)) {
      const std::size_t at = placeOf(message, *field, kPacked, name);
      // 0xAARRGGBB in the order of the message.
      const bool big = message.is_bigendian;
      places.rgb = {{at + (big ? 1 : 2), at + (big ? 2 : 1), at + (big ? 3 : 0)}};
      return;
    }
  }
  std::array<std::size_t, 3> rgb{};
  constexpr std::array<const char*, 3> kNames{"r", "g", "b"};
  for (std::size_t i = 0; i < 3; ++i) {
    const PointField* field = find(message, kNames[i]);
    if (field == nullptr || field->datatype != kUint8) return;
    rgb[i] = placeOf(message, *field, 1, name);
  }
  places.rgb = rgb;
}

template <typename Number>
double numberAt(const std::byte* from, bool swapped) {
  std::array<std::byte, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), from, sizeof(Number));
  if (swapped) std::ranges::reverse(bytes);
  return static_cast<double>(std::bit_cast<Number>(bytes));
}

void requireWhole(const PointCloud2View& message, const std::string& name) {
  const std::size_t row = std::size_t{message.width} * message.point_step;
  if (message.height == 0 || message.width == 0 || message.point_step == 0) {
    throw InputError(fmt::format("{}: has no points", name));
  }
  if ((message.height > 1 && message.row_step < row) ||
      message.data.size() < std::size_t{message.height - 1} * message.row_step + row) {
    throw InputError(fmt::format(
        "{}: {} x {} points of {} bytes, rows of {}, are not within its {} bytes", name,
        message.height, message.width, message.point_step, message.row_step, message.data.size()));
  }
}

}  // namespace

Cloud readPointCloud2(const PointCloud2View& message, const std::string& name) {
  requireWhole(message, name);
  Places places;
  findPosition(message, name, places);
  findColour(message, name, places);
  const bool swapped = message.is_bigendian != (std::endian::native == std::endian::big);
  const std::size_t count = std::size_t{message.height} * message.width;
  std::vector<Eigen::Vector3d> points(count);
  std::vector<Rgb> colours(places.rgb ? count : 0);
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* const point = message.data.data() + i / message.width * message.row_step +
                                   i % message.width * message.point_step;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::byte* const at = point + places.xyz[axis];
      points[i][static_cast<Eigen::Index>(axis)] =
          places.doubles ? numberAt<double>(at, swapped) : numberAt<float>(at, swapped);
    }
    if (places.rgb) {
      const auto channel = [&](std::size_t k) {
        return std::to_integer<std::uint8_t>(point[(*places.rgb)[k]]);
      };
      colours[i] = {channel(0), channel(1), channel(2)};
    }
  }
  return makeCloud(points, colours, name);
}

}  // namespace agricolmap
