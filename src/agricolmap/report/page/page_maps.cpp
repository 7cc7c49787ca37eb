#include "agricolmap/report/page/page_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/draw/png_file.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPixels = 700'000;  // of one picture
constexpr double kRim = 1.5;                  // of the fixed map's part about the strip [m]
constexpr double kFar = 4.0;        // the part holds the guess's place, too, unless so much larger
constexpr double kLeastSeen = 0.2;  // share of a coarser cell
constexpr std::size_t kSamples = 20'000;  // enough for percentiles

/// What a layer's bytes 0…255 stand for.
struct Scale {
  double low = 0.0;
  double high = 1.0;
  std::uint8_t byteOf(double value) const {
    return static_cast<std::uint8_t>(
        std::lround(255.0 * std::clamp((value - low) / (high - low), 0.0, 1.0)));
  }
};

/// All but the outermost hundredths of the values of both maps.
Scale scaleOf(const std::vector<const map::GridMap*>& maps, Raster<float> map::GridMap::*layer) {
  std::vector<float> values;
  for (const map::GridMap* map : maps) {
    const std::size_t step = 1 + map->weight.size() / kSamples;
    for (std::size_t i = 0; i < map->weight.size(); i += step) {
      if (map->valid(i)) values.push_back((map->*layer)[i]);
    }
  }
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return static_cast<double>(
        values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]);
  };
  return {at(0.01), std::max(at(0.99), at(0.01) + 1e-6)};
}

/// Cells of a map that are drawn, `factor` of them as the side of one pixel.
struct Cut {
  int row = 0, col = 0;    ///< the southernmost and westernmost
  int rows = 0, cols = 0;  ///< pixels
  int factor = 1;
};

Cut cutOf(const map::GridMap& map, const map::Box2& box) {
  const GridFrame& frame = map.frame;
  const auto cellAt = [&](double place, double corner, int count) {
    return std::clamp(static_cast<int>(std::floor((place - corner) / frame.cell)), 0, count);
  };
  Cut cut;
  cut.col = cellAt(box.min().x(), frame.corner.x(), frame.cols - 1);
  cut.row = cellAt(box.min().y(), frame.corner.y(), frame.rows - 1);
  const int cols = std::max(1, cellAt(box.max().x(), frame.corner.x(), frame.cols) - cut.col);
  const int rows = std::max(1, cellAt(box.max().y(), frame.corner.y(), frame.rows) - cut.row);
  const auto pixels = static_cast<double>(kMostPixels);
  cut.factor = std::max(
      1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(cols) * rows / pixels))));
  cut.cols = (cols + cut.factor - 1) / cut.factor;
  cut.rows = (rows + cut.factor - 1) / cut.factor;
  return cut;
}

/// A pixel's values, means over its cells.
struct Pixel {
  std::array<double, 3> colour{};
  double exg = 0.0;
  double height = 0.0;
  bool seen = false;

  void add(const Pixel& other) {
    for (std::size_t k = 0; k < 3; ++k) colour[k] += other.colour[k];
    exg += other.exg;
    height += other.height;
  }
  /// The mean of `count` that were added.
  Pixel over(double count) const {
    Pixel mean = *this;
    for (double& channel : mean.colour) channel /= count;
    mean.exg /= count;
    mean.height /= count;
    mean.seen = true;
    return mean;
  }
};

Pixel pixelAt(const map::GridMap& map, const Cut& cut, int row, int col) {
  Pixel sum;
  double count = 0.0;
  double cells = 0.0;
  for (int r = cut.row + row * cut.factor; r < cut.row + (row + 1) * cut.factor; ++r) {
    for (int c = cut.col + col * cut.factor; c < cut.col + (col + 1) * cut.factor; ++c) {
      if (!map.weight.contains(r, c)) continue;
      cells += 1.0;
      if (!map.valid(r, c)) continue;
      count += 1.0;
      const Rgb colour = map.colour(r, c);
      sum.add({.colour = {static_cast<double>(colour.r), static_cast<double>(colour.g),
                          static_cast<double>(colour.b)},
               .exg = static_cast<double>(map.exg(r, c)),
               .height = static_cast<double>(map.height(r, c))});
    }
  }
  return count == 0.0 || count < kLeastSeen * cells ? Pixel() : sum.over(count);
}

