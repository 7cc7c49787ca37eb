// LAS files byte by byte, so that tests can write what no writer would.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/io/las/las_layout.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::test {

/// An uncompressed file; what a test does not set is as it should be.
struct LasBytes {
  int minor = 2;
  int format = 2;
  std::size_t extra_bytes = 0;
  double scale = 0.001;
  std::array<double, 3> offset{500000.0, 5400000.0, 100.0};
  std::vector<std::string> records;  ///< variable length records
  std::vector<std::string> points;

  io::LasLayout layout() const {
    io::LasLayout layout = io::lasLayout(format);
    layout.length += extra_bytes;
    return layout;
  }
  std::size_t headerSize() const { return minor >= 4 ? 375 : minor == 3 ? 235 : 227; }
  std::size_t pointsBegin() const {
    std::size_t begin = headerSize();
    for (const std::string& record : records) begin += record.size();
    return begin;
  }

  void add(std::int32_t x, std::int32_t y, std::int32_t z, std::array<std::uint16_t, 3> rgb = {},
           bool withheld = false) {
    const io::LasLayout at = layout();
    std::string point(at.length, '\0');
    set(point, 0, x);
    set(point, 4, y);
    set(point, 8, z);
    if (withheld) point[15] = static_cast<char>(at.extended ? 0x04 : 0x80);
    for (std::size_t c = 0; at.rgb && c < 3; ++c) set(point, *at.rgb + 2 * c, rgb[c]);
    points.push_back(point);
  }

  std::string bytes() const {
    std::string file(headerSize(), '\0');
    file.replace(0, 4, "LASF");
    file[24] = 1;
    file[25] = static_cast<char>(minor);
    set(file, 94, static_cast<std::uint16_t>(headerSize()));
    set(file, 96, static_cast<std::uint32_t>(pointsBegin()));
    set(file, 100, static_cast<std::uint32_t>(records.size()));
    file[104] = static_cast<char>(format);
    set(file, 105, static_cast<std::uint16_t>(layout().length));
    const bool legacy = format < 6;
    if (legacy) set(file, 107, static_cast<std::uint32_t>(points.size()));
    if (minor >= 4) set(file, 247, static_cast<std::uint64_t>(points.size()));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      set(file, 131 + 8 * axis, scale);
      set(file, 155 + 8 * axis, offset[axis]);
    }
    for (const std::string& record : records) file += record;
    for (const std::string& point : points) file += point;
    return file;
  }

  static std::string record(const std::string& user, std::uint16_t id, const std::string& data) {
    std::string bytes(54, '\0');
    bytes.replace(2, user.size(), user);
    set(bytes, 18, id);
    set(bytes, 20, static_cast<std::uint16_t>(data.size()));
    return bytes + data;
  }
  template <typename T>
  static void set(std::string& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
};

}  // namespace agricolmap::test
