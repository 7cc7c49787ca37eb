// What changed, by plots of a trial and by squares: tables of `agricolmap diff`.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/io/vector/vector_layer.hpp"
#include "change_files.hpp"

namespace agricolmap {

/// What the change is asked for.
struct ZonesAsked {
  std::string plots;  ///< file of polygons; empty: none
  double grid = 0.0;  ///< side of squares on round coordinates [m]; 0: none
};

/// Layers `plots` and `grid`, those that are asked for: a feature for each plot, and for each
/// square that both maps know something of. Throws InputError for plots that cannot be read and
/// when the maps know nothing of any of them.
std::vector<io::VectorLayer> changeByZones(const ZonesAsked& asked, const MapChange& found);

/// `change.gpkg` with all layers, and each as a table: `plots.csv`, `grid.csv`. Throws OutputError.
void writeZones(const io::OutputPath& dir, const std::vector<io::VectorLayer>& layers,
                const std::string& crs);

}  // namespace agricolmap
