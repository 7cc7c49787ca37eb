// A picture of a pair of clouds in true colours, laid on each other as they truly belong.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::simulate {

/// What the picture says beside what the clouds show.
struct PairPictureInfo {
  std::string title = "A pair of clouds";
  std::string fixed_name = "UAV";   ///< the wide cloud, in labels
  std::string moving_name = "UGV";  ///< the strip, in labels
  bool same_field = true;           ///< else the map carries no outline of the strip
};

/// Writes a PNG: the whole fixed cloud from above with the outline of the moving one, the strip as
/// each of them sees it, and a square of 2 m of the same place from both. `fixed_from_moving`
/// (file coordinates) is where the moving cloud truly belongs. Both clouds need colours, z up.
/// Throws UsageError, OutputError.
void writePairPicture(const io::OutputPath& path, const Cloud& fixed, const Cloud& moving,
                      const Eigen::Affine3d& fixed_from_moving, const PairPictureInfo& info = {});

}  // namespace agricolmap::simulate
