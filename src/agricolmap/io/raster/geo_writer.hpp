// Layers of a map as Cloud-Optimised GeoTIFFs, which GIS programs and web viewers read a part and a
// scale at a time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// How a layer's smaller copies, which are shown from afar, come from it.
enum class Overviews {
  kAverage,  ///< of what a cell has: heights, shares, colours
  kNearest,  ///< one of the values, as codes and dates need
};

/// Of one band; the raster must outlive the writing, which does not copy it. Colours make three
/// bands.
using GeoValues =
    std::variant<const Raster<float>*, const Raster<std::uint8_t>*, const Raster<std::uint16_t>*,
                 const Raster<std::int32_t>*, const Raster<Rgb>*>;

struct GeoBand {
  GeoValues values;
  std::string name;  ///< shown by GIS programs; colours are called red, green, blue
  std::string unit;  ///< as "m"; empty where there is none
};

/// A file of one layer: bands of one type over one grid.
struct GeoLayer {
  GridFrame frame;                                   ///< corner in file coordinates less `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m]
  std::string crs;                                   ///< WKT; empty where nobody said
  std::vector<GeoBand> bands;
  /// Added to every value on writing, floats only: heights less the origin's become the file's.
  double add = 0.0;
  std::optional<double> nodata;                ///< NaN for floats
  const Raster<std::uint8_t>* mask = nullptr;  ///< 0 where the layer has nothing, instead of nodata
  Overviews overviews = Overviews::kAverage;
  std::map<std::string, std::string> metadata;  ///< of the file, as "AGRICOLMAP_LAYER"
};

/// Writes tiles of 512 × 512 cells, deflated, north up, with overviews; to a path of StagedOutput,
/// as a failure leaves nothing usable. Throws OutputError when the file cannot be written whole,
/// Interrupted, and UsageError for bands of different types or sizes, a coordinate system that
/// cannot be understood, and in builds without GDAL.
void writeLayer(const OutputPath& path, const GeoLayer& layer);

}  // namespace agricolmap::io
