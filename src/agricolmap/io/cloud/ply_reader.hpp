// Reading PLY; use `readCloud` or `streamCloud`.
#pragma once

#include <string>

#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

PointFile openPly(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap::io
