// What `agricolmap diff` writes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/change/totals.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/report/page/change_page.hpp"
#include "change_maps.hpp"

namespace agricolmap {

/// Of another layer that both maps have.
struct LayerChange {
  report::LayerTimes times;
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
  report::LayerTimes surface;
  report::ColourMap colour_before;  ///< without rasters unless it is asked for
  report::ColourMap colour_after;
  std::optional<LayerChange> plant_height;
  std::optional<LayerChange> cover;
};

/// Names of all files that a run may write.
inline const std::vector<std::string> kChangeFiles = {
    "height_change.tif", "plant_height_change.tif", "cover_change.tif", "change.json", "change.png",
    "change.html"};

nlohmann::ordered_json toJson(const MapChange& found);
/// The totals in words.
std::vector<report::ChangeFact> describe(const MapChange& found);
/// What is not in the change itself.
struct ChangeRun {
  bool pictures = true;
  std::filesystem::path folder;  ///< where the results will be
  std::vector<std::string> warnings;
  std::vector<std::string> command_line;
};
/// Into the folder `dir`. Throws OutputError.
void writeChange(const io::OutputPath& dir, const MapChange& found, const ChangeRun& run);

}  // namespace agricolmap
