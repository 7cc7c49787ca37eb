// Reading clouds that are lines of text, without a header that says what they are; use `readCloud`
// or `streamCloud`.
#pragma once

#include <string>

#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

/// As xyzColumns says. Throws InputError.
PointFile openXyz(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap::io
