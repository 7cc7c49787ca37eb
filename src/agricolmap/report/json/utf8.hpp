// Text from outside (file names) as valid UTF-8: cairo draws nothing any more after other bytes.
#pragma once

#include <string>
#include <string_view>

namespace agricolmap::report {

/// `text` with U+FFFD for what is not well-formed UTF-8.
std::string validUtf8(std::string_view text);

}  // namespace agricolmap::report
