// Crop facts as a picture that a farmer can read.
#pragma once

#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/report/facts/facts_layers.hpp"

namespace agricolmap::report {

/// The field from above with its rows, plants, gaps and weeds, a piece of it large, and the figures
/// that are asked first: plants per square metre, gaps, cover, height, weeds. `frame`: of the view
/// that the facts are from. Throws UsageError where pictures are not built in.
void writeFactsPicture(const io::OutputPath& path, const GridFrame& frame,
                       const PlacedFacts& placed);

}  // namespace agricolmap::report
