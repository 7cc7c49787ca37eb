#include "agricolmap/report/pictures/shared_map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/draw/ramp.hpp"

namespace agricolmap::report {
namespace {

constexpr int kTitleRoom = 26;    // above a panel [px]
constexpr int kScaleRoom = 40;    // for the scale of heights
constexpr int kMostHeight = 900;  // of a panel
constexpr int kZoomHeight = 300;
constexpr double kZoom = 1.2;  // half of what the panels of a border show [m]

const Colour kBorder = hexColour(0xff9f1c);

/// The height that hardly a plant surpasses [m].
double tallest(const fuse::Layers& layers) {
  constexpr std::size_t kSample = 200000;
  constexpr double kShare = 0.98, kLeast = 0.05;
  std::vector<float> heights;
  const std::size_t step = std::max<std::size_t>(1, layers.plant_height.size() / kSample);
  for (std::size_t i = 0; i < layers.plant_height.size(); i += step) {
    const bool plant = !(layers.cover[i] < 0.5F);
    if (plant && !std::isnan(layers.plant_height[i])) heights.push_back(layers.plant_height[i]);
  }
  return heights.empty() ? kLeast : std::max<double>(kLeast, quantile(heights, kShare));
}

/// A cell's colour, or nothing.
template <typename Shade>
void paintCells(PictureCanvas& canvas, const View& view, const GridFrame& frame,
                const Shade& shade) {
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    for (int i = 0; i < view.rect.width; ++i) {
      const Eigen::Vector2d cell = frame.cellOf(view.ground({view.rect.x + i + 0.5, y + 0.5}));
      const int row = static_cast<int>(std::lround(cell.y()));
      const int col = static_cast<int>(std::lround(cell.x()));
      const bool inside = row >= 0 && col >= 0 && row < frame.rows && col < frame.cols;
      const auto pixel = inside ? shade(row, col) : std::nullopt;
      out[i] = pixel ? *pixel : lightHatch(view.rect.x + i, y);
    }
  });
  canvas.frame(view.rect, {1.0, hexColour(0x8a9099), {}});
}

void paintColours(PictureCanvas& canvas, const View& view, const fuse::Layers& layers) {
  paintCells(canvas, view, layers.frame, [&](int row, int col) -> std::optional<std::uint32_t> {
    if (layers.source(row, col) == fuse::kNoSource) return std::nullopt;
    const Rgb colour = layers.colour(row, col);
    return packPixel(colour.r, colour.g, colour.b);
  });
}

/// What the second panel shows: plant heights or, of maps without any, greenness.
struct Values {
  const Raster<float>& values;
  double low = 0.0;
  double high = 1.0;
  std::string title;
  std::string legend;
};

Values valuesOf(const fuse::SharedMap& map) {
  if (map.flat) {
    constexpr double kGreen = 0.4;
    return {map.layers.exg, 0.0, kGreen, "Greenness", "chromatic Excess Green, 0 to 0.4"};
  }
  const double most = tallest(map.layers);
  return {map.layers.plant_height, 0.0, most, "Plant height",
          fmt::format("0 to {:.2f} m above the ground; hatched: no ground seen near", most)};
}

void paintValues(PictureCanvas& canvas, const View& view, const fuse::Layers& layers,
                 const Values& shown) {
  paintCells(canvas, view, layers.frame, [&](int row, int col) -> std::optional<std::uint32_t> {
    const double value = shown.values(row, col);
    if (std::isnan(value)) return std::nullopt;
    return rampColour(kLowToHigh, (value - shown.low) / (shown.high - shown.low));
  });
}

