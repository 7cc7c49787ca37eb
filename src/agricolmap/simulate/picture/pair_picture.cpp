#include "agricolmap/simulate/picture/pair_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/draw/outline.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/simulate/picture/cloud_photo.hpp"

namespace agricolmap::simulate {
namespace {

namespace palette = report::palette;
using report::Align;
using report::Colour;
using report::GroundRect;
using report::hexColour;
using report::kGap;
using report::kInnerWidth;
using report::kMargin;
using report::LegendItem;
using report::Page;
using report::PictureCanvas;
using report::PixelRect;
using report::View;

constexpr double kRim = 0.2;          // of ground around the strip [m]
constexpr double kCloseUpSide = 2.0;  // [m]
constexpr int kSquare = (kInnerWidth - 2 * kGap) / 3;
constexpr int kLeastStrip = 110;  // height of the strips' panels [px]
constexpr int kMostStrip = 440;
constexpr int kLegendRoom = 44;

/// Diagonal stripes unlike any soil, plant or shadow: no points here.
constexpr std::uint32_t gapHatch(int x, int y) { return ((x + y) & 7) < 2 ? 0x8e9ab0 : 0xb4bdcd; }

/// The five panels and what they show.
struct Layout {
  View map, fixed_close, moving_close, fixed_strip, moving_strip;
  int height = 0;  ///< of all, without the page's header [px]
};

int stripHeight(const GroundRect& strip) {
  return std::clamp(static_cast<int>(kInnerWidth / strip.aspect()), kLeastStrip, kMostStrip);
}

GroundRect wholeMap(const CloudPhoto& fixed, const CloudPhoto& moving, bool same_field) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : fixed.outline()) box.extend(corner);
  if (same_field) {
    for (const Eigen::Vector2d& corner : moving.outline()) box.extend(corner);
  }
  return {box.center(), Eigen::Matrix2d::Identity(), (0.5 * box.sizes()).cwiseMax(kRim)};
}

Layout layoutOf(const CloudPhoto& fixed, const CloudPhoto& moving, int top, bool same_field) {
  const GroundRect strip = report::smallestRectangle(moving.outline()).grown(kRim);
  const GroundRect close{strip.centre, strip.axes, Eigen::Vector2d::Constant(0.5 * kCloseUpSide)};
  const int strip_height = stripHeight(strip);
  const auto square = [&](int i) {
    return PixelRect{kMargin + i * (kSquare + kGap), top, kSquare, kSquare};
  };
  const auto wide = [&](int i) {
    return PixelRect{kMargin, top + kSquare + kGap + i * (strip_height + kGap), kInnerWidth,
                     strip_height};
  };
  return {fitView(square(0), wholeMap(fixed, moving, same_field)),
          fitView(square(1), close),
          fitView(square(2), close),
          fitView(wide(0), strip),
          fitView(wide(1), strip),
          kSquare + 2 * (kGap + strip_height) + kLegendRoom};
}

void drawPhoto(PictureCanvas& canvas, const View& view, const Raster<std::uint32_t>& photo) {
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    const std::uint32_t* row = photo.row(y - view.rect.y);
    for (int i = 0; i < view.rect.width; ++i) {
      out[i] = row[i] == CloudPhoto::kNothing ? gapHatch(view.rect.x + i, y) : row[i];
    }
  });
}

/// A line that shows on plants and on soil, whatever their brightness.
void drawOutline(PictureCanvas& canvas, const View& view, std::vector<Eigen::Vector2d> corners,
                 const Colour& colour, double width) {
  const PictureCanvas::Clip clip(canvas, view.rect);
  for (Eigen::Vector2d& corner : corners) corner = view.pixel(corner);
  canvas.polygon(corners, {width + 2.0, hexColour(0x000000, 0.55), {}});
  canvas.polygon(corners, {width, colour, {}});
}

/// The corners of the ground that `view` shows.
std::vector<Eigen::Vector2d> cornersOf(const View& view) {
  const PixelRect& rect = view.rect;
  const double right = rect.x + rect.width;
  const double bottom = rect.y + rect.height;
  return {view.ground({rect.x, rect.y}), view.ground({right, rect.y}), view.ground({right, bottom}),
          view.ground({rect.x, bottom})};
}

void drawFurniture(PictureCanvas& canvas, const View& view, const std::string& label) {
  drawPlate(canvas, view, label);
  drawScaleBar(canvas, view);
  drawNorth(canvas, view);
}

std::string describeCloud(const std::string& name, const Cloud& cloud, const CloudPhoto& photo) {
  return fmt::format("{}: {:.2f} million points, {:.1f} mm apart", name,
                     1e-6 * static_cast<double>(cloud.size()), 1e3 * photo.spacing());
}

