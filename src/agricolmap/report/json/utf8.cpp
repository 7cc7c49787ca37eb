#include "agricolmap/report/json/utf8.hpp"

#include <nlohmann/json.hpp>

namespace agricolmap::report {

std::string validUtf8(std::string_view text) {
  using Json = nlohmann::json;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace))
      .get<std::string>();
}

}  // namespace agricolmap::report
