// Whether the heights of a registration are as good as its place: a verdict of their own. A strip
// may lie on its plants to the centimetre in the plane while no ground is seen that would tell how
// high; acceptance does not hang on it.
#pragma once

#include <limits>
#include <string>

#include "agricolmap/refine/vertical.hpp"
#include "agricolmap/verdict/uncertainty.hpp"

namespace agricolmap::verdict {

enum class HeightsStatus { kMeasured, kLimited };
/// "measured" or "limited".
const char* toString(HeightsStatus status);

/// Why heights are limited.
enum class HeightsLimit {
  kNone,
  kFlat,      ///< a cloud has no heights, as an orthomosaic laid flat
  kNoGround,  ///< what is lowest in the moving map is plants
  kCanopy,    ///< ground is seen in few places, or plants are blurred into it
  kUneven     ///< the grounds of the maps do not fit one another
};
/// "none", "flat", "no_ground", "canopy", "uneven".
const char* toString(HeightsLimit limit);

struct HeightsVerdict {
  HeightsStatus status = HeightsStatus::kLimited;
  HeightsLimit limit = HeightsLimit::kNone;
  /// Of the strip's mean height [m]: scatter and bias. Infinite where there are no heights.
  double deviation = std::numeric_limits<double>::infinity();
  double bias = 0.0;  ///< part of it that all of the strip has in common [m]

  bool limited() const { return status == HeightsStatus::kLimited; }
};

/// Heights whose stated deviation is larger than this [m] are limited.
inline constexpr double kMostHeightDeviation = 0.045;

HeightsVerdict judgeHeights(const refine::VerticalResult& heights,
                            const UncertaintyOptions& options);

/// Why heights are limited, in plain words; for a reason and behind a colon.
std::string describe(const HeightsVerdict& verdict);

}  // namespace agricolmap::verdict
