// Dense Fast Point Feature Histograms (Rusu, Blodow & Beetz, ICRA 2009) of a height raster.
#pragma once

#include <cstdint>

#include "agricolmap/core/options.hpp"
#include "agricolmap/paper/describe/masked_raster.hpp"

namespace agricolmap::paper {

struct DescriptorMap;

/// Layout: 11 bins of α, 11 of φ, 11 of θ, the angles of the Darboux frame.
inline constexpr int kFpfhBins = 11;
inline constexpr int kFpfhSize = 3 * kFpfhBins;

struct FpfhOptions {
  double radius = 5.0;  ///< of the neighbourhood [cells of the level]
  /// Of the heights. A grid map's slopes are so gentle that true angles nearly all fall into the
  /// middle bins, where plants look like ground; it spreads them over the bins.
  double exaggeration = 8.0;
};
void listOptions(OptionTable& table, FpfhOptions& options);

/// Bytes per unit of a histogram; the bins of each angle sum to 1.
inline constexpr float kFpfhScale = 255.0F;

/// Fills the FPFH bytes and bit of `out`, which has the raster's size. The surface is a grid of
/// side `cell` [m], so neighbours are fixed offsets and normals are height gradients; empty cells
/// have no part. Heights enter only through differences.
void computeFpfh(const MaskedRaster& height, double cell, const FpfhOptions& options,
                 DescriptorMap& out);

}  // namespace agricolmap::paper
