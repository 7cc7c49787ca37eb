// Text as it stands in an attribute or an element of XML.
#pragma once

#include <string>
#include <string_view>

namespace agricolmap {

/// With the letters escaped that mean something there, and a space for control characters, which
/// XML 1.0 has no way to write.
std::string xmlText(std::string_view text);

}  // namespace agricolmap
