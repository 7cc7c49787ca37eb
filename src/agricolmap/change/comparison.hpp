// All that two maps on one grid say of what changed: surface, plants, cover; of the whole and by
// parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/change/height_change.hpp"
#include "agricolmap/change/totals.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::change {

/// Limits of what a caller may ask for.
inline constexpr double kMostError = 100.0;    ///< of a map's or the frames' errors [m]
inline constexpr double kLeastSquare = 0.1;    ///< side of squares to compare in [m]
inline constexpr double kMostSquare = 1000.0;  ///< likewise

/// A layer of both maps on the grid of the change; empty where one has none.
struct LayerTimes {
  Raster<float> before;
  Raster<float> after;
  bool known() const { return !before.empty() && !after.empty(); }
};

/// One map on the common grid.
struct MapLayers {
  MapHeights heights;  ///< see noHeights
  /// Nothing where the map has no such layer.
  std::optional<Raster<float>> plant_height = std::nullopt;  ///< [m]
  std::optional<Raster<float>> cover = std::nullopt;         ///< share that is vegetation
};

/// Those of a map without any: no cell has a surface.
MapHeights noHeights(const GridFrame& grid);

/// Of a layer that both maps have beside the surface.
struct LayerChange {
  LayerTimes times;
  Raster<float> change;  ///< b − a, NaN where one has none
  /// 1 where both maps have plants on more than half of the cell, which alone have heights;
  /// nothing: the layer is of all cells, or nobody says where plants are.
  std::optional<Raster<std::uint8_t>> among = std::nullopt;
  std::size_t cells = 0;  ///< that count
  double before = 0.0;    ///< median of heights [m], mean of covers
  double after = 0.0;

  /// Whether a cell is among those that the two values, and those of parts, are of.
  bool counts(std::size_t cell) const;
};

struct Comparison {
  double cell = 0.0;  ///< [m]
  FrameError frames;
  bool flat = false;  ///< a map has no heights: nothing of them below, covers alone
  MapHeights before;  ///< what the change was told from
  MapHeights after;
  HeightChange heights;
  Totals totals;
  std::optional<LayerChange> plant_height;
  std::optional<LayerChange> cover;

  /// Of which both maps know what is compared: the surface, of flat ones the cover.
  std::size_t comparedCells() const;
};

/// `flat`: one of the maps has no heights.
Comparison compareMaps(MapLayers a, MapLayers b, double cell, const FrameError& frames, bool flat);

/// Where bare ground, which should not have moved, did so by more than is expected: what to say of
/// it. Empty: it did not, or nobody knows where the ground is bare.
std::string bareGroundWarning(const Totals& totals);

/// Of a layer within a part of the field; NaN where nothing of it is known both times.
struct PartLayer {
  std::size_t cells = 0;
  double before = 0.0;  ///< median of heights [m], mean of covers
  double after = 0.0;
};

/// A part of the field, as a plot.
struct PartChange {
  double area = 0.0;   ///< compared [m²]
  ZoneChange heights;  ///< without cells of flat maps
  PartLayer plant_height;
  PartLayer cover;

  /// What a mean must exceed to be more than errors that all of the part has in common [m].
  double level() const { return kLevel95 * heights.compared.meanDeviation(); }
  bool moreThanErrors() const;
};

/// `zones` has a number below `count` per cell, or −1.
std::vector<PartChange> partChanges(const Comparison& compared, const Raster<std::int32_t>& zones,
                                    std::size_t count);

}  // namespace agricolmap::change
