// Reading PLY; use `readCloud`.
#pragma once

#include <string>

#include "agricolmap/io/cloud_reader.hpp"
#include "agricolmap/io/mapped_file.hpp"

namespace agricolmap {

Cloud readPly(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap
