#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/change/distribution.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/page/change_page.hpp"
#include "agricolmap/report/page/scene_pictures.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastHeight = 0.05;  // of the scale [m]

/// What the bytes of the picture `change` stand for: red −reach…reach, green 0…reach.
struct Reach {
  double change;
  std::uint8_t redOf(double value) const { return byte(0.5 * (1.0 + value / change)); }
  std::uint8_t greenOf(double level) const { return byte(level / change); }

 private:
  static std::uint8_t byte(double share) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
  }
};

/// Red: the change, mean of the cells whose change is significant where most of those compared are,
/// else of all; green: their mean level of detection; blue: 255 where most are significant.
std::string changePng(const ChangeGround& ground, int factor, const Reach& reach) {
  const change::HeightChange& heights = ground.heights;
  return layerPng(ground.frame, factor, 4, [&](const PixelCells& cells, std::uint8_t* out) {
    double sum = 0.0, level = 0.0, count = 0.0, sure_sum = 0.0, sure = 0.0;
    for (int r = cells.row; r < cells.row + cells.rows; ++r) {
      for (int c = cells.col; c < cells.col + cells.cols; ++c) {
        const auto change = static_cast<double>(heights.change(r, c));
        if (std::isnan(change)) continue;
        count += 1.0;
        sum += change;
        level += static_cast<double>(heights.detection(r, c));
        if (heights.significant(r, c) <= 0.0F) continue;
        sure += 1.0;
        sure_sum += change;
      }
    }
    if (count == 0.0) return;
    const bool mostly = 2.0 * sure >= count;
    out[0] = reach.redOf(mostly ? sure_sum / sure : sum / count);
    out[1] = reach.greenOf(level / count);
    out[2] = mostly ? 255 : 0;
    out[3] = 255;
  });
}

/// How a surface looks in light from the north-west: 0…1.
Raster<float> reliefOf(const Raster<float>& surface, double cell) {
  Raster<float> relief(surface.rows(), surface.cols(), std::numeric_limits<float>::quiet_NaN());
  const Eigen::Vector3d light = Eigen::Vector3d(-1.0, 1.0, 1.4).normalized();
  for (int r = 0; r + 1 < surface.rows(); ++r) {
    for (int c = 0; c + 1 < surface.cols(); ++c) {
      const auto east = static_cast<double>(surface(r, c + 1) - surface(r, c)) / cell;
      const auto north = static_cast<double>(surface(r + 1, c) - surface(r, c)) / cell;
      const Eigen::Vector3d normal = Eigen::Vector3d(-east, -north, 1.0).normalized();
      relief(r, c) = static_cast<float>(std::max(0.0, normal.dot(light)));  // NaN stays one
      if (std::isnan(east) || std::isnan(north)) {
        relief(r, c) = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  return relief;
}

/// Both on one scale.
std::pair<ValueLayer, ValueLayer> timesUpTo(const char* before, const char* after,
                                            const LayerTimes& layer, double least) {
  ValueLayer first = upTo(before, layer.before, 0.0, least);
  ValueLayer second = upTo(after, layer.after, 0.0, least);
  first.high = second.high = std::max(first.high, second.high);
  return {first, second};
}

/// What is drawn of numbers, beside the change itself.
std::vector<ValueLayer> valueLayers(const ChangeGround& ground, const LayerTimes& relief,
                                    const Raster<float>& plants, const Raster<float>& cover) {
  std::vector<ValueLayer> layers;
  const auto add = [&](std::initializer_list<ValueLayer> more) {
    for (const ValueLayer& layer : more) layers.push_back(layer);
  };
  if (ground.plant_height.known()) {
    const auto [before, after] =
        timesUpTo("before_plant_height", "after_plant_height", ground.plant_height, kLeastHeight);
    const double reach = change::reachOf(plants);
    add({before, after, {"plant_height_change", plants, -reach, reach}});
  }
  if (ground.cover.known()) {
    add({{"before_cover", ground.cover.before, 0.0, 1.0},
         {"after_cover", ground.cover.after, 0.0, 1.0},
         {"cover_change", cover, -1.0, 1.0}});
  }
  if (relief.known()) {
    add({{"before_relief", relief.before, 0.0, 1.0}, {"after_relief", relief.after, 0.0, 1.0}});
  }
  return layers;
}

Raster<float> differenceOf(const LayerTimes& layer) {
  if (!layer.known()) return {};
  Raster<float> difference(layer.before.rows(), layer.before.cols());
  for (std::size_t i = 0; i < difference.size(); ++i) {
    difference[i] = layer.after[i] - layer.before[i];
  }
  return difference;
}

Json colourPicture(const char* name, const ColourMap& map, double most_pixels) {
  const int factor = cellsPerPixel(map.frame, most_pixels);
  Json picture = pictureJson(map.frame, factor);
  picture["layers"][name] = coloursPng(map.frame, factor, map.colour,
                                       [&](std::size_t cell) { return map.known[cell] != 0; });
  return picture;
}

}  // namespace

void addChangePictures(Json& scene, const ChangeGround& ground) {
  const bool coloured = !ground.colour_before.colour.empty() && !ground.colour_after.colour.empty();
  LayerTimes relief;
  if (!coloured && ground.surface.known()) {
    relief = {reliefOf(ground.surface.before, ground.frame.cell),
              reliefOf(ground.surface.after, ground.frame.cell)};
  }
  const Raster<float> plants = differenceOf(ground.plant_height);
  const Raster<float> cover = differenceOf(ground.cover);
  const std::vector<ValueLayer> values = valueLayers(ground, relief, plants, cover);
  const Reach reach{change::reachOf(ground.heights.change)};
  scene["maps"] = picturesWithin(pictureBytesBeside(scene), [&](double most_pixels) {
    const int factor = cellsPerPixel(ground.frame, most_pixels);
    const bool heights = ground.surface.known();
    std::vector<std::string> encoded(values.size() + (heights ? 1 : 0));
    parallelFor(encoded.size(), [&](std::size_t i) {
      encoded[i] = i < values.size() ? valuesPng(ground.frame, factor, values[i])
                                     : changePng(ground, factor, reach);
    });
    Json picture = pictureJson(ground.frame, factor);
    Json scales = Json::object();
    if (heights) {
      picture["layers"]["change"] = encoded.back();
      scales["change"] = {-reach.change, reach.change};
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      picture["layers"][values[i].name] = encoded[i];
      scales[values[i].name] = {values[i].low, values[i].high};
    }
    Json maps = {{"fixed", Json::array({picture})}, {"scales", scales}};
    if (coloured) {
      std::vector<Json> colours(2);
      parallelFor(2, [&](std::size_t i) {
        colours[i] = i == 0 ? colourPicture("before_colour", ground.colour_before, most_pixels)
                            : colourPicture("after_colour", ground.colour_after, most_pixels);
      });
      for (Json& colour : colours) maps["fixed"].push_back(std::move(colour));
    }
    return maps;
  });
}

}  // namespace agricolmap::report
