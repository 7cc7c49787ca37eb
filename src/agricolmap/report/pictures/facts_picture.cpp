#include "agricolmap/report/pictures/facts_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "agricolmap/crop/row_line.hpp"
#include "agricolmap/report/draw/page.hpp"

namespace agricolmap::report {

namespace {

constexpr int kMapSide = 800;
constexpr int kSideWidth = kInnerWidth - kMapSide - kGap;
constexpr double kCloseUp = 4.0;      // side of the piece shown large [m]
constexpr double kPlantsFrom = 25.0;  // px/m from which single plants are drawn
constexpr double kLineHeight = 20.0;  // of the words [px]
constexpr Colour kGapColour = hexColour(0xe53935);
constexpr Colour kWeedColour = hexColour(0xd81bdc);
constexpr Colour kPlantColour = hexColour(0xffffff);
constexpr Colour kRowColour = hexColour(0xffffff, 0.35);
constexpr Colour kTouchColour = hexColour(0xffe14d);

std::uint32_t shade(float green) {
  if (!std::isfinite(green)) return 0xececef;
  const double g = std::clamp(static_cast<double>(green), 0.0, 1.0);
  const auto mix = [g](int soil, int plant) {
    return static_cast<int>(std::lround(soil + g * (plant - soil)));
  };
  return packPixel(mix(158, 52), mix(138, 128), mix(112, 48));
}

/// Means of the cells under a pixel, where pixels are larger.
void drawGreen(PictureCanvas& canvas, const View& view, const GridFrame& frame,
               const Raster<float>& green) {
  const int step = std::max(1, static_cast<int>(std::lround(1.0 / (view.scale * frame.cell))));
  const crop::CoarseGreen coarse = crop::coarseGreen(frame, green, step);
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    for (int i = 0; i < view.rect.width; ++i) {
      const Eigen::Vector2d at = view.ground({view.rect.x + i + 0.5, y + 0.5});
      const float value = crop::knownValue(coarse.frame, coarse.green, at);
      out[i] = std::isfinite(value) ? shade(value) : lightHatch(view.rect.x + i, y);
    }
  });
}

void drawStretch(PictureCanvas& canvas, const View& view, const crop::RowLine& line,
                 const crop::Stretch& stretch, const Stroke& stroke) {
  constexpr double kStep = 0.25;
  std::vector<Eigen::Vector2d> ends;
  const int pieces = std::max(1, static_cast<int>(std::ceil(stretch.length() / kStep)));
  for (int i = 0; i < pieces; ++i) {
    for (const int end : {i, i + 1}) {
      ends.push_back(view.pixel(line.at(stretch.from + stretch.length() * end / pieces).point));
    }
  }
  canvas.lines(ends, stroke);
}

void drawMap(PictureCanvas& canvas, const View& view, const GridFrame& frame,
             const PlacedFacts& placed) {
  const crop::FieldFacts& facts = placed.facts;
  const PictureCanvas::Clip clip(canvas, view.rect);
  drawGreen(canvas, view, frame, facts.greenness.green);
  const double mark = std::clamp(0.02 * view.scale, 1.5, 5.0);
  for (const crop::FieldRow& row : facts.rows.rows) {
    drawStretch(canvas, view, row.line, {0.0, row.line.length()}, {1.0, kRowColour, {}});
    for (const crop::Stretch& touching : row.stand.touching) {
      drawStretch(canvas, view, row.line, touching, {mark, kTouchColour, {}});
    }
    for (const crop::Stretch& gap : row.stand.gaps) {
      drawStretch(canvas, view, row.line, gap, {1.2 * mark, kGapColour, {}});
    }
    if (view.scale < kPlantsFrom) continue;
    for (const crop::CropPlant& plant : row.stand.plants) {
      canvas.circle(view.pixel(plant.place), mark, {1.2, kPlantColour, {}});
    }
  }
  for (const crop::WeedPatch& weed : facts.weeds.patches) {
    const double radius = std::max(mark, view.scale * std::sqrt(weed.area / 3.14));
    canvas.circle(view.pixel(weed.place), radius, {1.5, kWeedColour, {}});
  }
  for (const crop::Plot& plot : placed.plots) {
    std::vector<Eigen::Vector2d> corners;
    for (const Eigen::Vector2d& corner : plot.corners) corners.push_back(view.pixel(corner));
    canvas.polygon(corners, {1.5, palette::kInk, {}});
  }
}

/// Where to look closer: the square about the row in the middle.
Eigen::Vector2d closeUpAt(const GridFrame& frame, const crop::FieldFacts& facts) {
  if (facts.rows.rows.empty()) return frame.centre(0.5 * frame.rows, 0.5 * frame.cols);
  const crop::RowLine& line = facts.rows.rows[facts.rows.rows.size() / 2].line;
  return line.at(0.5 * line.length()).point;
}

void drawWords(PictureCanvas& canvas, Eigen::Vector2d at, const PlacedFacts& placed) {
  std::istringstream lines(factsText(placed));
  std::string line;
  // The first names the source, as the title does.
  for (bool first = true; std::getline(lines, line); first = false) {
    if (first && line.find(": ") != std::string::npos) line = line.substr(line.rfind(": ") + 2);
    for (const std::string& piece : canvas.wrapped(line, kSideWidth, {})) {
      canvas.text(at, piece, {});
      at.y() += kLineHeight;
    }
  }
  at.y() += 0.5 * kLineHeight;
  using Kind = LegendItem::Kind;
  std::vector<LegendItem> items = {{Kind::kLine, kGapColour, "gap", {}},
                                   {Kind::kLine, kTouchColour, "cannot be counted", {}},
                                   {Kind::kSquare, kWeedColour, "weeds between the rows", {}}};
  drawLegend(canvas, at, items, true);
  // As the map has it, which is paler than the hatching of the legends' own.
  const double below = at.y() + 24.0 * static_cast<double>(items.size());
  const PixelRect key{static_cast<int>(at.x()), static_cast<int>(below) - 12, 26, 15};
  canvas.paint(key, [&](int y, std::uint32_t* row) {
    for (int i = 0; i < key.width; ++i) row[i] = lightHatch(key.x + i, y);
  });
  canvas.frame(key, {1.0, hexColour(0x8a9099), {}});
  canvas.text({at.x() + 34.0, below}, "not seen", {});
}

}  // namespace

void writeFactsPicture(const io::OutputPath& path, const GridFrame& frame,
                       const PlacedFacts& placed) {
  verdict::Verdict none;
  none.status = verdict::Status::kAccepted;
  Page page(kMapSide, "Crop facts", placed.source, none, false);
  PictureCanvas& canvas = page.canvas;
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  const GroundRect field{frame.corner + 0.5 * size, Eigen::Matrix2d::Identity(), 0.5 * size};
  const View whole = fitView({kMargin, page.top, kMapSide, kMapSide}, field);
  drawMap(canvas, whole, frame, placed);
  drawScaleBar(canvas, whole);
  drawNorth(canvas, whole);
  const int left = kMargin + kMapSide + kGap;
  const View close = fitView({left, page.top, kSideWidth, kSideWidth},
                             {closeUpAt(frame, placed.facts), Eigen::Matrix2d::Identity(),
                              Eigen::Vector2d::Constant(0.5 * kCloseUp)});
  drawMap(canvas, close, frame, placed);
  drawPlate(canvas, close, fmt::format("{0:g} × {0:g} m", kCloseUp));
  drawScaleBar(canvas, close);
  drawWords(canvas, {left, page.top + kSideWidth + 1.5 * kLineHeight}, placed);
  canvas.write(path);
}

}  // namespace agricolmap::report
