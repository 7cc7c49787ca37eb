#include "agricolmap/report/pictures/facts_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "agricolmap/crop/row_line.hpp"
#include "agricolmap/report/draw/page.hpp"

namespace agricolmap::report {

namespace {

constexpr int kMapSide = 800;  // of a field that is about as high as wide
constexpr int kSideWidth = kInnerWidth - kMapSide - kGap;
constexpr double kWide = 1.7;      // aspect from which a field has the whole width of the page
constexpr int kWideHeight = 640;   // and at most this height
constexpr int kFigureHeight = 58;  // of a figure and its two lines
constexpr int kFigureColumns = 2;
constexpr double kCloseUp = 4.0;      // side of the piece shown large [m]
constexpr double kPlantsFrom = 25.0;  // px/m from which single plants are drawn
constexpr double kLineHeight = 24.0;  // of the legend [px]
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

/// What is asked first, and what stands behind it.
struct Figure {
  std::string value;
  std::string meaning;
};

Figure plantsFigure(const crop::FieldFacts& facts) {
  if (facts.rows.rows.empty()) return {"no rows", "found: nothing to count along"};
  const crop::StandFacts& total = facts.total;
  if (!facts.countable) return {"not counted", "plants touch or stand too close"};
  std::string meaning = fmt::format("{:.0f} plants ({:.0f} to {:.0f})", total.plants,
                                    total.plants_low, total.plants_high);
  if (total.uncounted >= 0.5) {
    meaning += fmt::format("; {:.0f} m of row not counted", total.uncounted);
  }
  return {fmt::format("{:.3g} plants/m²", total.area > 0.0 ? total.plants / total.area : 0.0),
          meaning};
}

std::vector<Figure> figuresOf(const crop::FieldFacts& facts) {
  const crop::StandFacts& total = facts.total;
  std::vector<Figure> figures = {plantsFigure(facts)};
  if (facts.countable && total.row_length > 0.0) {
    figures.push_back({fmt::format("{:.0f} % gaps", 100.0 * total.gap_length / total.row_length),
                       fmt::format("{} of 1.5 spacings and more, {:.0f} m of {:.0f} m of row",
                                   total.gaps, total.gap_length, total.row_length)});
  }
  figures.push_back({fmt::format("{:.1f} % green", 100.0 * total.cover),
                     fmt::format("of {:.0f} m² that were seen", total.area)});
  if (std::isfinite(total.height.middle)) {
    figures.push_back({fmt::format("{:.0f} cm high", 100.0 * total.height.middle),
                       fmt::format("a tenth of the plants below {:.0f} cm, a tenth above {:.0f} cm",
                                   100.0 * total.height.low, 100.0 * total.height.high)});
  }
  if (!facts.rows.rows.empty()) {
    const double patches =
        total.between > 0.0 ? static_cast<double>(total.patches) / total.between : 0.0;
    figures.push_back({fmt::format("{:.2f} % weeds", 100.0 * total.weeds),
                       fmt::format("of the ground between rows, {:.2g} patches per m²", patches)});
    figures.push_back(
        {fmt::format("{:.2f} m rows", facts.rows.row_spacing),
         fmt::format("{} of them{}", facts.rows.rows.size(),
                     facts.countable ? fmt::format(", a plant each {:.0f} cm",
                                                   100.0 * facts.rows.spacing.distance)
                                     : "")});
  }
  return figures;
}

int figureRows(const std::vector<Figure>& figures) {
  return (static_cast<int>(figures.size()) + kFigureColumns - 1) / kFigureColumns;
}

void drawFigures(PictureCanvas& canvas, const Eigen::Vector2d& at,
                 const std::vector<Figure>& figures) {
  const double column = 1.0 * kSideWidth / kFigureColumns;
  const TextStyle small{12.0, palette::kFaint, false, Align::kLeft};
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const std::size_t across = i % kFigureColumns;
    const std::size_t down = i / kFigureColumns;
    Eigen::Vector2d place = at + Eigen::Vector2d(column * static_cast<double>(across),
                                                 kFigureHeight * static_cast<double>(down));
    canvas.text(place, figures[i].value, {19.0, palette::kInk, true, Align::kLeft});
    for (const std::string& line : canvas.wrapped(figures[i].meaning, column - 12.0, small)) {
      place.y() += 15.0;
      canvas.text(place, line, small);
    }
  }
}

/// A key of the map's own colours, as wide as those of drawLegend.
PixelRect keyAt(const Eigen::Vector2d& at) {
  return {static_cast<int>(at.x()), static_cast<int>(at.y()) - 12, 26, 15};
}

void drawKeys(PictureCanvas& canvas, Eigen::Vector2d at, const PlacedFacts& placed) {
  const Stroke border{1.0, hexColour(0x8a9099), {}};
  const auto name = [&](const char* text) {
    canvas.text({at.x() + 34.0, at.y()}, text, {});
    at.y() += kLineHeight;
  };
  if (placed.facts.countable) {
    canvas.fill(keyAt(at), hexColour(shade(1.0F)));
    canvas.circle(keyAt(at).middle(), 4.0, {1.2, kPlantColour, {}});
    name("plant, counted");
  }
  using Kind = LegendItem::Kind;
  std::vector<LegendItem> items = {{Kind::kLine, kTouchColour, "row, cannot be counted", {}}};
  if (placed.facts.countable) items.push_back({Kind::kLine, kGapColour, "gap", {}});
  items.push_back({Kind::kSquare, kWeedColour, "weeds between the rows", {}});
  drawLegend(canvas, at, items, true);
  at.y() += kLineHeight * static_cast<double>(items.size());
  if (!placed.plots.empty()) {
    canvas.frame(keyAt(at), {1.5, palette::kInk, {}});
    name("plot");
  }
  // As the map has it, which is paler than the hatching of the legends' own.
  const PixelRect key = keyAt(at);
  canvas.paint(key, [&](int y, std::uint32_t* row) {
    for (int i = 0; i < key.width; ++i) row[i] = lightHatch(key.x + i, y);
  });
  canvas.frame(key, border);
  name("not seen");
}

/// Where things stand on the page: a wide field above all else, others beside it.
struct Layout {
  PixelRect map;
  PixelRect close;
  Eigen::Vector2d figures = Eigen::Vector2d::Zero();
  Eigen::Vector2d keys = Eigen::Vector2d::Zero();
  int height = 0;
};

constexpr int kKeysHeight = 6 * static_cast<int>(kLineHeight);

Layout layoutOf(double aspect, int figure_rows) {
  constexpr double kFirstLine = 26.0;
  const int figures = figure_rows * kFigureHeight;
  Layout layout;
  if (aspect < kWide) {
    const int left = kMargin + kMapSide + kGap;
    layout.map = {kMargin, 0, kMapSide, kMapSide};
    layout.close = {left, 0, kSideWidth, kSideWidth};
    layout.figures = {left, kSideWidth + kFirstLine + 8.0};
    layout.keys = {left, layout.figures.y() + figures + 12.0};
    layout.height = std::max(kMapSide, static_cast<int>(layout.keys.y()) + kKeysHeight);
    return layout;
  }
  const int map = std::clamp(static_cast<int>(kInnerWidth / aspect), 160, kWideHeight);
  const int below = map + kGap;
  layout.map = {kMargin, 0, kInnerWidth, map};
  layout.close = {kMargin, below, kSideWidth, figures + kKeysHeight / 2};
  layout.figures = {kMargin + kSideWidth + 2.0 * kGap, below + kFirstLine};
  layout.keys = {layout.figures.x() + kSideWidth + 2.0 * kGap, below + kFirstLine};
  layout.height = below + std::max(layout.close.height, kKeysHeight);
  return layout;
}

}  // namespace

