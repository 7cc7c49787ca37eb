// Reading PLY; use `readCloud`.
#pragma once

#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {

Cloud readPly(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap::io
