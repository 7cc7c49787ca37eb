// Reading PCD; use `readCloud`.
#pragma once

#include <string>

#include "agricolmap/io/cloud_reader.hpp"
#include "agricolmap/io/mapped_file.hpp"

namespace agricolmap {

Cloud readPcd(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap
