// Reading clouds that are lines of text, without a header that says what they are.
#pragma once

#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {

/// Reads a cloud as xyzColumns says. Throws InputError.
Cloud readXyz(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap::io
