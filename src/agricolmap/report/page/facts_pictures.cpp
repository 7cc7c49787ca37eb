#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/page/facts_page.hpp"
#include "agricolmap/report/page/scene_pictures.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastHeight = 0.05;   // of the scale [m]
constexpr double kShareOfValues = 0.5;  // of the pixels: people look at colours

}  // namespace

void addFactsPictures(Json& scene, const FactsGround& ground) {
  const bool tall = !ground.height.empty();
  const bool coloured = !ground.colours.colour.empty();
  const ValueLayer green{"green", ground.green, 0.0, 1.0};
  const ValueLayer height =
      upTo("plant_height", tall ? ground.height : ground.green, 0.0, kLeastHeight);
  scene["maps"] = picturesWithin(pictureBytesBeside(scene), [&](double most_pixels) {
    const int factor = cellsPerPixel(ground.frame, kShareOfValues * most_pixels);
    const int colour_factor = cellsPerPixel(ground.colours.frame, most_pixels);
    std::vector<std::string> encoded(3);
    parallelFor(encoded.size(), [&](std::size_t i) {
      if (i == 0 && coloured) {
        encoded[i] = coloursPng(ground.colours.frame, colour_factor, ground.colours.colour,
                                [&](std::size_t cell) { return ground.colours.known[cell] != 0; });
      } else if (i == 1) {
        encoded[i] = valuesPng(ground.frame, factor, green);
      } else if (i == 2 && tall) {
        encoded[i] = valuesPng(ground.frame, factor, height);
      }
    });
    Json values = pictureJson(ground.frame, factor);
    values["layers"] = {{"green", encoded[1]}};
    Json scales = {{"green", {green.low, green.high}}};
    if (tall) {
      values["layers"]["plant_height"] = encoded[2];
      scales["plant_height"] = {height.low, height.high};
    }
    Json maps = {{"fixed", Json::array({values})}, {"scales", scales}};
    if (coloured) {
      Json colours = pictureJson(ground.colours.frame, colour_factor);
      colours["layers"] = {{"colour", encoded[0]}};
      maps["fixed"].push_back(std::move(colours));
    }
    return maps;
  });
}

}  // namespace agricolmap::report
