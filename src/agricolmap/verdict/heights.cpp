#include "agricolmap/verdict/heights.hpp"

#include <fmt/format.h>

#include <cmath>

namespace agricolmap::verdict {
namespace {

/// With less of the lowest cells being ground it is said that none is seen.
constexpr double kLeastGround = 0.3;

}  // namespace

const char* toString(HeightsStatus status) {
  return status == HeightsStatus::kMeasured ? "measured" : "limited";
}

const char* toString(HeightsLimit limit) {
  switch (limit) {
    case HeightsLimit::kFlat:
      return "flat";
    case HeightsLimit::kNoGround:
      return "no_ground";
    case HeightsLimit::kCanopy:
      return "canopy";
    case HeightsLimit::kUneven:
      return "uneven";
    case HeightsLimit::kNone:
      break;
  }
  return "none";
}

HeightsVerdict judgeHeights(const refine::VerticalResult& heights,
                            const UncertaintyOptions& options) {
  HeightsVerdict verdict;
  if (!heights.relief) {
    verdict.limit = HeightsLimit::kFlat;
    return verdict;
  }
  verdict.bias = options.height_inflation * heights.bias();
  verdict.deviation =
      std::hypot(options.height_floor, options.height_inflation * heights.deviation());
  if (verdict.deviation <= kMostHeightDeviation) {
    verdict.status = HeightsStatus::kMeasured;
  } else if (heights.bias() < heights.residual) {
    verdict.limit = HeightsLimit::kUneven;
  } else {
    verdict.limit =
        heights.ground_seen < kLeastGround ? HeightsLimit::kNoGround : HeightsLimit::kCanopy;
  }
  return verdict;
}

std::string describe(const HeightsVerdict& verdict) {
  std::string deviation = fmt::format("heights may be off by {:.0f} cm", 100.0 * verdict.deviation);
  switch (verdict.limit) {
    case HeightsLimit::kFlat:
      return "a cloud has none";
    case HeightsLimit::kNoGround:
      return "no ground is seen under the plants, " + deviation;
    case HeightsLimit::kCanopy:
      return "ground is seen through few gaps, " + deviation;
    case HeightsLimit::kUneven:
      return "the grounds of the two maps do not fit one another, " + deviation;
    case HeightsLimit::kNone:
      break;
  }
  return deviation;
}

}  // namespace agricolmap::verdict
