// The fused cloud as LAS, LAZ or COPC.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/fuse/shared_map.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::fuse {

/// How many points of each source are in the fused cloud: of the fixed one, then of the strips.
using PointCounts = std::vector<std::uint64_t>;

/// Writes the points that own their cells, point format 7 in millimetres: the source's code as
/// point source id, and as extra bytes `date` (YYYYMMDD), `plane_error`, `height_error` [m, NaN
/// where nobody knows] and `raised`: by how much the point's height was changed [m]. Marks are
/// those of the sources, or none: of one return, of no class, without intensity. COPC is sorted by
/// way of `scratch`, a file as large as the points uncompressed, which is removed. Throws
/// OutputError, and UsageError for LAZ and COPC without LASzip.
PointCounts writeFusedCloud(const io::OutputPath& path, const io::OutputPath& scratch,
                            io::CloudFormat format, const SharedMap& map, const PointStream& fixed,
                            std::int32_t fixed_date, const std::vector<StripInput>& strips,
                            const FuseOptions& options, const Crs& crs);

}  // namespace agricolmap::fuse
