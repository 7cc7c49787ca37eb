// What `agricolmap info` says of a shared map.
#pragma once

#include <filesystem>

namespace agricolmap {

/// To stdout. Throws InputError when the folder is no shared map.
void printMapInfo(const std::filesystem::path& folder);

}  // namespace agricolmap
