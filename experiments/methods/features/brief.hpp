// BRIEF (Calonder, Lepetit, Strecha & Fua, ECCV 2010), which Debian's OpenCV does not have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "agricolmap/core/raster.hpp"

namespace agricolmap::experiments {

struct BriefOptions {
  int patch = 33;      ///< S, side of the patch [pixels]; article
  double sigma = 2.0;  ///< of the Gaussian that smooths the picture [pixels]; article
  int kernel = 9;      ///< its side [pixels]; article
  int seed = 1;        ///< of the test places; the article draws them at random, too
};

/// BRIEF-32: 256 comparisons of two smoothed pixels around a keypoint. The places are drawn from an
/// isotropic normal of variance S²/25 (the article's "G II", its best), the same for every picture.
class Brief {
 public:
  static constexpr std::size_t kBytes = 32;
  explicit Brief(const BriefOptions& options = {});
  /// Around (row, col) of a picture smoothed by `smoothed`; pixels outside it are those of its rim.
  std::array<std::uint8_t, kBytes> describe(const Raster<std::uint8_t>& smooth, int row,
                                            int col) const;
  /// The picture under the Gaussian.
  Raster<std::uint8_t> smoothed(const Raster<std::uint8_t>& picture) const;

 private:
  struct Test {
    int row_a, col_a, row_b, col_b;
  };
  BriefOptions options_;
  std::array<Test, 8 * kBytes> tests_{};
};

}  // namespace agricolmap::experiments
