#include "agricolmap/report/page/change_page.hpp"

#include <utility>

#include "agricolmap/change/distribution.hpp"
#include "agricolmap/report/page/change_squares.hpp"
#include "agricolmap/report/page/packed_layer.hpp"
#include "agricolmap/report/page/page.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kBins = 48;
constexpr std::size_t kMostParts = 12'000;  // that a browser draws at once

Json distributionJson(const change::Distribution& cells) {
  Json sure = Json::array(), unsure = Json::array();
  for (const change::Distribution::Bin& bin : cells.bins) {
    sure.push_back(bin.sure);
    unsure.push_back(bin.unsure);
  }
  return {{"reach_m", cells.reach}, {"sure", std::move(sure)}, {"unsure", std::move(unsure)}};
}

}  // namespace

Json changeScene(const ChangeGround& ground, const std::vector<io::VectorLayer>& zones) {
  Json layers = Json::object();
  const auto add = [&](const io::VectorLayer& layer) {
    layers[layer.name] = packedLayer(layer, ground.origin, {layer.features.size(), {}});
  };
  bool squares = false;
  for (const io::VectorLayer& layer : zones) {
    if (layer.features.size() > kMostParts) continue;
    add(layer);
    squares = squares || layer.name == "grid";
  }
  if (!squares) add(changeSquares(ground));
  Json scene = {{"layers", std::move(layers)},
                {"origin_m", {ground.origin.x(), ground.origin.y()}}};
  if (ground.surface.known()) {
    scene["cells"] = distributionJson(change::distributionOf(ground.heights, kBins));
  }
  return scene;
}

std::string changePage(Json change_json, Json scene, const ChangePageInfo& info) {
  PageContent content;
  content.report = std::move(change_json);
  Json facts = Json::array();
  std::string words;
  for (const ChangeFact& fact : info.facts) {
    facts.push_back({fact.label, fact.text});
    words += "<p>" + htmlText(fact.label + ": " + fact.text) + "</p>";
  }
  content.facts = {{"facts", std::move(facts)},         {"warnings", info.warnings},
                   {"map_before", info.map_before},     {"map_after", info.map_after},
                   {"command_line", info.command_line}, {"version", info.version}};
  content.scene = std::move(scene);
  return pageOf(content, "what changed between two maps", words);
}

}  // namespace agricolmap::report
