// exg_maps.png: the two maps side by side on one colour scale.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/pictures/picture_kinds.hpp"

namespace agricolmap::report {
namespace {

constexpr int kPanelWidth = (kInnerWidth - kGap) / 2;
constexpr int kMaxPanelHeight = 604;
constexpr int kTitleRoom = 26;
constexpr int kCaptionRoom = 26;
constexpr int kBarRoom = 62;

/// From pale soil to dark leaf; lightness falls evenly, so it reads in grey and without red-green
/// vision too.
class SoilToLeaf {
 public:
  SoilToLeaf() {
    constexpr std::array<std::array<double, 3>, 5> kStops = {
        {{241, 228, 208}, {217, 192, 145}, {168, 180, 92}, {88, 142, 58}, {16, 78, 34}}};
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double place = static_cast<double>(i) / 255.0 * (kStops.size() - 1.0);
      const std::size_t stop = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
      const double share = place - static_cast<double>(stop);
      std::array<int, 3> rgb{};
      for (std::size_t k = 0; k < 3; ++k) {
        rgb[k] = static_cast<int>(
            std::lround((1.0 - share) * kStops[stop][k] + share * kStops[stop + 1][k]));
      }
      table_[i] = packPixel(rgb[0], rgb[1], rgb[2]);
    }
  }
  std::uint32_t operator()(float strength) const {
    return table_[static_cast<std::size_t>(strength * 255.0F + 0.5F)];
  }

 private:
  std::array<std::uint32_t, 256> table_{};
};

GroundRect wholeMap(const GridFrame& frame) {
  const Eigen::Vector2d half = 0.5 * frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  return {frame.corner + half, Eigen::Matrix2d::Identity(), half};
}

/// The largest panel at `at` of the map's shape.
PixelRect panelFor(const GroundRect& ground, int x, int y) {
  const double scale = std::min(0.5 * kPanelWidth / ground.half_extent.x(),
                                0.5 * kMaxPanelHeight / ground.half_extent.y());
  return {x, y, std::max(40, static_cast<int>(2.0 * scale * ground.half_extent.x())),
          std::max(40, static_cast<int>(2.0 * scale * ground.half_extent.y()))};
}

void drawMap(PictureCanvas& canvas, const Scene& scene, const MapLayer& layer,
             const ValueRange& range, const SoilToLeaf& map, const PixelRect& rect,
             const std::string& title) {
  const GridFrame& frame = layer.map().frame;
  canvas.text({static_cast<double>(rect.x), rect.y - 9.0},
              canvas.elided(title, kPanelWidth, {15.0, palette::kInk, true}),
              {15.0, palette::kInk, true, Align::kLeft});
  const View view = fitView(rect, wholeMap(frame));
  LayerRow row(layer, Eigen::Affine2d::Identity(), view);
  canvas.paint(rect, [&](int y, std::uint32_t* out) {
    row.sample(y);
    for (int i = 0; i < rect.width; ++i) {
      out[i] = row.seen(i) > 0.5F ? map(range.strength(row.value(i))) : lightHatch(rect.x + i, y);
    }
  });
  canvas.frame(rect, {1.0, hexColour(0x8a9099), {}});
  drawScaleBar(canvas, view);
  drawNorth(canvas, view, scene.registration.maps.frames.turn);
  const double cells = static_cast<double>(layer.map().weight.size());
  canvas.text(
      {static_cast<double>(rect.x), rect.y + rect.height + 19.0},
      fmt::format("{:.1f} × {:.1f} m, cells of {:.3g} cm, {:.0f} % seen, {} points",
                  frame.cols * frame.cell, frame.rows * frame.cell, 100.0 * frame.cell,
                  100.0 * static_cast<double>(layer.map().filled) / cells, layer.map().points),
      {13.0, palette::kFaint, false, Align::kLeft});
}

void drawColourBar(PictureCanvas& canvas, const Scene& scene, const ValueRange& range,
                   const SoilToLeaf& map, int top) {
  const PixelRect bar{kMargin + 170, top, 460, 16};
  canvas.text({kMargin, top + 13.0},
              scene.value == PictureValue::kExg ? "Excess Green" : "Height above ground [m]",
              {13.0, palette::kInk, true, Align::kLeft});
  canvas.paint(bar, [&](int, std::uint32_t* out) {
    for (int i = 0; i < bar.width; ++i) {
      out[i] = map(static_cast<float>(i) / static_cast<float>(bar.width - 1));
    }
  });
  canvas.frame(bar, {1.0, hexColour(0x8a9099), {}});
  constexpr int kTicks = 5;
  for (int i = 0; i < kTicks; ++i) {
    const double share = static_cast<double>(i) / (kTicks - 1);
    canvas.text({bar.x + share * bar.width, top + 32.0},
                fmt::format("{:.2f}", range.low + share * (range.high - range.low)),
                {12.0, palette::kFaint, false, Align::kCentre});
  }
  const PixelRect hatch{bar.x + bar.width + 60, top, 26, 16};
  canvas.paint(hatch, [&](int y, std::uint32_t* out) {
    for (int i = 0; i < hatch.width; ++i) out[i] = lightHatch(hatch.x + i, y);
  });
  canvas.text({hatch.x + 34.0, top + 13.0}, "no data", {13.0});
}

}  // namespace

void writeMapsPicture(const io::OutputPath& path, const Scene& scene) {
  const GroundRect fixed = wholeMap(scene.fixed.map().frame);
  const GroundRect moving = wholeMap(scene.moving.map().frame);
  const int height = std::max(panelFor(fixed, 0, 0).height, panelFor(moving, 0, 0).height);
  Page page(kTitleRoom + height + kCaptionRoom + kBarRoom,
            fmt::format("{} of the two maps", scene.valueName()),
            "Each levelled and gridded; the moving map as the initial guess lays it",
            scene.registration.verdict, false);
  const ValueRange range{std::min(scene.fixed.quantile(0.01), scene.moving.quantile(0.01)),
                         std::max(scene.fixed.quantile(0.99), scene.moving.quantile(0.99)) + 1e-6};
  const SoilToLeaf map;
  const int top = page.top + kTitleRoom;
  drawMap(page.canvas, scene, scene.fixed, range, map, panelFor(fixed, kMargin, top),
          "Fixed: " + scene.info.fixed_name);
  drawMap(page.canvas, scene, scene.moving, range, map,
          panelFor(moving, kMargin + kPanelWidth + kGap, top), "Moving: " + scene.info.moving_name);
  drawColourBar(page.canvas, scene, range, map, top + height + kCaptionRoom + 10);
  page.canvas.write(path);
}

}  // namespace agricolmap::report
