#include "support/ply_bytes.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>

namespace agricolmap::test {
namespace {

constexpr std::size_t kCoordinateBytes = 3 * sizeof(double);
constexpr std::size_t kPointBytes = kCoordinateBytes + 3;

}  // namespace

std::string plyHeader(std::size_t count, bool colours) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(count) +
                       "\nproperty double x\nproperty double y\nproperty double z\n";
  if (colours) {
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  return header + "end_header\n";
}

std::string plyBytes(const std::vector<PlyPoint>& points, bool colours) {
  std::string bytes = plyHeader(points.size(), colours);
  bytes.reserve(bytes.size() + points.size() * kPointBytes);
  std::array<char, kPointBytes> record{};
  for (const PlyPoint& point : points) {
    std::memcpy(record.data(), point.xyz.data(), kCoordinateBytes);
    std::memcpy(record.data() + kCoordinateBytes, point.rgb.data(), 3);
    bytes.append(record.data(), colours ? kPointBytes : kCoordinateBytes);
  }
  return bytes;
}

std::vector<PlyPoint> pointsOfPly(const std::string& bytes) {
  const std::string end = "end_header\n";
  const std::size_t header_end = bytes.find(end);
  const std::size_t body = header_end + end.size();
  if (header_end == std::string::npos || (bytes.size() - body) % kPointBytes != 0) {
    throw std::runtime_error("not the PLY that 'simulate' writes");
  }
  std::vector<PlyPoint> points((bytes.size() - body) / kPointBytes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const char* const record = bytes.data() + body + i * kPointBytes;
    std::memcpy(points[i].xyz.data(), record, kCoordinateBytes);
    std::memcpy(points[i].rgb.data(), record + kCoordinateBytes, 3);
  }
  return points;
}

std::vector<PlyPoint> bumpySquare(double side, double x, double y) {
  constexpr double kStep = 0.05;
  const int count = static_cast<int>(side / kStep);
  std::vector<PlyPoint> points;
  for (int row = 0; row < count; ++row) {
    for (int col = 0; col < count; ++col) {
      const double u = kStep * col;
      const double v = kStep * row;
      const double height = 0.05 * std::sin(7.0 * u) * std::cos(5.0 * v);
      const auto green = static_cast<std::uint8_t>(128.0 + 1000.0 * height);
      points.push_back({{x + u, y + v, height}, {90, green, 60}});
    }
  }
  return points;
}

}  // namespace agricolmap::test
