// Reading LAS 1.0 to 1.5 of all point formats, LAZ and COPC; use `readCloud` or `streamCloud`.
#pragma once

#include <string>

#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

/// Points that are marked as withheld are left out and counted. Colours whose channels are all zero
/// are none. A bounding box that is wrong is not minded.
PointFile openLas(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap::io
