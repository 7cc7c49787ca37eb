// The two grid maps as pictures that the page lays over one another.
#pragma once

#include <nlohmann/json.hpp>

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::report {

/// Whether the clouds had colours of their own.
struct PageColours {
  bool fixed = false;
  bool moving = false;
};

/// The fixed map as a whole and, where that is coarser than its cells, its part about the strip;
/// the moving map and, where a bend is followed, that without it. Each with its layers as PNG, its
/// frame and `local_from_image`, from metres right and up of its lower left corner to the fixed
/// cloud's local coordinates: the moving ones as the guess lays them (`before`), as the
/// registration does (`after`) and at the other places of an ambiguous one. Null in a build without
/// pictures.
nlohmann::ordered_json pageMaps(const pipeline::Registration& registration, const CloudFacts& fixed,
                                const Cloud& moving, const PageColours& coloured);

}  // namespace agricolmap::report
