// The sources of the page under web/, which CMake writes into the library (embed.cmake).
#pragma once

#include <string_view>

namespace agricolmap::report {

/// The page with places for the others, as `<!-- name -->`.
std::string_view pageTemplate();
std::string_view pageStyle();
std::string_view pageScript();
/// The 3-D view, bundled by npm; empty in a build without it.
std::string_view pageScript3d();

}  // namespace agricolmap::report
