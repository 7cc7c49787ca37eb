// Things on a map, and what is known of them, small enough to be carried inside a page.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::report {

/// Which of too many things are kept.
struct Thinning {
  std::size_t most = 0;
  /// Of the number by which the largest are kept; empty: one of so many, in their order.
  std::string largest = {};
};

/// The layer as columns, each of them base64 of little-endian whole numbers in steps of what its
/// field's decimals say; web/packed.js reads it. Coordinates are those of the file less `origin`,
/// in millimetres unless the field is wider than 65 m; lines lose what bends less than a
/// centimetre. `count` things of `of` are kept.
nlohmann::ordered_json packedLayer(const io::VectorLayer& layer, const Eigen::Vector2d& origin,
                                   const Thinning& thinning);

}  // namespace agricolmap::report
