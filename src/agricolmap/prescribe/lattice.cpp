#include "agricolmap/prescribe/lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap::prescribe {

void listOptions(OptionTable& table, SquareOptions& options) {
  table
      .number("width", options.width, 0.1, 1000.0, "m",
              "side of a square with one rate, across the heading: the working width or a section")
      .basic();
  table.number("length", options.length, 0.0, 1000.0, "m", "side along the heading; 0: as width")
      .basic();
  table.number("least_seen", options.least_seen, 0.01, 1.0, "",
               "a square gets a rate where the layer knows this share of it");
}

namespace {

constexpr double kBillionth = 1e-9;  // of a degree
constexpr double kSemiMajor = 6378137.0;
constexpr double kEccentricity = 6.69437999014e-3;  // of WGS 84, squared

double wholeBillionths(double degrees) {
  return std::max(1.0, std::round(degrees / kBillionth)) * kBillionth;
}

std::vector<Eigen::Vector2d> cornersOf(const GridFrame& frame) {
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  return {frame.corner, frame.corner + Eigen::Vector2d(size.x(), 0.0), frame.corner + size,
          frame.corner + Eigen::Vector2d(0.0, size.y())};
}

struct Box {
  Eigen::Vector2d low;
  Eigen::Vector2d high;
};

Box boxOf(const std::vector<Eigen::Vector2d>& points) {
  Box box{points.front(), points.front()};
  for (const Eigen::Vector2d& point : points) {
    box.low = box.low.cwiseMin(point);
    box.high = box.high.cwiseMax(point);
  }
  return box;
}

void requireCount(double rows, double cols) {
  if (rows * cols <= kMostSquares) return;
  throw UsageError(
      fmt::format("{:.0f} x {:.0f} squares are too many (limit {:.0e}); make them larger: width",
                  cols, rows, kMostSquares));
}

/// Exact along parallels and meridians, which the sides of squares in degrees are: the area between
/// a parallel and one of reference, by the mean scale between them.
double ringArea(const std::vector<Eigen::Vector2d>& ring, double reference) {
  double area = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    const double above = 0.5 * (a.y() + b.y()) - reference;
    const Eigen::Vector2d scale = metresPerDegree(reference + 0.5 * above);
    area += (a.x() - b.x()) * scale.x() * above * scale.y();
  }
  return std::abs(area);
}

}  // namespace

double polygonArea(const std::vector<Eigen::Vector2d>& outline,
                   const std::vector<std::vector<Eigen::Vector2d>>& holes) {
  const double reference = outline.front().y();
  double area = ringArea(outline, reference);
  for (const std::vector<Eigen::Vector2d>& hole : holes) area -= ringArea(hole, reference);
  return area;
}

Lattice Lattice::part(int row, int col, int part_rows, int part_cols) const {
  Lattice result = *this;
  result.corner = at(row, col);
  result.rows = part_rows;
  result.cols = part_cols;
  return result;
}

Eigen::Vector2d metresPerDegree(double latitude) {
  const double sine = std::sin(radians(latitude));
  const double bend = 1.0 - kEccentricity * sine * sine;
  const double across = kSemiMajor / std::sqrt(bend);
  const double along = across * (1.0 - kEccentricity) / bend;
  return radians(1.0) * Eigen::Vector2d(across * std::cos(radians(latitude)), along);
}

Lattice degreeLattice(const GridFrame& frame, const Earth& earth, double width, double length) {
  const Box box = boxOf(earth.degrees_from_file(cornersOf(frame)));
  const Eigen::Vector2d scale = metresPerDegree(0.5 * (box.low.y() + box.high.y()));
  const Eigen::Vector2d step(wholeBillionths(width / scale.x()),
                             wholeBillionths(length / scale.y()));
  Lattice lattice;
  // The borders of a frame bend by less than a square in degrees, and the last column is not full.
  lattice.corner = ((box.low - step) / kBillionth).array().floor().matrix() * kBillionth;
  const Eigen::Vector2d count =
      ((box.high + step - lattice.corner).array() / step.array()).ceil().matrix();
  requireCount(count.y(), count.x());
  lattice.axes = step.asDiagonal();
  lattice.cols = static_cast<int>(count.x());
  lattice.rows = static_cast<int>(count.y());
  return lattice;
}

