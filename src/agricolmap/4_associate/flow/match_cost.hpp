// How unlike two cells are: the paper's Eq. 2.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "agricolmap/3_describe/descriptor_map.hpp"

namespace agricolmap {

struct CostOptions {
  double alpha = 1.0;  ///< weight of the visual term (Tab. III)
  double beta = 0.5;   ///< weight of the geometric term (Tab. III)
};
void describe(OptionTable& table, CostOptions& options);

/// α·C_DAISY + β·C_FPFH between a cell of the fixed and one of the moving map. Each C is a sum of
/// absolute differences divided by that of unrelated cells (about; kUnrelated… per component), so
/// that 1 means "nothing in common" in both and the weights compare like with like. Only sample
/// points known in the moving map count: its strip is narrower than the descriptor.
class MatchCost {
 public:
  static constexpr float kImpossible = 1e9F;

  MatchCost(const DescriptorMap& fixed, const DescriptorMap& moving, const CostOptions& options);

  /// True when the moving cell has enough known surroundings to be matched.
  bool usable(std::size_t moving_cell) const;
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

}  // namespace agricolmap
