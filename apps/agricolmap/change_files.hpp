// What `agricolmap diff` writes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/change/comparison.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"
#include "agricolmap/report/page/change_page.hpp"
#include "change_maps.hpp"

namespace agricolmap {

/// Everything that was found between two maps.
struct MapChange {
  std::string name_a;
  std::string name_b;
  CommonGround ground;
  change::Comparison compared;
  change::LayerTimes surface;       ///< without rasters of flat maps
  report::ColourMap colour_before;  ///< without rasters unless it is asked for
  report::ColourMap colour_after;
  std::vector<io::VectorLayer> zones;  ///< see changeByZones
};

/// Names of all files that a run may write.
inline const std::vector<std::string> kChangeFiles = {"height_change.tif",
                                                      "plant_height_change.tif",
                                                      "cover_change.tif",
                                                      "height_change.qml",
                                                      "plant_height_change.qml",
                                                      "cover_change.qml",
                                                      "change.json",
                                                      "change.png",
                                                      "change.html",
                                                      "change.gpkg",
                                                      "plots.csv",
                                                      "grid.csv"};

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
