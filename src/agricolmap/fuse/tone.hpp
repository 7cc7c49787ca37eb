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

/// A factor per channel: what exposure and white balance differ by.
struct Tone {
  std::array<float, 3> gain{1.0F, 1.0F, 1.0F};

  Rgb operator()(Rgb colour) const;
};

/// Brings a strip's colours to those of the fixed map, by the cells that both call soil, and those
/// that both call plants; `same_day` false: by the soil alone, as plants change. Where the maps do
/// not tell plants from soil, by all cells that both show. Factors from 1/2 to 2.
Tone toneOf(const StripCells& strip, const Greenness& own, const map::GridMap& fixed,
            const Greenness& target, bool same_day);

}  // namespace agricolmap::fuse
