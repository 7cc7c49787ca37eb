// What `agricolmap diff` writes.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/change/totals.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "change_maps.hpp"

namespace agricolmap {

/// Of another layer that both maps have.
struct LayerChange {
  Raster<float> change;  ///< b − a, NaN where one has none
  /// What the two values are of: all that both maps have, for heights only where both have plants
  /// on more than half of the cell, if they say where plants are.
  std::size_t cells = 0;
  double before = 0.0;  ///< median of heights [m], mean of covers
  double after = 0.0;
};

/// Everything that was found between two maps.
struct MapChange {
  std::string name_a;
  std::string name_b;
  CommonGround ground;
  change::FrameError frames;
  change::HeightChange heights;
  change::Totals totals;
  std::optional<LayerChange> plant_height;
  std::optional<LayerChange> cover;
};

/// Names of all files that a run may write.
inline const std::vector<std::string> kChangeFiles = {"height_change.tif",
                                                      "plant_height_change.tif", "cover_change.tif",
                                                      "change.json", "change.png"};

nlohmann::ordered_json toJson(const MapChange& found);
/// One of the totals in words.
struct ChangeLine {
  std::string label;
  std::string text;
};
std::vector<ChangeLine> describe(const MapChange& found);
/// Into the folder `dir`. Throws OutputError.
void writeChange(const io::OutputPath& dir, const MapChange& found, bool picture);

}  // namespace agricolmap
