// A prescription as a picture: which square gets what, and of what layer that was made.
#pragma once

#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/report/prescription/prescription_words.hpp"

namespace agricolmap::report {

struct PrescriptionScene {
  const PlacedPlan& placed;
  Eigen::Affine2d place_from_file;  ///< prescribe::placeFromFile
  const GridFrame& frame;           ///< of the layer, in file coordinates
  const Raster<float>& values;
};

/// Throws UsageError where pictures are not built in.
void writePrescriptionPicture(const io::OutputPath& path, const PrescriptionScene& scene);

}  // namespace agricolmap::report
