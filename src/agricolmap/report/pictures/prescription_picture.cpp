#include "agricolmap/report/pictures/prescription_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/draw/ramp.hpp"

namespace agricolmap::report {
namespace {

constexpr int kMapWidth = 760;
constexpr int kLeastHeight = 320;
constexpr int kMostHeight = 900;
constexpr int kSide = kMargin + kMapWidth + 2 * kGap;
constexpr int kSideWidth = kPageWidth - kMargin - kSide;
constexpr int kLine = 21;           // of the table [px]
constexpr double kShown = 0.02;     // of the layer's values are beyond its colours, on each side
constexpr double kLinesFrom = 9.0;  // px of a square from which its borders are drawn
constexpr Colour kBorder = hexColour(0xffffff, 0.35);

void drawBorders(PictureCanvas& canvas, const View& view, const prescribe::Lattice& lattice,
                 const Eigen::Affine2d& file_from_place) {
  const auto pixel = [&](double row, double col) {
    return view.pixel(file_from_place * Eigen::Vector2d(col, row));
  };
  if ((pixel(0, 1) - pixel(0, 0)).norm() < kLinesFrom) return;
  if ((pixel(1, 0) - pixel(0, 0)).norm() < kLinesFrom) return;
  std::vector<Eigen::Vector2d> ends;
  for (int row = 0; row <= lattice.rows; ++row) {
    ends.insert(ends.end(), {pixel(row, 0), pixel(row, lattice.cols)});
  }
  for (int col = 0; col <= lattice.cols; ++col) {
    ends.insert(ends.end(), {pixel(0, col), pixel(lattice.rows, col)});
  }
  canvas.lines(ends, {1.0, kBorder, {}});
}

void drawClasses(PictureCanvas& canvas, const View& view, const PrescriptionScene& scene) {
  const prescribe::Plan& plan = scene.placed.plan;
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    for (int i = 0; i < view.rect.width; ++i) {
      const Eigen::Vector2d place =
          scene.place_from_file * view.ground({view.rect.x + i + 0.5, y + 0.5});
      const auto col = static_cast<int>(std::floor(place.x()));
      const auto row = static_cast<int>(std::floor(place.y()));
      const int code = plan.code.contains(row, col) ? plan.code(row, col) : 0;
      out[i] = code == 0 ? lightHatch(view.rect.x + i, y)
                         : classColour(plan, static_cast<std::size_t>(code) - 1);
    }
  });
  const PictureCanvas::Clip clip(canvas, view.rect);
  drawBorders(canvas, view, plan.lattice, scene.place_from_file.inverse());
  canvas.frame(view.rect, {1.0, palette::kFaint, {}});
  drawScaleBar(canvas, view);
  drawNorth(canvas, view);
}

/// What the colours of the layer reach from and to.
struct Reach {
  double low = 0.0;
  double high = 1.0;
};

Reach reachOf(const Raster<float>& values) {
  constexpr std::size_t kSample = 200000;
  std::vector<float> known;
  const std::size_t step = std::max<std::size_t>(1, values.size() / kSample);
  for (std::size_t i = 0; i < values.size(); i += step) {
    if (std::isfinite(values[i])) known.push_back(values[i]);
  }
  if (known.empty()) return {};
  Reach reach{static_cast<double>(quantile(known, kShown)),
              static_cast<double>(quantile(known, 1.0 - kShown))};
  if (reach.high <= reach.low) reach.high = reach.low + 1.0;
  return reach;
}

void drawLayer(PictureCanvas& canvas, const View& view, const PrescriptionScene& scene) {
  const Reach reach = reachOf(scene.values);
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    for (int i = 0; i < view.rect.width; ++i) {
      const Eigen::Vector2d cell =
          scene.frame.cellOf(view.ground({view.rect.x + i + 0.5, y + 0.5}));
      const auto col = static_cast<int>(std::lround(cell.x()));
      const auto row = static_cast<int>(std::lround(cell.y()));
      const bool known = scene.values.contains(row, col) && std::isfinite(scene.values(row, col));
      out[i] =
          known ? rampColour(kLowToHigh, (static_cast<double>(scene.values(row, col)) - reach.low) /
                                             (reach.high - reach.low))
                : lightHatch(view.rect.x + i, y);
    }
  });
  canvas.frame(view.rect, {1.0, palette::kFaint, {}});
  const double below = view.rect.y + view.rect.height + 18.0;
  canvas.text({static_cast<double>(view.rect.x), below},
              fmt::format("the layer: {}, {:.3g} (dark) to {:.3g} {}", scene.placed.layer,
                          reach.low, reach.high, scene.placed.unit),
              {12.0, palette::kFaint, false, Align::kLeft});
}

