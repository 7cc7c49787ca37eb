// change.png: where a field rose and fell between two maps.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/change/height_change.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::report {

struct ChangeScene {
  const change::HeightChange& change;
  GridFrame frame;                 ///< of the change
  std::string subtitle;            ///< which maps
  std::vector<std::string> facts;  ///< lines beside the map
  /// What changed, in hundredths.
  std::string quantity = "change of the surface [cm]";
  bool levels = true;  ///< whether what is no more than its errors is told apart
};

/// Brown fell, green-blue rose (ColorBrewer's BrBG, which the colour-blind tell apart); hatched is
/// what was compared and differs by no more than its errors, white what could not be compared.
/// Throws OutputError; UsageError without Cairo.
void writeChangePicture(const io::OutputPath& path, const ChangeScene& scene);

}  // namespace agricolmap::report
