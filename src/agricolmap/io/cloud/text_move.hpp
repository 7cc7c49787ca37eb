// Points of text files of which only coordinates and normals change; all other words and the blanks
// between them stay as they are, whatever lines they stand on.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/cloud/point_mover.hpp"
#include "agricolmap/io/cloud/record_move.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {

/// What the words of an item are, in order.
struct TextItem {
  std::string name;         ///< of the items, for messages: "vertex"
  std::vector<bool> lists;  ///< by value: a count and that many words
};

/// Takes `count` items off `text` and returns them as they stand. Throws InputError naming `file`
/// when there are fewer.
std::string_view takeItems(std::string_view& text, const TextItem& item, std::size_t count,
                           const std::string& file);

/// The points of the first items.
std::vector<Eigen::Vector3d> samplesOf(std::string_view text, const TextItem& item,
                                       const PointFields& fields, std::size_t count,
                                       const std::string& file);

/// Moves the `count` items at the beginning of `text`, which are taken off it. Coordinates are
/// written to the micrometre.
MoveTally writeMoved(std::string_view& text, const TextItem& item, const PointFields& fields,
                     std::size_t count, const PointMover& mover, const std::string& file,
                     FileSink& sink, const CopyProgress& progress);

}  // namespace agricolmap::io
