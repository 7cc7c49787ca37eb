// Text from outside (file names) as valid UTF-8, which both JSON and cairo insist on.
#pragma once

#include <string>
#include <string_view>

namespace agricolmap::report {

/// `text` with every byte that is no part of well-formed UTF-8 replaced by U+FFFD.
std::string validUtf8(std::string_view text);

}  // namespace agricolmap::report