/// Around what each strip owns; holes behind leaves are not drawn.
void drawBorders(PictureCanvas& canvas, const View& view, const fuse::SharedMap& map) {
  constexpr double kHoles = 0.2;  // [m]
  const PictureCanvas::Clip clip(canvas, view.rect);
  for (const fuse::FusedStrip& strip : map.strips) {
    const GridFrame& own = strip.cells.coarse.frame;
    const int reach = static_cast<int>(std::lround(kHoles / own.cell));
    const auto owned = [&](int row, int col) {
      return own.rows > row && own.cols > col && row >= 0 && col >= 0 &&
             map.layers.source(strip.cells.row + row, strip.cells.col + col) == strip.code;
    };
    /// Nothing of the strip lies beyond, on this side of the cell.
    const auto ends = [&](int row, int col, int down, int right) {
      for (int step = 1; step <= reach; ++step) {
        if (owned(row + step * down, col + step * right)) return false;
      }
      return true;
    };
    std::vector<Eigen::Vector2d> lines;
    const auto side = [&](int row, int col, int to_row, int to_col) {
      lines.push_back(view.pixel(own.corner + own.cell * Eigen::Vector2d(col, row)));
      lines.push_back(view.pixel(own.corner + own.cell * Eigen::Vector2d(to_col, to_row)));
    };
    for (int row = 0; row < own.rows; ++row) {
      for (int col = 0; col < own.cols; ++col) {
        if (!owned(row, col)) continue;
        if (ends(row, col, 0, -1)) side(row, col, row + 1, col);
        if (ends(row, col, 0, 1)) side(row, col + 1, row + 1, col + 1);
        if (ends(row, col, -1, 0)) side(row, col, row, col + 1);
        if (ends(row, col, 1, 0)) side(row + 1, col, row + 1, col + 1);
      }
    }
    canvas.lines(lines, {1.6, kBorder, {}});
  }
}

void drawNames(PictureCanvas& canvas, const View& view, const fuse::SharedMap& map) {
  const PictureCanvas::Clip clip(canvas, view.rect);
  for (const fuse::FusedStrip& strip : map.strips) {
    const GridFrame& own = strip.cells.coarse.frame;
    const Eigen::Vector2d at = view.pixel(own.centre(0.5 * own.rows, 0.5 * own.cols));
    for (const Eigen::Vector2d& shadow : {Eigen::Vector2d(1.0, 1.0), Eigen::Vector2d(-1.0, -1.0)}) {
      canvas.text(at + shadow, strip.id, {13.0, hexColour(0x000000, 0.8), true, Align::kCentre});
    }
    canvas.text(at, strip.id, {13.0, hexColour(0xffffff), true, Align::kCentre});
  }
}

void drawScale(PictureCanvas& canvas, const PixelRect& under, const Values& shown) {
  constexpr int kWidth = 200, kHeight = 12;
  const PixelRect bar{under.x, under.y + under.height + 10, kWidth, kHeight};
  canvas.paint(bar, [&](int, std::uint32_t* out) {
    for (int i = 0; i < bar.width; ++i) out[i] = rampColour(kLowToHigh, (i + 0.5) / bar.width);
  });
  canvas.frame(bar, {1.0, hexColour(0x8a9099), {}});
  canvas.text({bar.x + bar.width + 8.0, bar.y + 11.0}, shown.legend,
              {12.0, palette::kFaint, false, Align::kLeft});
}

/// A place on a strip's border.
struct Border {
  std::size_t strip = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

/// Where a strip's western side meets the drone's cells, half-way up the first strip that has such
/// a place.
std::optional<Border> borderOf(const fuse::SharedMap& map) {
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    const fuse::StripCells& cells = map.strips[i].cells;
    const int row = cells.row + cells.depth.rows() / 2;
    for (int c = 1; c < cells.depth.cols(); ++c) {
      const int col = cells.col + c;
      if (map.layers.source(row, col) == map.strips[i].code &&
          map.layers.source(row, col - 1) == fuse::kFixedSource) {
        return Border{i, map.layers.frame.centre(row, col)};
      }
    }
  }
  return std::nullopt;
}

/// A strip in its own cells over the map's.
void paintFine(PictureCanvas& canvas, const View& view, const fuse::SharedMap& map,
               const fuse::FusedStrip& strip, const map::GridMap& fine) {
  paintColours(canvas, view, map.layers);
  const int factor = map.lattice.factor;
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    for (int i = 0; i < view.rect.width; ++i) {
      const Eigen::Vector2d cell = fine.frame.cellOf(view.ground({view.rect.x + i + 0.5, y + 0.5}));
      const int row = static_cast<int>(std::lround(cell.y()));
      const int col = static_cast<int>(std::lround(cell.x()));
      const bool inside = row >= 0 && col >= 0 && row < fine.frame.rows && col < fine.frame.cols;
      if (!inside || !fine.valid(row, col)) continue;
      if (map.layers.source(strip.cells.row + row / factor, strip.cells.col + col / factor) !=
          strip.code) {
        continue;
      }
      const Rgb colour = strip.tone(fine.colour(row, col));
      out[i] = packPixel(colour.r, colour.g, colour.b);
    }
  });
}