/// Single pixels that nothing fell into take the mean of those around: sparse clouds make maps and
/// not speckle.
Raster<Pixel> filled(const Raster<Pixel>& pixels) {
  constexpr double kLeast = 4.0;  // seen neighbours
  Raster<Pixel> out = pixels;
  parallelFor(
      static_cast<std::size_t>(pixels.rows()),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        for (int col = 0; col < pixels.cols(); ++col) {
          if (pixels(row, col).seen) continue;
          Pixel mean;
          double count = 0.0;
          for (int k = 0; k < 9; ++k) {
            const int y = row + k / 3 - 1, x = col + k % 3 - 1;
            if (!pixels.contains(y, x) || !pixels(y, x).seen) continue;
            mean.add(pixels(y, x));
            count += 1.0;
          }
          if (count >= kLeast) out(row, col) = mean.over(count);
        }
      },
      16);
  return out;
}

struct Scales {
  Scale exg;
  std::optional<Scale> height;  ///< nothing where heights say nothing
};

/// A layer's bytes, top row first.
struct Layer {
  const char* name;
  int channels;  ///< the last is 255 where something is seen, else 0
  std::function<void(const Pixel&, std::uint8_t*)> write;
};

std::vector<Layer> layersOf(bool coloured, const Scales& scales) {
  std::vector<Layer> layers;
  if (coloured) {
    layers.push_back({"colour", 4, [](const Pixel& pixel, std::uint8_t* out) {
                        for (std::size_t k = 0; k < 3; ++k) {
                          out[k] = static_cast<std::uint8_t>(std::lround(pixel.colour[k]));
                        }
                      }});
    layers.push_back({"exg", 2, [exg = scales.exg](const Pixel& pixel, std::uint8_t* out) {
                        out[0] = exg.byteOf(pixel.exg);
                      }});
  }
  if (!scales.height) return layers;
  layers.push_back({"height", 2, [height = *scales.height](const Pixel& pixel, std::uint8_t* out) {
                      out[0] = height.byteOf(pixel.height);
                    }});
  return layers;
}

Json affineJson(const Eigen::Affine2d& affine) {
  const Eigen::Matrix2d& linear = affine.linear();
  const Eigen::Vector2d shift = affine.translation();
  return {linear(0, 0), linear(1, 0), linear(0, 1), linear(1, 1), shift.x(), shift.y()};
}

/// The layers of a cut, and where its lower left corner lies in the map's levelled frame.
struct MapPicture {
  Json json;
  Eigen::Translation2d levelled_from_image;
};

MapPicture drawn(const map::GridMap& map, const Cut& cut, bool coloured, const Scales& scales) {
  Raster<Pixel> pixels(cut.rows, cut.cols);
  parallelFor(
      static_cast<std::size_t>(cut.rows),
      [&](std::size_t r) {
        for (int c = 0; c < cut.cols; ++c) {
          pixels(static_cast<int>(r), c) = pixelAt(map, cut, static_cast<int>(r), c);
        }
      },
      16);
  pixels = filled(pixels);
  const std::vector<Layer> layers = layersOf(coloured, scales);
  std::vector<std::string> encoded(layers.size());
  parallelFor(layers.size(), [&](std::size_t i) {
    const auto channels = static_cast<std::size_t>(layers[i].channels);
    std::vector<std::uint8_t> bytes(channels * pixels.size());
    std::uint8_t* out = bytes.data();
    for (int r = cut.rows - 1; r >= 0; --r) {
      for (int c = 0; c < cut.cols; ++c, out += channels) {
        if (!pixels(r, c).seen) continue;
        layers[i].write(pixels(r, c), out);
        out[channels - 1] = 255;
      }
    }
    encoded[i] = base64(encodePng(bytes, cut.cols, cut.rows, layers[i].channels));
  });
  MapPicture picture;
  picture.json["cols"] = cut.cols;
  picture.json["rows"] = cut.rows;
  picture.json["pixel_m"] = cut.factor * map.frame.cell;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    picture.json["layers"][layers[i].name] = encoded[i];
  }
  picture.levelled_from_image =
      Eigen::Translation2d(map.frame.corner + map.frame.cell * Eigen::Vector2d(cut.col, cut.row));
  return picture;
}

map::Box2 boxOf(const map::GridMap& map) {
  return {map.frame.corner,
          map.frame.corner + map.frame.cell * Eigen::Vector2d(map.frame.cols, map.frame.rows)};
}

map::Box2 boxUnder(const map::Box2& box, const Eigen::Affine2d& pose) {
  map::Box2 moved;
  for (const auto corner :
       {map::Box2::BottomLeft, map::Box2::BottomRight, map::Box2::TopLeft, map::Box2::TopRight}) {
    moved.extend((pose * box.corner(corner)).eval());
  }
  return moved;
}

/// What of a 3-D transform between levelled frames is left in the plane.
Eigen::Affine2d planeOf(const Eigen::Affine3d& transform) {
  Eigen::Affine2d plane;
  plane.linear() = transform.linear().topLeftCorner<2, 2>();
  plane.translation() = transform.translation().head<2>();
  return plane;
}

