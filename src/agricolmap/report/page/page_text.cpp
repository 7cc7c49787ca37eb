#include "agricolmap/report/page/page_text.hpp"

#include <algorithm>
#include <stdexcept>

#include "agricolmap/report/json/utf8.hpp"

namespace agricolmap::report {

using Json = nlohmann::ordered_json;

std::string htmlText(std::string_view text) {
  std::string out;
  for (const char c : validUtf8(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string scriptJson(const nlohmann::ordered_json& json) {
  // Outside its strings JSON has no `<`.
  std::string out;
  using Handler = Json::error_handler_t;
  for (const char c : json.dump(-1, ' ', false, Handler::replace)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = (word << 8) | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? kDigits[(word >> (18 - 6 * k)) & 63U] : '=';
    }
  }
  return out;
}

std::string filledTemplate(std::string_view text,
                           const std::vector<std::pair<std::string, std::string>>& parts) {
  std::vector<std::pair<std::size_t, const std::pair<std::string, std::string>*>> places;
  for (const auto& part : parts) {
    const std::size_t at = text.find("<!-- " + part.first + " -->");
    if (at == std::string_view::npos) {
      throw std::logic_error("the page has no place for " + part.first);
    }
    places.emplace_back(at, &part);
  }
  std::sort(places.begin(), places.end());
  std::string out;
  std::size_t from = 0;
  for (const auto& [at, part] : places) {
    out += text.substr(from, at - from);
    out += part->second;
    from = at + part->first.size() + std::string_view("<!--  -->").size();
  }
  out += text.substr(from);
  return out;
}

}  // namespace agricolmap::report
