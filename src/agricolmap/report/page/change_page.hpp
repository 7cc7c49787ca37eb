// change.html: what changed between two maps, before and after side by side.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "agricolmap/change/height_change.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/report/page/scene_colours.hpp"

namespace agricolmap::report {

/// A layer of both maps on the grid of the change; empty where one has none.
struct LayerTimes {
  Raster<float> before;
  Raster<float> after;
  bool known() const { return !before.empty() && !after.empty(); }
};

/// What the page shows; all must outlive the call.
struct ChangeGround {
  GridFrame frame;  ///< of all rasters, about `origin` [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  const change::HeightChange& heights;
  const LayerTimes& surface;       ///< [m]
  const LayerTimes& plant_height;  ///< [m]
  const LayerTimes& cover;
  const ColourMap& colour_before;  ///< in frames of their own about the same origin
  const ColourMap& colour_after;
};

/// What single squares changed by, and how many cells by how much.
nlohmann::ordered_json changeScene(const ChangeGround& ground);

/// Adds the layers as pictures, see scene_pictures.hpp, as fine as a page of 8 MB has room for;
/// nothing in a build without pictures. Where one of the maps has no colours, reliefs stand for
/// them.
void addChangePictures(nlohmann::ordered_json& scene, const ChangeGround& ground);

/// A label and what stands for it, of the totals in words.
struct ChangeFact {
  std::string label;
  std::string text;
};

/// What the page says beside change.json.
struct ChangePageInfo {
  std::vector<ChangeFact> facts;
  std::vector<std::string> warnings;
  std::string map_before;  ///< the way from this page to that of the map; empty: none
  std::string map_after;
  std::vector<std::string> command_line;
  std::string version;
};

/// The page of this change.json, UTF-8.
std::string changePage(nlohmann::ordered_json change_json, nlohmann::ordered_json scene,
                       const ChangePageInfo& info);

}  // namespace agricolmap::report