/// Class, rate, area and amount in columns; returns the y below.
double drawTable(PictureCanvas& canvas, const PlacedPlan& placed, double y) {
  const prescribe::Plan& plan = placed.plan;
  const double right = kSide + kSideWidth;
  const std::array<double, 3> columns{right - 170.0, right - 80.0, right};
  const auto line = [&](const std::string& name, const std::array<std::string, 3>& cells,
                        bool bold) {
    canvas.text({kSide + 34.0, y}, name, {13.0, palette::kInk, bold, Align::kLeft});
    for (std::size_t i = 0; i < columns.size(); ++i) {
      canvas.text({columns[i], y}, cells[i], {13.0, palette::kInk, bold, Align::kRight});
    }
    y += kLine;
  };
  line(placed.layer, {std::string(plan.unit.name), "m²", std::string(plan.unit.amount)}, true);
  for (std::size_t i = 0; i < plan.classes.size(); ++i) {
    const prescribe::ClassShare& share = plan.classes[i];
    const PixelRect key{kSide, static_cast<int>(y) - 12, 26, 15};
    canvas.fill(key, hexColour(classColour(plan, i)));
    canvas.frame(key, {1.0, hexColour(0x8a9099), {}});
    line(classRange(placed, i),
         {fmt::format("{:.6g}", prescribe::taskRate(share.task_value, plan.unit)),
          fmt::format("{:.1f}", share.area), fmt::format("{:.4g}", share.amount)},
         false);
  }
  line("all", {"", fmt::format("{:.1f}", plan.area), fmt::format("{:.4g}", plan.amount)}, true);
  const PixelRect key{kSide, static_cast<int>(y) - 12, 26, 15};
  canvas.paint(key, [&](int row, std::uint32_t* out) {
    for (int i = 0; i < key.width; ++i) out[i] = lightHatch(key.x + i, row);
  });
  canvas.frame(key, {1.0, hexColour(0x8a9099), {}});
  line("not known: gets nothing", {"", "", ""}, false);
  return y;
}

}  // namespace

void writePrescriptionPicture(const io::OutputPath& path, const PrescriptionScene& scene) {
  const PlacedPlan& placed = scene.placed;
  const GridFrame& frame = scene.frame;
  const Eigen::Vector2d half = 0.5 * frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  const GroundRect field{frame.corner + half, Eigen::Matrix2d::Identity(), half};
  // Squares reach beyond the layer's edge.
  const GroundRect shown = field.grown(std::max(placed.squares.width, placed.squares.length));
  const int layer = std::min(kMostHeight / 2, static_cast<int>(kSideWidth / field.aspect()) + 1);
  const int table = kLine * static_cast<int>(placed.plan.classes.size() + 3) + kGap;
  const int height =
      std::max(std::clamp(static_cast<int>(kMapWidth / shown.aspect()), kLeastHeight, kMostHeight),
               table + layer + kLine);
  verdict::Verdict none;  // nobody judged anything: no banner
  none.status = verdict::Status::kAccepted;
  Page page(height + kMargin, fmt::format("Prescription of {}", placed.product),
            fmt::format("{} of {}, squares of {:g} × {:g} m", placed.layer, placed.source,
                        placed.squares.width, placed.squares.length),
            none, false);
  PictureCanvas& canvas = page.canvas;
  drawClasses(canvas, fitView({kMargin, page.top, kMapWidth, height}, shown), scene);
  const int top = static_cast<int>(drawTable(canvas, placed, page.top + 14.0));
  drawLayer(canvas, fitView({kSide, top, kSideWidth, layer}, field), scene);
  canvas.write(path);
}

}  // namespace agricolmap::report
