// Colours of one source beside those of another: what is plant in each, and what brings a strip's
// colours to the fixed cloud's.
#pragma once

#include <array>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/vegetation.hpp"

namespace agricolmap::fuse {

struct StripCells;

/// What a source's Excess Green says of plants, by its own histogram.
struct Greenness {
  map::VegetationThreshold found;

  /// Share of a cell that is plant, 0…1; NaN where the source's colours cannot tell.
  float cover(float exg) const;
};
Greenness greennessOf(const map::GridMap& map);

/// A line per channel, and one for Excess Green.
struct Tone {
  std::array<float, 3> gain{1.0F, 1.0F, 1.0F};
  std::array<float, 3> offset{};
  float exg_gain = 1.0F;
  float exg_offset = 0.0F;

  Rgb operator()(Rgb colour) const;
  float exg(float own) const { return own * exg_gain + exg_offset; }
};

/// Brings a strip's colours to those of the fixed map: soil to soil and plants to plants, by their
/// means over the cells that both show; gains near 1 where the two hardly differ. Where a map does
/// not tell plants from soil, brightness alone.
Tone toneOf(const StripCells& strip, const Greenness& own, const map::GridMap& fixed,
            const Greenness& target);

}  // namespace agricolmap::fuse
