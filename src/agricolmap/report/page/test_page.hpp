// What tests read from pages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace agricolmap::testing {

/// What is between the tags of the data element `id`, read back.
inline nlohmann::json dataOf(const std::string& page, const std::string& id) {
  const std::string begin = "id=\"data-" + id + "\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

}  // namespace agricolmap::testing
