// Plants along rows, where they can be told apart, and the gaps between them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/crop/plant_chain.hpp"

namespace agricolmap::crop {

struct CropPlant {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< middle of what is green [m]
  double along = 0.0;                               ///< of the row [m]
  double area = 0.0;                                ///< green [m²]
  double height = 0.0;     ///< of its highest tenth above the ground [m]; NaN where not known
  double certainty = 1.0;  ///< that it is one plant, and no less than one
};

/// A place where a plant may be: what is certain is 1, else several share what one plant is.
struct PossiblePlant {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< [m]
  double probability = 0.0;
};

/// A piece of a row.
struct Stretch {
  double from = 0.0;  ///< along the row [m]
  double to = 0.0;
  double length() const { return to - from; }
};

struct RowPlants {
  std::vector<CropPlant> plants;        ///< in order along the row
  std::vector<Stretch> touching;        ///< where plants cannot be told apart
  std::vector<Stretch> gaps;            ///< from stem to stem, of 1.5 spacings and more
  std::vector<PossiblePlant> possible;  ///< over all explanations of the row
  double variance = 0.0;                ///< of the number of plants over these
};

/// The plants that the likeliest explanation of a row's pieces has, where they are and what is
/// between them.
RowPlants findPlants(const GridFrame& frame, const Raster<float>& green, const RowLine& line,
                     const RowProfile& profile, const std::vector<Piece>& pieces,
                     const Chain& chain, const StandModel& model);

inline constexpr double kGapSpacings = 1.5;

}  // namespace agricolmap::crop
