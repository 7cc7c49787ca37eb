// Reading PCD; use `readCloud`.
#pragma once

#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {

Cloud readPcd(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap::io
