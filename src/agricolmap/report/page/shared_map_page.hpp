// map.html: a shared map for people, its layers side by side.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "agricolmap/fuse/shared_map.hpp"

namespace agricolmap::report {

/// The layers as pictures, see page_maps.hpp, and what their colours mean; null in a build without
/// pictures.
nlohmann::ordered_json sharedMapScene(const fuse::SharedMap& map);

/// The page of a map with this map.json. `scene`: null for one without pictures.
std::string sharedMapPage(const std::string& map_json, nlohmann::ordered_json scene);

}  // namespace agricolmap::report
