#include "agricolmap/report/page/page.hpp"

#include <string_view>

#include "agricolmap/report/page/page_assets.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {

std::string pageOf(const PageContent& content, const std::string& title,
                   const std::string& plain_words) {
  const bool in_space = content.scene.contains("points") && !content.scene["points"].is_null();
  return filledTemplate(pageTemplate(),
                        {{"title", htmlText(title)},
                         {"style", std::string(pageStyle())},
                         {"plain words", plain_words},
                         {"report", scriptJson(content.report)},
                         {"facts", scriptJson(content.facts)},
                         {"scene", scriptJson(content.scene)},
                         {"script 3d", std::string(in_space ? pageScript3d() : std::string_view())},
                         {"script", std::string(pageScript())}});
}

}  // namespace agricolmap::report
