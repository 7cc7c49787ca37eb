// Reading point clouds: PLY (ascii, binary of either byte order), PCD 0.5 to 0.7 (ascii, binary,
// binary_compressed), LAS 1.0 to 1.5 with LAZ and COPC, and lines of text, told apart by content.
//
// Coordinates x, y, z may have any numeric type. Colours are `red green blue`, `r g b` or
// `diffuse_red …` in PLY, also packed `rgb`/`rgba` in PCD; 8 bit, 16 bit (÷257) or float 0–1, as
// nearly all colours of the file tell. Other properties, lists and elements are skipped. The
// VIEWPOINT of PCD is told, not applied: coordinates are taken as stored, as PCL's own filters do.
#pragma once

#include <filesystem>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/read_options.hpp"

namespace agricolmap::io {

/// Reads a cloud; points in file order. `origin` is the first point that is one of the cloud's,
/// rounded to whole metres; see assembleCloud. What floats lose against the file's doubles grows
/// with the distance to it: 0.06 µm at 1 m, 4 µm at 100 m, 30 µm at 1 km. Points with a NaN or an
/// infinity, and those more than 20 km from the others, are left out, counted and warned of: (0, 0,
/// 0), say, that exporters write for points that they do not have. So are points that LAS marks as
/// withheld, those at one height far below all others, and those with odd colours. A file without
/// colours gives an empty `rgb`. Nothing is allocated on the header's word alone. Throws InputError
/// naming file, place and reason when the file is not what its header says.
Cloud readCloud(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace agricolmap::io