void writeFactsPicture(const io::OutputPath& path, const GridFrame& frame,
                       const PlacedFacts& placed) {
  verdict::Verdict none;
  none.status = verdict::Status::kAccepted;
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  const GroundRect field{frame.corner + 0.5 * size, Eigen::Matrix2d::Identity(), 0.5 * size};
  const std::vector<Figure> figures = figuresOf(placed.facts);
  Layout layout = layoutOf(field.aspect(), figureRows(figures));
  Page page(layout.height + kMargin, "Crop facts", placed.source, none, false);
  PictureCanvas& canvas = page.canvas;
  const Eigen::Vector2d down(0.0, page.top);
  layout.map.y += page.top;
  layout.close.y += page.top;
  const View whole = fitView(layout.map, field);
  drawMap(canvas, whole, frame, placed);
  drawScaleBar(canvas, whole);
  drawNorth(canvas, whole);
  const double aspect = 1.0 * layout.close.width / layout.close.height;
  const View close =
      fitView(layout.close, {closeUpAt(frame, placed.facts), Eigen::Matrix2d::Identity(),
                             0.5 * kCloseUp * Eigen::Vector2d(1.0, 1.0 / aspect)});
  drawMap(canvas, close, frame, placed);
  drawPlate(canvas, close, fmt::format("{:g} × {:.2g} m", kCloseUp, kCloseUp / aspect));
  drawScaleBar(canvas, close);
  drawFigures(canvas, layout.figures + down, figures);
  drawKeys(canvas, layout.keys + down, placed);
  canvas.write(path);
}

}  // namespace agricolmap::report
