#include "agricolmap/config/json.hpp"

#include <algorithm>
#include <string>

#include "agricolmap/config/text.hpp"

namespace agricolmap::config {

nlohmann::ordered_json toJson(const OptionTable& table) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const OptionField& field : table.fields()) {
    std::string pointer = "/" + field.path;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    nlohmann::ordered_json& value = json[nlohmann::ordered_json::json_pointer(pointer)];
    if (const auto* number = std::get_if<double*>(&field.value)) {
      value = **number;
    } else if (const auto* integer = std::get_if<int*>(&field.value)) {
      value = **integer;
    } else if (const auto* flag = std::get_if<bool*>(&field.value)) {
      value = **flag;
    } else {
      value = optionText(field);
    }
  }
  return json;
}

}  // namespace agricolmap::config
