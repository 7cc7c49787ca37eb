#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/report/draw/png_file.hpp"
#include "agricolmap/report/page/page_text.hpp"
#include "agricolmap/report/page/shared_map_page.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostPixels = 700'000.0;  // of one picture
constexpr std::size_t kSamples = 100'000;  // enough for percentiles

/// A layer of numbers, and what its bytes 0…255 stand for.
struct Values {
  const char* name;
  const Raster<float>& values;
  double low = 0.0;
  double high = 1.0;
};

/// From `low` to what hardly a cell surpasses.
Values upTo(const char* name, const Raster<float>& values, double low, double least) {
  std::vector<float> some;
  const std::size_t step = std::max<std::size_t>(1, values.size() / kSamples);
  for (std::size_t i = 0; i < values.size(); i += step) {
    if (!std::isnan(values[i])) some.push_back(values[i]);
  }
  return {name, values, low, some.empty() ? least : std::max<double>(least, quantile(some, 0.98))};
}

/// The cells that one pixel shows.
struct Square {
  int row, col, rows, cols;
};

/// Calls `write(square, out)` for every pixel, northernmost row first; PNG, base64.
std::string layerPng(const GridFrame& frame, int factor, int channels,
                     const std::function<void(const Square&, std::uint8_t*)>& write) {
  const int rows = (frame.rows + factor - 1) / factor;
  const int cols = (frame.cols + factor - 1) / factor;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) *
                                  static_cast<std::size_t>(channels));
  std::uint8_t* out = bytes.data();
  for (int r = rows - 1; r >= 0; --r) {
    for (int c = 0; c < cols; ++c, out += channels) {
      const int row = r * factor, col = c * factor;
      write({row, col, std::min(factor, frame.rows - row), std::min(factor, frame.cols - col)},
            out);
    }
  }
  return base64(encodePng(bytes, cols, rows, channels));
}

std::string valuesPng(const GridFrame& frame, int factor, const Values& layer) {
  return layerPng(frame, factor, 2, [&](const Square& square, std::uint8_t* out) {
    double sum = 0.0, count = 0.0;
    for (int r = square.row; r < square.row + square.rows; ++r) {
      for (int c = square.col; c < square.col + square.cols; ++c) {
        if (std::isnan(layer.values(r, c))) continue;
        sum += static_cast<double>(layer.values(r, c));
        count += 1.0;
      }
    }
    if (count == 0.0) return;
    const double share = (sum / count - layer.low) / (layer.high - layer.low);
    out[0] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
    out[1] = 255;
  });
}

std::string coloursPng(const fuse::Layers& layers, int factor) {
  return layerPng(layers.frame, factor, 4, [&](const Square& square, std::uint8_t* out) {
    int red = 0, green = 0, blue = 0, count = 0;
    for (int r = square.row; r < square.row + square.rows; ++r) {
      for (int c = square.col; c < square.col + square.cols; ++c) {
        if (layers.source(r, c) == fuse::kNoSource) continue;
        const Rgb colour = layers.colour(r, c);
        red += colour.r;
        green += colour.g;
        blue += colour.b;
        ++count;
      }
    }
    if (count == 0) return;
    out[0] = static_cast<std::uint8_t>(red / count);
    out[1] = static_cast<std::uint8_t>(green / count);
    out[2] = static_cast<std::uint8_t>(blue / count);
    out[3] = 255;
  });
}

/// The code of the source in the middle of each pixel; those beyond a byte share the last.
std::string sourcesPng(const fuse::Layers& layers, int factor) {
  return layerPng(layers.frame, factor, 2, [&](const Square& square, std::uint8_t* out) {
    const std::uint16_t code =
        layers.source(square.row + square.rows / 2, square.col + square.cols / 2);
    if (code == fuse::kNoSource) return;
    out[0] = static_cast<std::uint8_t>(std::min<int>(code, 255));
    out[1] = 255;
  });
}

}  // namespace

Json sharedMapScene(const fuse::SharedMap& map) {
  const fuse::Layers& layers = map.layers;
  const GridFrame& frame = layers.frame;
  const int factor = std::max(1, static_cast<int>(std::ceil(std::sqrt(
                                     static_cast<double>(frame.rows) * frame.cols / kMostPixels))));
  constexpr double kGreen = 0.4, kLeastHeight = 0.05, kLeastError = 0.01;
  std::vector<Values> values = {{"exg", layers.exg, 0.0, kGreen},
                                upTo("plane_error", layers.plane_error, 0.0, kLeastError)};
  if (!map.flat) {
    values.push_back(upTo("plant_height", layers.plant_height, 0.0, kLeastHeight));
    values.push_back(upTo("height_error", layers.height_error, 0.0, kLeastError));
  }
  std::vector<std::string> encoded(values.size() + 2);
  parallelFor(encoded.size(), [&](std::size_t i) {
    if (i == 0) {
      encoded[i] = coloursPng(layers, factor);
    } else if (i == 1) {
      encoded[i] = sourcesPng(layers, factor);
    } else {
      encoded[i] = valuesPng(frame, factor, values[i - 2]);
    }
  });
  Json picture = {{"cols", (frame.cols + factor - 1) / factor},
                  {"rows", (frame.rows + factor - 1) / factor},
                  {"pixel_m", factor * frame.cell},
                  {"local_from_image", {1.0, 0.0, 0.0, 1.0, frame.corner.x(), frame.corner.y()}}};
  picture["layers"] = {{"colour", encoded[0]}, {"source", encoded[1]}};
  Json scales;
  for (std::size_t i = 0; i < values.size(); ++i) {
    picture["layers"][values[i].name] = encoded[i + 2];
    scales[values[i].name] = {values[i].low, values[i].high};
  }
  return {{"maps", {{"fixed", Json::array({picture})}, {"scales", scales}}}};
}

}  // namespace agricolmap::report
