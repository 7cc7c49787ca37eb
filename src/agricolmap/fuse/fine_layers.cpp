#include "agricolmap/fuse/fine_layers.hpp"

#include <limits>

namespace agricolmap::fuse {

FineLayers fineLayers(const SharedMap& map, std::size_t number, const map::GridMap& own,
                      bool match_colours) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const FusedStrip& strip = map.strips[number];
  const Tone tone = match_colours ? strip.tone : Tone{};
  const bool heights = !map.flat && !strip.flat;
  FineLayers fine;
  for (Raster<float>* raster :
       {&fine.surface, &fine.ground, &fine.plant_height, &fine.exg, &fine.cover, &fine.density}) {
    *raster = Raster<float>(own.frame.rows, own.frame.cols, kNone);
  }
  fine.colour = Raster<Rgb>(own.frame.rows, own.frame.cols);
  fine.mask = Raster<std::uint8_t>(own.frame.rows, own.frame.cols);
  const auto area = static_cast<float>(own.frame.cell * own.frame.cell);
  for (int r = 0; r < own.frame.rows; ++r) {
    for (int c = 0; c < own.frame.cols; ++c) {
      const std::size_t i = own.weight.index(r, c);
      const int row = strip.cells.row + r / map.lattice.factor;
      const int col = strip.cells.col + c / map.lattice.factor;
      if (!own.valid(i) || map.layers.source(row, col) != strip.code) continue;
      if (heights) {
        fine.surface[i] = own.height[i];
        fine.ground[i] = map.layers.ground(row, col);
        fine.plant_height[i] = own.height[i] - map.layers.ground(row, col);
      }
      fine.cover[i] = strip.greenness.cover(own.exg[i]);
      fine.density[i] = own.weight[i] / area;
      fine.colour[i] = tone(own.colour[i]);
      fine.exg[i] =
          match_colours ? map::excessGreen(fine.colour[i], map::ExgKind::kChromatic) : own.exg[i];
      fine.mask[i] = 255;
    }
  }
  return fine;
}

}  // namespace agricolmap::fuse