/// The part of the fixed map about the strip, where it lies and, if that is not far, lay.
map::Box2 surroundings(const pipeline::Registration& registration) {
  const map::Box2 before = boxOf(registration.maps.moving);
  map::Box2 box = registration.placed ? boxUnder(before, registration.placed->pose) : before;
  const map::Box2 both = box.merged(before);
  if (both.volume() < kFar * box.volume()) box = both;
  box.min().array() -= kRim;
  box.max().array() += kRim;
  return box;
}

/// The corners of the strip, going round, in the metres of a picture; none where it was not placed.
Json rectangleJson(const pipeline::Registration& registration, const MapPicture& picture) {
  Json json = Json::array();
  if (!registration.placed) return json;
  const map::StripFrame& strip = registration.placed->evidence.strip;
  for (const std::size_t i : {0U, 1U, 3U, 2U}) {
    const Eigen::Vector2d corner = picture.levelled_from_image.inverse() * strip.corners()[i];
    json.push_back({corner.x(), corner.y()});
  }
  return json;
}

/// The moving map's pictures and where they are laid.
Json stripJson(const pipeline::Registration& registration, const CloudFacts& fixed,
               const Cloud& moving, bool coloured, const Scales& scales) {
  const pipeline::PairMaps& maps = registration.maps;
  const Eigen::Affine2d local_from_levelled = planeOf(maps.frames.levelled_from_fixed.inverse());
  const auto laid = [&](const MapPicture& picture, const Eigen::Affine2d& pose) {
    return affineJson(local_from_levelled * pose * picture.levelled_from_image);
  };
  const auto picture = [&](const map::GridMap& map) {
    MapPicture made = drawn(map, cutOf(map, boxOf(map)), coloured, scales);
    made.json["rectangle_m"] = rectangleJson(registration, made);
    return made;
  };
  const MapPicture found = picture(maps.moving);
  Json json;
  json["picture"] = found.json;
  json["before"] = laid(found, Eigen::Affine2d::Identity());
  if (!registration.placed) return json;
  const Eigen::Affine2d& pose = registration.placed->pose;
  json["after"] = laid(found, pose);
  if (registration.placed->followed) {
    const MapPicture bent = picture(registration.placed->followed->straight);
    json["straight"] = bent.json;
    json["after"] = laid(bent, pose);
  }
  json["others"] = Json::array();
  for (const pipeline::Alternative& other : registration.alternatives) {
    const Eigen::Affine3d levelled = maps.frames.levelled_from_fixed *
                                     Eigen::Translation3d(-fixed.origin) * other.fixed_from_moving *
                                     Eigen::Translation3d(moving.origin) *
                                     maps.frames.levelled_from_moving.inverse();
    json["others"].push_back(laid(found, planeOf(levelled)));
  }
  return json;
}

}  // namespace

Json pageMaps(const pipeline::Registration& registration, const CloudFacts& fixed,
              const Cloud& moving, const PageColours& coloured) {
  const pipeline::PairMaps& maps = registration.maps;
  if (maps.fixed.weight.empty() || maps.moving.weight.empty()) return nullptr;
  Scales fixed_scales = {scaleOf({&maps.fixed}, &map::GridMap::exg), {}};
  // A cloud laid flat has none worth looking at; without colours there is nothing else.
  if (!coloured.fixed || !coloured.moving ||
      (map::hasRelief(maps.fixed) && map::hasRelief(maps.moving))) {
    fixed_scales.height = scaleOf({&maps.fixed, &maps.moving}, &map::GridMap::height);
  }
  // Cameras differ in what they call green, so that each map has its own scale.
  const Scales moving_scales = {scaleOf({&maps.moving}, &map::GridMap::exg), fixed_scales.height};
  const Eigen::Affine2d local_from_levelled = planeOf(maps.frames.levelled_from_fixed.inverse());
  const Cut whole = cutOf(maps.fixed, boxOf(maps.fixed));
  const Cut part = cutOf(maps.fixed, surroundings(registration));
  Json json;
  json["fixed"] = Json::array();
  std::vector<Cut> cuts = {whole};
  if (part.factor < whole.factor) cuts.push_back(part);
  for (const Cut& cut : cuts) {
    MapPicture picture = drawn(maps.fixed, cut, coloured.fixed, fixed_scales);
    picture.json["local_from_image"] =
        affineJson(local_from_levelled * picture.levelled_from_image);
    json["fixed"].push_back(std::move(picture.json));
  }
  json["moving"] = stripJson(registration, fixed, moving, coloured.moving, moving_scales);
  const Scale height = fixed_scales.height.value_or(Scale());
  json["height_m"] = {height.low, height.high};
  return json;
}

}  // namespace agricolmap::report
