// What is written into a page so that no text of the user's, a file's name or a coordinate
// system's, can end up as part of the page itself.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace agricolmap::report {

/// `text` as the content of an element or of a quoted attribute; valid UTF-8.
std::string htmlText(std::string_view text);

/// `json` as the content of a script element: no `<` is left that could end it. What is no UTF-8 in
/// it becomes U+FFFD.
std::string scriptJson(const nlohmann::ordered_json& json);

/// RFC 4648, padded.
std::string base64(std::span<const std::uint8_t> bytes);

/// `text` with each `<!-- name -->` replaced by what goes there. What is put in is not looked at
/// again. Throws std::logic_error for a name that is not in the template.
std::string filledTemplate(std::string_view text,
                           const std::vector<std::pair<std::string, std::string>>& parts);

}  // namespace agricolmap::report
