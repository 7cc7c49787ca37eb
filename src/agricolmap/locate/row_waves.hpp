// What rows give away before anything is searched: a wave in one map must be a wave in the other,
// which leaves a curve of headings and scales out of the whole space.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/locate/hypotheses.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::locate {

/// A periodic pattern of a map: rows, or plants along them.
struct Wave {
  Eigen::Vector2d vector = Eigen::Vector2d::Zero();  ///< across the crests [1/m], sign arbitrary
  double strength = 0.0;                             ///< power over the mean at its wavelength
};

/// The strongest peaks of the spectrum of the greenness (or of the height where `options` leave
/// greenness out), strongest first, at most `most`, of at least `min_strength`. Only
/// wavelengths between four cells and the high-pass of `options` count, and of a large map only its
/// middle: rows are the same elsewhere.
std::vector<Wave> strongestWaves(const map::GridMap& map, const map::SignalOptions& options,
                                 int most, double min_strength);

/// How far a carried wave may be from the other map's, relative to its length.
struct WaveTolerance {
  double along = 0.0;   ///< wavelength
  double across = 0.0;  ///< direction [rad]
};

/// Those of `hypotheses` that carry one of the moving map's waves to one of the fixed map's, either
/// way round.
std::vector<Hypothesis> alongWaves(const std::vector<Hypothesis>& hypotheses,
                                   const std::vector<Wave>& moving, const std::vector<Wave>& fixed,
                                   const SearchSpace& space, const WaveTolerance& tolerance);

}  // namespace agricolmap::locate
