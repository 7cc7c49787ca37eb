// A coloured point cloud with a double origin, so that UTM coordinates lose nothing in float, and
// what moves one.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace agricolmap {

/// 8-bit colour as clouds and pictures store it.
struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  bool operator==(const Rgb&) const = default;
};

/// What coordinates mean on the Earth. Empty where nobody said.
struct Crs {
  std::string name;  ///< "WGS 84 / UTM zone 32N"
  std::string wkt;   ///< its whole definition, OGC WKT
  /// Metres per unit along x and y, and along z, as the file has them; clouds are in metres.
  double horizontal_unit = 1.0;
  double vertical_unit = 1.0;
};

/// Points in metres. A point's coordinates in its file are `origin + xyz[i]`.
/// `rgb` is empty (no colours) or as long as `xyz`. All points are finite.
struct Cloud {
  std::string name;                                  ///< file it came from, for messages
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< file coordinates of the local zero [m]
  std::vector<Eigen::Vector3f> xyz;                  ///< local coordinates [m]
  std::vector<Rgb> rgb;                              ///< sensor colours, 0–255
  std::size_t dropped_points = 0;                    ///< left out on reading: not finite or far off
  std::vector<std::string> warnings;                 ///< what its reader found odd, file named
  Crs crs;                                           ///< of the coordinates as they stand here
  std::string fields;                                ///< "x, y, z, intensity": what its file has

  std::size_t size() const { return xyz.size(); }
  bool empty() const { return xyz.empty(); }
  bool hasColour() const { return !rgb.empty(); }
  /// Point i in the coordinates of its file [m].
  Eigen::Vector3d filePoint(std::size_t i) const { return origin + xyz[i].cast<double>(); }
};

/// target_from_source * point_in_source = point_in_target [m]. As Eigen::Affine3d, into and from
/// which it converts, but laid out alike whatever the compiler is told about the processor
/// (-march): the aligned type is not.
using Transform = Eigen::Transform<double, 3, Eigen::Affine, Eigen::DontAlign>;

}  // namespace agricolmap
