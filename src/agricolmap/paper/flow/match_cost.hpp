// How unlike two cells are: the paper's Eq. 2.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "agricolmap/paper/describe/descriptor_map.hpp"

namespace agricolmap::paper {

struct CostOptions {
  double alpha = 1.0;  ///< weight of the visual term (Tab. III)
  double beta = 0.5;   ///< weight of the geometric term (Tab. III)
  /// Each term over its spread between unrelated cells; not in the paper, which adds plain sums.
  bool normalise = true;
};
void listOptions(OptionTable& table, CostOptions& options);

/// How much the differences of cells that have nothing to do with each other vary [bytes].
struct UnrelatedSpread {
  double daisy = 0.0;
  double fpfh = 0.0;
};

/// Standard deviations over pairs of random cells of two maps; the same for the same maps.
UnrelatedSpread unrelatedSpread(const DescriptorMap& fixed, const DescriptorMap& moving);

/// True when a cell of the moving map has enough known surroundings to be matched.
bool usable(const DescriptorMap& moving, std::size_t cell);

/// α·C_DAISY + β·C_FPFH between a cell of the fixed and one of the moving map. Only sample points
/// known in the moving map count: its strip is narrower than the descriptor.
///
/// With `normalise` each C is a mean absolute difference per byte over its spread between unrelated
/// cells of these two maps: what tells cells apart is how costs differ, not how large they are, so
/// this is the unit in which the weights compare like with like, for any crop and at any
/// resolution. Without it each C is the paper's: the sum of absolute differences over DAISY's 128
/// and FPFH's 33 dimensions, in bytes; DAISY's sum over the known points is taken for all 16. With
/// daisy.norm = partial both descriptors have as many bytes to their unit (kDaisyScalePartial,
/// kFpfhScale), so α and β weigh histograms of unit length against histograms of unit sum.
class MatchCost {
 public:
  static constexpr float kImpossible = 1e9F;

  MatchCost(const DescriptorMap& fixed, const DescriptorMap& moving, const CostOptions& options);

  /// kImpossible when the moving cell is not usable.
  float operator()(std::size_t fixed_cell, std::size_t moving_cell) const {
    return below(fixed_cell, moving_cell, std::numeric_limits<float>::infinity());
  }
  /// The cost where it is below `limit`, else anything that is not: a comparison ends as soon as
  /// its sum, which only grows, has reached the limit, and leaves the rest of the cell unread.
  float below(std::size_t fixed_cell, std::size_t moving_cell, float limit) const;

 private:
  const DescriptorMap* fixed_;
  const DescriptorMap* moving_;
  std::array<float, kDaisyPoints + 1> daisy_scale_{};  ///< by number of known points
  float fpfh_scale_ = 0.0F;
};

}  // namespace agricolmap::paper
