#include "agricolmap/batch/picture/summary_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/batch/summary.hpp"
#include "agricolmap/report/draw/page.hpp"

namespace agricolmap::batch {
namespace {

namespace palette = report::palette;
using report::Colour;
using report::GroundRect;
using report::hexColour;
using report::kInnerWidth;
using report::kMargin;
using report::LegendItem;
using report::Page;
using report::PictureCanvas;
using report::PixelRect;
using report::View;

constexpr int kMostHeight = 1100;  // of a map's panel [px]
constexpr int kLeastHeight = 120;
constexpr int kTitleRoom = 26;
constexpr int kPanelGap = 22;
constexpr int kLegendRoom = 40;

/// Colours that those who cannot tell red from green tell apart (Okabe and Ito), and lines that
/// differ, too.
struct Look {
  const char* status;
  Colour colour;
  std::vector<double> dashes;
};
const std::array<Look, 3>& looks() {
  static const std::array<Look, 3> kLooks = {{{"accepted", hexColour(0x56b4e9), {}},
                                              {"ambiguous", hexColour(0xf0e442), {4.0, 4.0}},
                                              {"rejected", hexColour(0xd55e00), {9.0, 5.0}}}};
  return kLooks;
}

GroundRect wholeOf(const MapGround& ground) {
  const GridFrame& frame = ground.map.frame;
  const Eigen::Vector2d half = 0.5 * frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  return {frame.corner + half, Eigen::Matrix2d::Identity(), half};
}

PixelRect panelOf(const MapGround& ground, int top) {
  const GroundRect whole = wholeOf(ground);
  const double height = std::min<double>(kMostHeight, kInnerWidth / whole.aspect());
  const double width = std::min<double>(kInnerWidth, height * whole.aspect());
  return {kMargin, top, std::max(kLeastHeight, static_cast<int>(width)),
          std::max(kLeastHeight, static_cast<int>(height))};
}

/// Heights of a map without colours, from dark to light.
std::uint32_t greyOf(float height, float low, float high) {
  const float share = std::clamp((height - low) / std::max(1e-6F, high - low), 0.0F, 1.0F);
  const int value = 60 + static_cast<int>(170.0F * share);
  return report::packPixel(value, value, value);
}

void paintMap(PictureCanvas& canvas, const MapGround& ground, const View& view) {
  const map::GridMap& map = ground.map;
  bool coloured = false;
  float low = 1e9F, high = -1e9F;
  for (std::size_t i = 0; i < map.weight.size(); ++i) {
    if (!map.valid(i)) continue;
    coloured = coloured || map.colour[i].r + map.colour[i].g + map.colour[i].b > 0;
    low = std::min(low, map.height[i]);
    high = std::max(high, map.height[i]);
  }
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    for (int i = 0; i < view.rect.width; ++i) {
      const Eigen::Vector2d cell = map.frame.cellOf(view.ground({view.rect.x + i + 0.5, y + 0.5}));
      const int col = static_cast<int>(std::lround(cell.x()));
      const int row = static_cast<int>(std::lround(cell.y()));
      const bool inside = col >= 0 && row >= 0 && col < map.frame.cols && row < map.frame.rows;
      if (!inside || !map.valid(row, col)) {
        out[i] = report::lightHatch(view.rect.x + i, y);
      } else if (coloured) {
        const Rgb colour = map.colour(row, col);
        out[i] = report::packPixel(colour.r, colour.g, colour.b);
      } else {
        out[i] = greyOf(map.height(row, col), low, high);
      }
    }
  });
  canvas.frame(view.rect, {1.0, hexColour(0x8a9099), {}});
}

/// Those that are accepted first, so that they hide none of the others.
void drawStrips(PictureCanvas& canvas, const MapGround& ground, const View& view,
                std::span<const Record> records) {
  const PictureCanvas::Clip clip(canvas, view.rect);
  for (const Look& look : looks()) {
    for (const Record& record : records) {
      if (record.map != ground.id || record.status != look.status) continue;
      std::vector<Eigen::Vector2d> corners;
      for (const Eigen::Vector2d& corner : record.outline) {
        corners.push_back(view.pixel(corner - ground.origin));
      }
      if (corners.size() < 3) continue;
      canvas.polygon(corners, {4.0, hexColour(0x000000, 0.7), {}});
      canvas.polygon(corners, {2.0, look.colour, look.dashes});
    }
  }
}

}  // namespace

void writeSummaryPicture(const io::OutputPath& path, std::span<const MapGround> grounds,
                         std::span<const Record> records) {
  int height = kLegendRoom;
  for (const MapGround& ground : grounds) {
    height += kTitleRoom + panelOf(ground, 0).height + kPanelGap;
  }
  const Counts counts = countsOf(records);
  Page page(height, fmt::format("{} strip{}", records.size(), records.size() == 1 ? "" : "s"),
            toText(counts) + (counts.failed > 0 ? "; those that failed are not drawn" : ""),
            {verdict::Status::kAccepted, {}}, false);
  int top = page.top;
  for (const MapGround& ground : grounds) {
    page.canvas.text({kMargin, top + 16.0},
                     page.canvas.elided(fmt::format("{}: {}", ground.id, ground.name), kInnerWidth,
                                        {15.0, palette::kInk, true}),
                     {15.0, palette::kInk, true, report::Align::kLeft});
    const PixelRect rect = panelOf(ground, top + kTitleRoom);
    const View view = fitView(rect, wholeOf(ground));
    paintMap(page.canvas, ground, view);
    drawStrips(page.canvas, ground, view, records);
    drawScaleBar(page.canvas, view);
    drawNorth(page.canvas, view);
    top = rect.y + rect.height + kPanelGap;
  }
  std::vector<LegendItem> items;
  for (const Look& look : looks()) {
    items.push_back({LegendItem::Kind::kLine, look.colour, look.status, look.dashes});
  }
  drawLegend(page.canvas, {kMargin, top + 14.0}, items, false);
  page.canvas.write(path);
}

}  // namespace agricolmap::batch
