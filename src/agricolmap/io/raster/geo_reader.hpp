// Layers of a map, or any raster with square cells and north up, read on their grid: unlike a
// picture's rows, southernmost first, and values as they are.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::io {

/// What a layer's file says of itself.
struct LayerShape {
  std::string name;                                  ///< the file, for messages
  GridFrame frame;                                   ///< corner in file coordinates less `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< whole metres, z is 0
  std::string crs;                                   ///< WKT; empty where the file has none
  std::vector<std::string> bands;                    ///< their names
  std::vector<std::string> units;
  std::map<std::string, std::string> metadata;
};

/// A rectangle of a layer's cells, counted from the south-west.
struct CellWindow {
  int row = 0;
  int col = 0;
  int rows = 0;
  int cols = 0;
};

template <typename T>
struct Layer {
  LayerShape shape;  ///< of the window
  std::vector<Raster<T>> bands;
  Raster<std::uint8_t> valid;  ///< 1 where the first band has data
};

/// Throws InputError when the file is no raster, is not georeferenced, lies turned or has cells
/// that are not square.
LayerShape readLayerShape(const std::filesystem::path& path);

/// All bands as they stand in the file. Floats: NaN where a band has no data. T: float,
/// std::uint8_t, std::uint16_t, std::int32_t; Rgb takes the first three bands as one. Throws
/// InputError as readLayerShape; when T cannot hold the file's values; when the window is not
/// within the layer; and for a damaged file.
template <typename T>
Layer<T> readLayer(const std::filesystem::path& path,
                   const std::optional<CellWindow>& window = std::nullopt);

}  // namespace agricolmap::io
