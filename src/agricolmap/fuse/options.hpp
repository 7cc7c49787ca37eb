// How a shared map is made.
#pragma once

#include "agricolmap/core/options.hpp"

namespace agricolmap::fuse {

struct FuseOptions {
  double cell = 0.0;  ///< of the layers [m]; 0: what the fixed cloud fills
  /// A cell that a strip has seen has at least this share of the points that are usual in it.
  double least_seen = 0.2;
  double seam = 0.5;            ///< over how far the fixed cloud is led to a strip's heights [m]
  bool match_colours = true;    ///< strips' colours brought to the fixed cloud's
  bool correct_heights = true;  ///< of the fixed cloud over plants, as strips show them
  bool adjust = true;           ///< strips that overlap, to each other
};
void listOptions(OptionTable& table, FuseOptions& options);

}  // namespace agricolmap::fuse
