#include <algorithm>
#include <string>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/page/scene_pictures.hpp"
#include "agricolmap/report/page/shared_map_page.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostPixels = 700'000.0;  // of one picture

/// The code of the source in the middle of each pixel; those beyond a byte share the last.
std::string sourcesPng(const fuse::Layers& layers, int factor) {
  return layerPng(layers.frame, factor, 2, [&](const PixelCells& cells, std::uint8_t* out) {
    const std::uint16_t code =
        layers.source(cells.row + cells.rows / 2, cells.col + cells.cols / 2);
    if (code == fuse::kNoSource) return;
    out[0] = static_cast<std::uint8_t>(std::min<int>(code, 255));
    out[1] = 255;
  });
}

}  // namespace

Json sharedMapScene(const fuse::SharedMap& map) {
  const fuse::Layers& layers = map.layers;
  const GridFrame& frame = layers.frame;
  const int factor = cellsPerPixel(frame, kMostPixels);
  constexpr double kGreen = 0.4, kLeastHeight = 0.05, kLeastError = 0.01;
  std::vector<ValueLayer> values = {{"exg", layers.exg, 0.0, kGreen},
                                    upTo("plane_error", layers.plane_error, 0.0, kLeastError)};
  if (!map.flat) {
    values.push_back(upTo("plant_height", layers.plant_height, 0.0, kLeastHeight));
    values.push_back(upTo("height_error", layers.height_error, 0.0, kLeastError));
  }
  std::vector<std::string> encoded(values.size() + 2);
  parallelFor(encoded.size(), [&](std::size_t i) {
    if (i == 0) {
      encoded[i] = coloursPng(frame, factor, layers.colour, [&](std::size_t cell) {
        return layers.source[cell] != fuse::kNoSource;
      });
    } else if (i == 1) {
      encoded[i] = sourcesPng(layers, factor);
    } else {
      encoded[i] = valuesPng(frame, factor, values[i - 2]);
    }
  });
  Json picture = pictureJson(frame, factor);
  picture["layers"] = {{"colour", encoded[0]}, {"source", encoded[1]}};
  Json scales;
  for (std::size_t i = 0; i < values.size(); ++i) {
    picture["layers"][values[i].name] = encoded[i + 2];
    scales[values[i].name] = {values[i].low, values[i].high};
  }
  return {{"maps", {{"fixed", Json::array({picture})}, {"scales", scales}}}};
}

}  // namespace agricolmap::report