Lattice turnedLattice(const GridFrame& frame, double heading, double width, double length) {
  Lattice lattice;
  lattice.in_degrees = false;
  Eigen::Matrix2d turn;
  turn << std::cos(heading), -std::sin(heading), std::sin(heading), std::cos(heading);
  const Eigen::Vector2d step(length, width);
  std::vector<Eigen::Vector2d> corners = cornersOf(frame);
  for (Eigen::Vector2d& corner : corners) corner = turn.transpose() * corner;
  const Box box = boxOf(corners);
  const Eigen::Vector2d first = (box.low.array() / step.array()).floor().matrix();
  const Eigen::Vector2d count = (box.high.array() / step.array()).ceil().matrix() - first;
  requireCount(count.y(), count.x());
  lattice.axes = turn * step.asDiagonal();
  lattice.corner = lattice.axes * first;
  lattice.cols = std::max(1, static_cast<int>(count.x()));
  lattice.rows = std::max(1, static_cast<int>(count.y()));
  return lattice;
}

std::vector<Eigen::Vector2d> cornersInFile(const Lattice& lattice, const Earth& earth) {
  std::vector<Eigen::Vector2d> corners;
  corners.reserve(static_cast<std::size_t>(lattice.rows + 1) *
                  static_cast<std::size_t>(lattice.cols + 1));
  for (int row = 0; row <= lattice.rows; ++row) {
    for (int col = 0; col <= lattice.cols; ++col) corners.push_back(lattice.at(row, col));
  }
  return lattice.in_degrees ? earth.file_from_degrees(corners) : corners;
}

Eigen::Affine2d placeFromFile(const Lattice& lattice, const Earth& earth) {
  std::vector<Eigen::Vector2d> corners = {lattice.at(0, 0), lattice.at(0, lattice.cols),
                                          lattice.at(lattice.rows, 0)};
  if (lattice.in_degrees) corners = earth.file_from_degrees(corners);
  Eigen::Affine2d file_from_place = Eigen::Affine2d::Identity();
  file_from_place.linear().col(0) = (corners[1] - corners[0]) / lattice.cols;
  file_from_place.linear().col(1) = (corners[2] - corners[0]) / lattice.rows;
  file_from_place.translation() = corners[0];
  return file_from_place.inverse();
}

std::vector<double> squareAreas(const Lattice& lattice, const Earth& earth) {
  std::vector<double> areas(static_cast<std::size_t>(lattice.rows));
  if (lattice.in_degrees) {
    for (int row = 0; row < lattice.rows; ++row) {
      const Eigen::Vector2d scale = metresPerDegree(lattice.at(row + 0.5, 0.0).y());
      areas[static_cast<std::size_t>(row)] =
          std::abs(lattice.axes.determinant()) * scale.x() * scale.y();
    }
    return areas;
  }
  // A map's projection stretches a whole field alike: its middle stands for all of it.
  const double row = 0.5 * lattice.rows;
  const double col = 0.5 * lattice.cols;
  const std::vector<Eigen::Vector2d> corner = earth.degrees_from_file(
      {lattice.at(row, col), lattice.at(row, col + 1.0), lattice.at(row + 1.0, col)});
  const Eigen::Array2d scale = metresPerDegree(corner[0].y()).array();
  const Eigen::Vector2d along = ((corner[1] - corner[0]).array() * scale).matrix();
  const Eigen::Vector2d across = ((corner[2] - corner[0]).array() * scale).matrix();
  std::fill(areas.begin(), areas.end(), std::abs(along.x() * across.y() - along.y() * across.x()));
  return areas;
}

}  // namespace agricolmap::prescribe
