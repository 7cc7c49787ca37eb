// Dense DAISY descriptors (Tola, Lepetit & Fua, TPAMI 2010).
#pragma once

#include <cstdint>
#include <span>

#include "agricolmap/core/options.hpp"
#include "agricolmap/paper/describe/masked_raster.hpp"

namespace agricolmap::paper {

struct DescriptorMap;

/// Layout: 16 sample points of 8 orientations, point by point: the cell itself, then three rings of
/// five points each, inner ring first, counter-clockwise from east; each odd ring is turned by half
/// a step so that the points interleave. Orientation k is the part of the gradient along 45°·k.
inline constexpr int kDaisyOrientations = 8;
inline constexpr int kDaisyRings = 3;
inline constexpr int kDaisyRingPoints = 5;
inline constexpr int kDaisyPoints = 1 + kDaisyRings * kDaisyRingPoints;
inline constexpr int kDaisySize = kDaisyOrientations * kDaisyPoints;

enum class DaisyNorm {
  kPartial,  ///< every point's histogram has unit length: blind to contrast from point to point
  kFull,     ///< the descriptor has unit length over its known points
};

struct DaisyOptions {
  double radius = 15.0;  ///< of the outer ring at the finest level [cells]
  /// Factor of that radius, in cells, from a level to the next coarser one. Were it 1, the coarse
  /// descriptors would be as wide as the strip, and look at rows, which are alike everywhere.
  double shrink = 0.7;
  DaisyNorm norm = DaisyNorm::kFull;
};
void listOptions(OptionTable& table, DaisyOptions& options);

/// Bytes per unit of a descriptor component; larger values are cut at 255. A full descriptor
/// spreads its unit length over up to 128 components, so it is stretched more.
inline constexpr float kDaisyScalePartial = 255.0F;
inline constexpr float kDaisyScaleFull = 768.0F;

/// Fills the DAISY bytes and bits of `out`, which has the channels' size. With several channels
/// (the colours) their orientation maps are added before they are normalised. Empty cells have no
/// part: gradients come from a normalised convolution, histograms are means over known cells, and
/// sample points on unknown ground are marked as such. Cells with unknown surroundings
/// are left out. Invariant to gain and bias of all channels
/// together.
void computeDaisy(std::span<const MaskedRaster> channels, const DaisyOptions& options,
                  DescriptorMap& out);

}  // namespace agricolmap::paper