struct Layout {
  PixelRect colours, heights, near_colours, near_heights;
  int height = 0;  ///< of all
};

Layout layoutOf(const fuse::Layers& layers, bool near) {
  const int width = (kInnerWidth - kGap) / 2;
  const double aspect = static_cast<double>(layers.frame.rows) / layers.frame.cols;
  const int height = std::clamp(static_cast<int>(width * aspect), 80, kMostHeight);
  Layout layout;
  layout.colours = {kMargin, kTitleRoom, width, height};
  layout.heights = {kMargin + width + kGap, kTitleRoom, width, height};
  layout.height = kTitleRoom + height + kScaleRoom;
  if (near) {
    const int top = layout.height + kTitleRoom;
    layout.near_colours = {kMargin, top, width, kZoomHeight};
    layout.near_heights = {kMargin + width + kGap, top, width, kZoomHeight};
    layout.height = top + kZoomHeight + kGap;
  }
  return layout;
}

void drawTitle(PictureCanvas& canvas, const PixelRect& panel, const std::string& title) {
  canvas.text({static_cast<double>(panel.x), panel.y - 8.0}, title,
              {14.0, palette::kInk, true, Align::kLeft});
}

}  // namespace

void writeSharedMapPicture(const io::OutputPath& path, const fuse::SharedMap& map,
                           const std::vector<const PointStream*>& points, const std::string& name) {
  const fuse::Layers& layers = map.layers;
  const std::optional<Border> near = borderOf(map);
  Layout layout = layoutOf(layers, near.has_value());
  Page page(layout.height, name,
            fmt::format("{} strip{} in a drone's map of {:.0f} x {:.0f} m", map.strips.size(),
                        map.strips.size() == 1 ? "" : "s", layers.frame.cols * layers.frame.cell,
                        layers.frame.rows * layers.frame.cell),
            {verdict::Status::kAccepted, {}}, false);
  for (PixelRect* rect :
       {&layout.colours, &layout.heights, &layout.near_colours, &layout.near_heights}) {
    rect->y += page.top;
  }
  PictureCanvas& canvas = page.canvas;
  const Eigen::Vector2d half =
      0.5 * layers.frame.cell * Eigen::Vector2d(layers.frame.cols, layers.frame.rows);
  const GroundRect whole{layers.frame.corner + half, Eigen::Matrix2d::Identity(), half};
  const Values shown = valuesOf(map);
  for (const bool heights : {false, true}) {
    const View view = fitView(heights ? layout.heights : layout.colours, whole);
    if (heights) {
      paintValues(canvas, view, layers, shown);
    } else {
      paintColours(canvas, view, layers);
    }
    drawBorders(canvas, view, map);
    if (!heights) drawNames(canvas, view, map);
    drawScaleBar(canvas, view);
    drawNorth(canvas, view);
    drawTitle(canvas, view.rect, heights ? shown.title : "Colour, and the strips' cells");
  }
  drawScale(canvas, layout.heights, shown);
  if (near) {
    const GroundRect around{near->place,
                            Eigen::Matrix2d::Identity(),
                            {kZoom * layout.near_colours.width / kZoomHeight, kZoom}};
    const View colours = fitView(layout.near_colours, around);
    paintFine(canvas, colours, map, map.strips[near->strip],
              fuse::fineMap(map, near->strip, *points[near->strip]));
    drawScaleBar(canvas, colours);
    drawTitle(canvas, colours.rect, "A strip's border, in the strip's own cells");
    const View heights = fitView(layout.near_heights, around);
    paintValues(canvas, heights, layers, shown);
    drawScaleBar(canvas, heights);
    drawTitle(canvas, heights.rect, shown.title + " there");
  }
  canvas.write(path);
}

}  // namespace agricolmap::report
