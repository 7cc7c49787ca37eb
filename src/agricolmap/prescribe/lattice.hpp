// The squares that get one rate each, and where they lie on the Earth.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::prescribe {

/// From a map's coordinates [m] to longitude and latitude (WGS 84) [deg], and back: all points of a
/// list at once, in place of each. Whoever reads the map knows how, and throws where it lies on no
/// Earth.
struct Earth {
  using Turn = std::function<std::vector<Eigen::Vector2d>(const std::vector<Eigen::Vector2d>&)>;
  Turn degrees_from_file;
  Turn file_from_degrees;
};

struct SquareOptions {
  double width = 3.0;       ///< of a square, across the heading [m]
  double length = 0.0;      ///< along it; 0: as the width [m]
  double least_seen = 0.5;  ///< share of a square that the layer must know
};
void listOptions(OptionTable& table, SquareOptions& options);

/// `rows × cols` equal parts of a plane: of longitude and latitude, as task files have them, or of
/// the map's own, turned to where the machine drives. Column and row grow along the columns of
/// `axes`.
struct Lattice {
  bool in_degrees = true;
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();    ///< of row 0, column 0
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();  ///< columns: one column on, one row on
  int rows = 0;
  int cols = 0;

  Eigen::Vector2d at(double row, double col) const {
    return corner + axes * Eigen::Vector2d(col, row);
  }
  /// Column and row, 0 at the outer corner of the first.
  Eigen::Vector2d placeOf(const Eigen::Vector2d& point) const {
    return axes.inverse() * (point - corner);
  }
  /// Without borders: what is left from (row, col) on.
  Lattice part(int row, int col, int part_rows, int part_cols) const;
};

/// Covers the frame, whose corner is in file coordinates, with squares north up. Corners and sides
/// are whole billionths of a degree (0.1 mm), which is what task files have room for. Throws
/// UsageError for more than kMostSquares.
Lattice degreeLattice(const GridFrame& frame, const Earth& earth, double width, double length);

/// The same of squares whose length lies along `heading` [rad], counter-clockwise from the map's
/// east, on whole multiples of their sides in file coordinates.
Lattice turnedLattice(const GridFrame& frame, double heading, double width, double length);

inline constexpr double kMostSquares = 4e6;

/// Metres on the ellipsoid for one degree of longitude and of latitude, there.
Eigen::Vector2d metresPerDegree(double latitude);

/// On the ellipsoid, of a polygon of a few hundred metres in longitude and latitude [m²].
double polygonArea(const std::vector<Eigen::Vector2d>& outline,
                   const std::vector<std::vector<Eigen::Vector2d>>& holes);

/// Corners of all squares in the map's coordinates: (rows + 1) × (cols + 1), row by row.
std::vector<Eigen::Vector2d> cornersInFile(const Lattice& lattice, const Earth& earth);

/// From the map's coordinates to column and row, as Lattice::placeOf; of degrees to centimetres
/// within a field, which is for pictures.
Eigen::Affine2d placeFromFile(const Lattice& lattice, const Earth& earth);

/// On the ellipsoid, of a square of each row [m²].
std::vector<double> squareAreas(const Lattice& lattice, const Earth& earth);

}  // namespace agricolmap::prescribe
