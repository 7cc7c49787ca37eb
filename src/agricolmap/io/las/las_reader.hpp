// Reading LAS 1.0 to 1.5 of all point formats, LAZ and COPC.
#pragma once

#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {

/// Points that are marked as withheld are left out and counted. Colours whose channels are all zero
/// are none. A bounding box that is wrong is not minded.
Cloud readLas(const MappedFile& file, const std::string& name, const ReadOptions& options);

}  // namespace agricolmap::io
