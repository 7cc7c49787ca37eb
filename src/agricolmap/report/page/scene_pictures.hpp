// Rasters as pictures that a page lays on its map and colours itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::report {

/// A layer of numbers, and what its bytes 0…255 stand for. The values must outlive it.
struct ValueLayer {
  const char* name;
  const Raster<float>& values;
  double low = 0.0;
  double high = 1.0;
};

/// From `low` to what hardly a cell surpasses, at least to `least`.
ValueLayer upTo(const char* name, const Raster<float>& values, double low, double least);

/// The cells that one pixel shows.
struct PixelCells {
  int row, col, rows, cols;
};

/// Cells along the side of a pixel, so that the whole frame has at most `most_pixels`.
int cellsPerPixel(const GridFrame& frame, double most_pixels);

/// Size and place of such a picture, without its layers: metres right and up of its lower left
/// corner lie at `local_from_image` of the frame.
nlohmann::ordered_json pictureJson(const GridFrame& frame, int factor);

/// Calls `write(cells, out)` for every pixel, northernmost row first; PNG, base64. `channels`: 2
/// for grey and alpha, 4 for colours and alpha; `out` is zero before.
std::string layerPng(const GridFrame& frame, int factor, int channels,
                     const std::function<void(const PixelCells&, std::uint8_t*)>& write);

/// Means of the cells that have a value; transparent where none has.
std::string valuesPng(const GridFrame& frame, int factor, const ValueLayer& layer);

/// Means of the cells whose index is `known`.
std::string coloursPng(const GridFrame& frame, int factor, const Raster<Rgb>& colour,
                       const std::function<bool(std::size_t)>& known);

/// Of a page's pictures beside a scene without them, so that both together are less than 8 MB.
std::size_t pictureBytesBeside(const nlohmann::ordered_json& scene);

/// What `draw` makes with so many pixels in each picture, fewer where all would have more than
/// `most_bytes`.
nlohmann::ordered_json picturesWithin(
    std::size_t most_bytes, const std::function<nlohmann::ordered_json(double most_pixels)>& draw);

}  // namespace agricolmap::report
