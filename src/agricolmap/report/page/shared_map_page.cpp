#include "agricolmap/report/page/shared_map_page.hpp"

#include <utility>

#include "agricolmap/report/page/page.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {

std::string sharedMapPage(const std::string& map_json, nlohmann::ordered_json scene) {
  PageContent content;
  content.report = nlohmann::ordered_json::parse(map_json);
  content.scene = std::move(scene);
  std::string words = "<p>A map of these:</p><ul>";
  for (const auto& source : content.report.at("sources")) {
    words += "<li>" + htmlText(source.at("id").get<std::string>()) + "</li>";
  }
  return pageOf(content, "map of " + content.report["sources"][0]["id"].get<std::string>(),
                words + "</ul>");
}

}  // namespace agricolmap::report
