// The pieces of which a drone's map is put together: where each lies a little off its place.
#pragma once

#include <Eigen/Core>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap::simulate {

/// One piece: what it shows is off its place by `shift + shear · (place − centre)`.
struct MosaicPiece {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< field frame [m]
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();   ///< [m]
  Eigen::Matrix2d shear = Eigen::Matrix2d::Zero();
  Eigen::Vector2d doubled = Eigen::Vector2d::Zero();  ///< from one image to the other; 0: one [m]
  float blur = 0.0F;                                  ///< share of the mosaic's further blur
  float exposure = 1.0F;                              ///< factor on its light

  Eigen::Vector2d displacement(const Eigen::Vector2d& place) const {
    return shift + shear * (place - centre);
  }
};

class MosaicPieces {
 public:
  /// Pieces of a field of this size [m]; its corner is the zero of places.
  MosaicPieces(const MosaicOptions& options, const Eigen::Vector2d& field_size, std::uint64_t seed);

  /// Whether pieces differ in anything.
  bool any() const { return !pieces_.empty(); }
  /// The piece whose centre is nearest. There must be any; beyond the field its outermost go on.
  const MosaicPiece& at(const Eigen::Vector2d& place) const;
  /// How far the map shows off its place what lies there [m].
  Eigen::Vector2d displacement(const Eigen::Vector2d& place) const {
    return any() ? at(place).displacement(place) : Eigen::Vector2d::Zero();
  }

 private:
  double side_;
  Raster<MosaicPiece> pieces_;  ///< one in each square of this side, from one beyond the corner
};

}  // namespace agricolmap::simulate
