// Which way rows run and how far apart they are, piece by piece of a field.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "agricolmap/crop/view.hpp"

namespace agricolmap::crop {

struct RowOptions {
  double spacing_min = 0.10;  ///< between rows [m]
  double spacing_max = 1.20;  ///< [m]
  double break_length = 2.5;  ///< a row ends where nothing grows for so long [m]
  double min_length = 1.0;    ///< shorter ones are no rows [m]
};
void listOptions(OptionTable& table, RowOptions& options);

/// A piece of the field whose rows are straight and parallel.
struct RowTile {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m]
  double side = 0.0;                                 ///< [m]
  double heading = 0.0;   ///< of the rows, 0…π, counter-clockwise from x [rad]
  double offset = 0.0;    ///< of one of the rows from `centre`, to the heading's left [m]
  double strength = 0.0;  ///< share of the greenness's swing that the rows' wave has, 0…1
};

struct RowLattice {
  double spacing = 0.0;        ///< the field's [m]
  double heading = 0.0;        ///< the strongest tile's [rad]
  std::vector<RowTile> tiles;  ///< strongest first
};

/// The lattice of the greenness; nothing where there are no rows. `field` has cells well below the
/// least spacing, see coarseGreen.
std::optional<RowLattice> findRowLattice(const CoarseGreen& field, const RowOptions& options);

}  // namespace agricolmap::crop
