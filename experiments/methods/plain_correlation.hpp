// Normalised correlation of a small map with a large one at all shifts, by FFT.
#pragma once

#include <Eigen/Core>

#include "agricolmap/correlation/fft.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::experiments {

class PlainCorrelation {
 public:
  /// `most_rows`, `most_cols`: of the pieces to come. `least_energy`: of the fixed map under a
  /// piece, in its mean; keeps off the rim.
  PlainCorrelation(const map::SignalMap& fixed, int most_rows, int most_cols, double least_energy);

  /// A piece of the moving map at the fixed map's cell size; element (r, c) stands at the row and
  /// column first_row + r, first_col + c from its anchor.
  struct Piece {
    int first_row = 0;
    int first_col = 0;
    Raster<float> value;  ///< 0 where unseen
    Raster<float> seen;   ///< 1 or 0
  };
  /// Where a piece fits best.
  struct Peak {
    double score = 0.0;  ///< correlation times the root of the piece's cells
    double correlation = 0.0;
    Eigen::Vector2d anchor = Eigen::Vector2d::Zero();  ///< levelled fixed frame [m]
  };
  /// The best shift with the anchor within `reach` [m] of `centre`.
  Peak best(const Piece& piece, const Eigen::Vector2d& centre, double reach) const;

 private:
  correlation::ComplexRaster spectrumOf(const Raster<float>& values, int first_row,
                                        int first_col) const;

  GridFrame frame_;
  correlation::Fft2 fft_;
  correlation::ComplexRaster fixed_;    ///< spectrum of the signal
  correlation::ComplexRaster squared_;  ///< and of its square
  double floor_;                        ///< least energy per cell
};

}  // namespace agricolmap::experiments
