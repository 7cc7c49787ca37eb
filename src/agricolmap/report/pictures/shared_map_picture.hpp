// What a shared map shows: the field in colour, how tall its plants are, and whose cells are whose.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/fuse/shared_map.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::report {

/// Draws colours and plant heights of the whole field, strips outlined, and beneath a place on a
/// strip's border in the strips' own cells. `points`: of the
/// strips. `name`: of the map. Throws OutputError, and UsageError
/// in a build that cannot draw.
void writeSharedMapPicture(const io::OutputPath& path, const fuse::SharedMap& map,
                           const std::vector<const PointStream*>& points, const std::string& name);

}  // namespace agricolmap::report
