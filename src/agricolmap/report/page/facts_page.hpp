// facts.html: what stands on a field, as a map whose rows, plants and gaps can be asked.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"
#include "agricolmap/report/page/scene_colours.hpp"

namespace agricolmap::report {

/// What the facts were read from, as the page shows it; all must outlive the call.
struct FactsGround {
  GridFrame frame;              ///< of both rasters, about the facts' origin [m]
  const Raster<float>& green;   ///< crop::Greenness::green
  const Raster<float>& height;  ///< above the ground [m]; empty: not known
  const ColourMap& colours;
};

/// `layers`: of factsLayers; of too many plants one of so many is kept, of too many gaps and weeds
/// the largest, of too many squares none.
nlohmann::ordered_json factsScene(const std::vector<io::VectorLayer>& layers,
                                  const Eigen::Vector2d& origin);

/// Adds the layers of the ground as pictures, see scene_pictures.hpp, as fine as a page of 8 MB has
/// room for; nothing in a build without pictures.
void addFactsPictures(nlohmann::ordered_json& scene, const FactsGround& ground);

/// What the page says beside facts.json.
struct FactsPageInfo {
  std::string map_page;  ///< the way from this page to that of its map; empty: none
  std::vector<std::string> command_line;
  std::string version;
};

/// The page of this facts.json, UTF-8.
std::string factsPage(nlohmann::ordered_json facts_json, nlohmann::ordered_json scene,
                      const std::string& words, const FactsPageInfo& info);

}  // namespace agricolmap::report
