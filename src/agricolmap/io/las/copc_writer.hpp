// Writing COPC 1.0 (copc.io): LAZ of LAS 1.4 whose chunks are the nodes of an octree, so that
// viewers read what they show.
#pragma once

#include <cstdint>

#include "agricolmap/io/cloud/cloud_move.hpp"
#include "agricolmap/io/las/las_feed.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Writes all records of a feed of the point formats 6 to 8, and returns how many. Memory does not
/// grow with them: they are sorted in a temporary file in the folder of `to`, as large as they are
/// uncompressed. Throws OutputError, UsageError in a build without LASzip, and what the feed does.
std::uint64_t writeCopc(const LasFeed& feed, const OutputPath& to, const CopyProgress& progress);

}  // namespace agricolmap::io