void drawMarks(PictureCanvas& canvas, const Layout& layout, const CloudPhoto& moving,
               bool same_field) {
  if (same_field) {
    drawOutline(canvas, layout.map, moving.outline(), hexColour(0xffffff), 2.0);
    drawOutline(canvas, layout.fixed_strip, moving.outline(), hexColour(0xffffff), 1.0);
  }
  const std::vector<Eigen::Vector2d> close = cornersOf(layout.fixed_close);
  drawOutline(canvas, layout.map, close, palette::kInset, 1.0);
  drawOutline(canvas, layout.fixed_strip, close, palette::kInset, 2.0);
  drawOutline(canvas, layout.moving_strip, close, palette::kInset, 2.0);
  canvas.frame(layout.fixed_close.rect, {2.0, palette::kInset, {}});
  canvas.frame(layout.moving_close.rect, {2.0, palette::kInset, {}});
}

void drawPanels(PictureCanvas& canvas, const Layout& layout, const CloudPhoto& fixed,
                const CloudPhoto& moving, const PairPictureInfo& info) {
  struct Panel {
    const View& view;
    const CloudPhoto& photo;
    std::string label;
  };
  const std::string square = fmt::format("{0:g} × {0:g} m", kCloseUpSide);
  const char* elsewhere = info.same_field ? "" : ", another field";
  const std::array<Panel, 5> panels = {{
      {layout.map, fixed, fmt::format("{}: whole map", info.fixed_name)},
      {layout.fixed_close, fixed, fmt::format("{}: {}", info.fixed_name, square)},
      {layout.moving_close, moving, fmt::format("{}: {}{}", info.moving_name, square, elsewhere)},
      {layout.fixed_strip, fixed,
       fmt::format("{}: {}the strip's place", info.fixed_name, info.same_field ? "" : "not ")},
      {layout.moving_strip, moving, fmt::format("{}: the strip{}", info.moving_name, elsewhere)},
  }};
  std::array<Raster<std::uint32_t>, 5> photos;
  parallelFor(panels.size(),
              [&](std::size_t i) { photos[i] = panels[i].photo.shoot(panels[i].view); });
  for (std::size_t i = 0; i < panels.size(); ++i) {
    drawPhoto(canvas, panels[i].view, photos[i]);
  }
  drawMarks(canvas, layout, moving, info.same_field);
  for (const Panel& panel : panels) drawFurniture(canvas, panel.view, panel.label);
}

void drawFooter(PictureCanvas& canvas, bool same_field) {
  std::vector<LegendItem> items;
  if (same_field) {
    items.push_back({LegendItem::Kind::kLine, hexColour(0xffffff), "where the strip belongs", {}});
  }
  items.push_back({LegendItem::Kind::kLine, palette::kInset, "close-up", {}});
  const double baseline = canvas.height() - kLegendRoom + 26.0;
  const double end = drawLegend(canvas, {kMargin, baseline}, items, false);
  const PixelRect key{static_cast<int>(end) + 24, static_cast<int>(baseline) - 12, 26, 15};
  canvas.paint(key, [&](int y, std::uint32_t* row) {
    for (int i = 0; i < key.width; ++i) row[i] = gapHatch(key.x + i, y);
  });
  canvas.frame(key, {1.0, hexColour(0x8a9099), {}});
  canvas.text({key.x + 34.0, baseline}, "no points", {13.0, palette::kInk, false, Align::kLeft});
}

}  // namespace

void writePairPicture(const io::OutputPath& path, const Cloud& fixed, const Cloud& moving,
                      const Eigen::Affine3d& fixed_from_moving, const PairPictureInfo& info) {
  const Eigen::Affine3d ground_from_moving =
      Eigen::Translation3d(-fixed.origin) * fixed_from_moving * Eigen::Translation3d(moving.origin);
  const CloudPhoto fixed_photo(fixed, Eigen::Affine3d::Identity());
  const CloudPhoto moving_photo(moving, ground_from_moving);
  const int height = layoutOf(fixed_photo, moving_photo, 0, info.same_field).height;
  Page page(height, info.title,
            fmt::format("{}; {}", describeCloud(info.fixed_name, fixed, fixed_photo),
                        describeCloud(info.moving_name, moving, moving_photo)),
            {verdict::Status::kAccepted, {}, {}}, false);
  const Layout layout = layoutOf(fixed_photo, moving_photo, page.top, info.same_field);
  drawPanels(page.canvas, layout, fixed_photo, moving_photo, info);
  drawFooter(page.canvas, info.same_field);
  page.canvas.write(path);
}

}  // namespace agricolmap::simulate
