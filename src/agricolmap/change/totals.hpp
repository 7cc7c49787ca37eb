// What a change amounts to over a field: areas, volumes with intervals that hold, and a check.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "agricolmap/change/height_change.hpp"

namespace agricolmap::change {

/// Of a set of cells.
struct Share {
  std::size_t cells = 0;
  double area = 0.0;       ///< [m²]
  double volume = 0.0;     ///< of the change: mean times area [m³]
  double deviation = 0.0;  ///< of the volume; see totalsOf [m³]
  /// Of the change [m]; 0 where there are no cells.
  double median = 0.0;
  double mean() const { return area > 0.0 ? volume / area : 0.0; }
  double meanDeviation() const { return area > 0.0 ? deviation / area : 0.0; }
};

struct Totals {
  Share compared;                 ///< all cells with a level of detection
  Share rise;                     ///< significant, up
  Share fall;                     ///< significant, down
  double median_detection = 0.0;  ///< [m]
  /// Cells that should not have changed; nothing where nobody can tell which.
  std::optional<Share> stable;
};

/// Deviations of volumes take what is expected of a cell to be one error of all cells of its source
/// in its map: a strip laid 1 cm too high is so everywhere, and no number of cells makes that
/// smaller. Sources, and the two maps, err apart. Of what displaces a source in the plane counts
/// the sum of its slopes: what is shifted leaves here and arrives there. `stable`: 1 where no
/// change is expected, or nullptr.
Totals totalsOf(const HeightChange& change, const MapHeights& a, const MapHeights& b, double cell,
                const FrameError& frames, const Raster<std::uint8_t>* stable);

/// Of a part of the field, as a plot.
struct ZoneChange {
  Share compared;
  Share rise;  ///< significant cells, up
  Share fall;  ///< and down
};

/// The same by parts: `zones` has a number below `count` per cell, or −1.
std::vector<ZoneChange> zoneChanges(const HeightChange& change, const MapHeights& a,
                                    const MapHeights& b, double cell, const FrameError& frames,
                                    const Raster<std::int32_t>& zones, std::size_t count);

/// Where there is next to no vegetation in either map: 1 where both covers are below 0.1.
Raster<std::uint8_t> bareGround(const Raster<float>& cover_a, const Raster<float>& cover_b);

}  // namespace agricolmap::change
