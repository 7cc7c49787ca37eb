#include "agricolmap/report/page/facts_page.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "agricolmap/report/page/packed_layer.hpp"
#include "agricolmap/report/page/page.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPlants = 120'000;  // 20 bytes of page each
constexpr std::size_t kMostMarks = 20'000;    // of gaps, of weeds, ...
constexpr std::size_t kMostParts = 12'000;    // squares; more are a raster and no table

Thinning thinningOf(const io::VectorLayer& layer) {
  if (layer.name == "plants") return {kMostPlants, {}};
  if (layer.name == "grid") return {layer.features.size() > kMostParts ? 0 : kMostParts, {}};
  if (layer.name == "weeds") return {kMostMarks, "area_m2"};
  return {kMostMarks, "length_m"};
}

/// Each line of `words` as a paragraph, for where scripts do not run.
std::string paragraphs(std::string_view words) {
  std::string html;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find('\n'), words.size());
    html += "<p>" + htmlText(words.substr(0, end)) + "</p>";
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return html;
}

}  // namespace

Json factsScene(const std::vector<io::VectorLayer>& layers, const Eigen::Vector2d& origin) {
  Json packed = Json::object();
  for (const io::VectorLayer& layer : layers) {
    packed[layer.name] = packedLayer(layer, origin, thinningOf(layer));
  }
  return {{"layers", std::move(packed)}, {"origin_m", {origin.x(), origin.y()}}};
}

std::string factsPage(Json facts_json, Json scene, const std::string& words,
                      const FactsPageInfo& info) {
  PageContent content;
  const std::string source = facts_json.at("source").get<std::string>();
  content.report = std::move(facts_json);
  content.facts = {
      {"map_page", info.map_page}, {"command_line", info.command_line}, {"version", info.version}};
  content.scene = std::move(scene);
  return pageOf(content, "what stands on " + source, paragraphs(words));
}

}  // namespace agricolmap::report
