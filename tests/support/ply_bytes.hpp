// PLY files byte by byte, so that tests can write what no writer would.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace agricolmap::test {

struct PlyPoint {
  std::array<double, 3> xyz{};
  std::array<std::uint8_t, 3> rgb{};
};

/// Reads what `agricolmap simulate` writes: binary little-endian, x y z double, red green blue.
std::vector<PlyPoint> pointsOfPly(const std::string& bytes);

/// The header that pointsOfPly reads, claiming `count` points.
std::string plyHeader(std::size_t count, bool colours = true);
/// A whole file.
std::string plyBytes(const std::vector<PlyPoint>& points, bool colours = true);

/// Coloured points every 5 cm on a bumpy square of `side` metres, with its corner at (x, y).
std::vector<PlyPoint> bumpySquare(double side, double x = 0.0, double y = 0.0);

}  // namespace agricolmap::test
