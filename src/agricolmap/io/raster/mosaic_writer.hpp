// One layer made of files that stay where they are (GDAL's VRT): of a whole field coarse, with
// finer pieces on top.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// A file that covers cells [row, row + rows) × [col, col + cols) of a mosaic, south to north.
struct MosaicPiece {
  std::string file;  ///< beside the mosaic, or relative to its folder
  int band = 1;      ///< its first, for colours
  int row = 0;
  int col = 0;
  int rows = 0;
  int cols = 0;
  int cells = 1;  ///< of the mosaic along a cell of the file
};

struct Mosaic {
  GridFrame frame;                                   ///< corner in file coordinates less `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m]
  std::string crs;                                   ///< WKT; empty where nobody said
  std::string name;                                  ///< of its band
  std::string unit;                                  ///< as "m"; empty where there is none
  /// Red, green and blue with a mask, instead of one band of floats whose NaN are nothing.
  bool colour = false;
  std::vector<MosaicPiece> pieces;  ///< later ones lie on earlier ones
};

/// Writes a mosaic, each cell of a piece as it is. The files need not be there yet. Throws
/// OutputError, UsageError for a coordinate system that cannot be understood, and in builds without
/// GDAL.
void writeMosaic(const OutputPath& path, const Mosaic& mosaic);

}  // namespace agricolmap::io
