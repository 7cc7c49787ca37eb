// change.html: what changed between two maps, before and after side by side.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "agricolmap/change/comparison.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"
#include "agricolmap/report/page/scene_colours.hpp"

namespace agricolmap::report {

using change::LayerTimes;

/// What the page shows; all must outlive the call.
struct ChangeGround {
  GridFrame frame;  ///< of all rasters, about `origin` [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  const change::HeightChange& heights;
  const LayerTimes& surface;       ///< [m]; without it nothing of heights is shown
  const LayerTimes& plant_height;  ///< [m]
  const LayerTimes& cover;
  const ColourMap& colour_before;  ///< in frames of their own about the same origin
  const ColourMap& colour_after;
};

/// What single parts changed by, and how many cells by how much. `zones`: layers `plots` and `grid`
/// of what was asked for, if any, in file coordinates; without `grid`, or of more squares than a
/// page can draw, squares of the page's own stand for it.
nlohmann::ordered_json changeScene(const ChangeGround& ground,
                                   const std::vector<io::VectorLayer>& zones = {});

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
