#include "agricolmap/report/page/scene_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/report/draw/png_file.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {
namespace {

constexpr std::size_t kSamples = 100'000;  // enough for percentiles

constexpr double kMostPixels = 2'000'000.0;  // of one picture
constexpr double kLeastPixels = 50'000.0;
constexpr std::size_t kPageBytes = 7'400'000;   // the page's own sources are the rest
constexpr std::size_t kLeastBytes = 2'000'000;  // of the pictures

/// Bytes of all layers of the pictures in `maps.fixed`.
std::size_t bytesOf(const nlohmann::ordered_json& maps) {
  std::size_t bytes = 0;
  for (const auto& picture : maps.at("fixed")) {
    for (const auto& layer : picture.at("layers"))
      bytes += layer.get_ref<const std::string&>().size();
  }
  return bytes;
}

int pixels(int cells, int factor) { return (cells + factor - 1) / factor; }

}  // namespace

ValueLayer upTo(const char* name, const Raster<float>& values, double low, double least) {
  std::vector<float> some;
  const std::size_t step = std::max<std::size_t>(1, values.size() / kSamples);
  for (std::size_t i = 0; i < values.size(); i += step) {
    if (!std::isnan(values[i])) some.push_back(values[i]);
  }
  return {name, values, low, some.empty() ? least : std::max<double>(least, quantile(some, 0.98))};
}

int cellsPerPixel(const GridFrame& frame, double most_pixels) {
  const double cells = static_cast<double>(frame.rows) * frame.cols;
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(cells / most_pixels))));
}

nlohmann::ordered_json pictureJson(const GridFrame& frame, int factor) {
  // The last row of pixels may reach beyond the frame: the picture's lower left corner is the
  // frame's.
  return {{"cols", pixels(frame.cols, factor)},
          {"rows", pixels(frame.rows, factor)},
          {"pixel_m", factor * frame.cell},
          {"local_from_image", {1.0, 0.0, 0.0, 1.0, frame.corner.x(), frame.corner.y()}}};
}

std::string layerPng(const GridFrame& frame, int factor, int channels,
                     const std::function<void(const PixelCells&, std::uint8_t*)>& write) {
  const int rows = pixels(frame.rows, factor);
  const int cols = pixels(frame.cols, factor);
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

std::string valuesPng(const GridFrame& frame, int factor, const ValueLayer& layer) {
  return layerPng(frame, factor, 2, [&](const PixelCells& cells, std::uint8_t* out) {
    double sum = 0.0, count = 0.0;
    for (int r = cells.row; r < cells.row + cells.rows; ++r) {
      for (int c = cells.col; c < cells.col + cells.cols; ++c) {
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

std::string coloursPng(const GridFrame& frame, int factor, const Raster<Rgb>& colour,
                       const std::function<bool(std::size_t)>& known) {
  return layerPng(frame, factor, 4, [&](const PixelCells& cells, std::uint8_t* out) {
    int red = 0, green = 0, blue = 0, count = 0;
    for (int r = cells.row; r < cells.row + cells.rows; ++r) {
      for (int c = cells.col; c < cells.col + cells.cols; ++c) {
        const std::size_t i = colour.index(r, c);
        if (!known(i)) continue;
        red += colour[i].r;
        green += colour[i].g;
        blue += colour[i].b;
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

std::size_t pictureBytesBeside(const nlohmann::ordered_json& scene) {
  return kPageBytes - std::min(scene.dump().size(), kPageBytes - kLeastBytes);
}

nlohmann::ordered_json picturesWithin(
    std::size_t most_bytes, const std::function<nlohmann::ordered_json(double most_pixels)>& draw) {
  double most_pixels = kMostPixels;
  while (true) {
    nlohmann::ordered_json maps = draw(most_pixels);
    const double excess = static_cast<double>(bytesOf(maps)) / static_cast<double>(most_bytes);
    if (excess <= 1.0 || most_pixels <= kLeastPixels) return maps;
    // Pixels have whole numbers of cells: that makes up for a little less compression.
    most_pixels /= 1.05 * excess;
  }
}

}  // namespace agricolmap::report
