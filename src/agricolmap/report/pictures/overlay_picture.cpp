// overlay_before.png and overlay_after.png: both maps at once in complementary colours, so that
// what coincides is white and what does not shows coloured fringes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/pictures/picture_kinds.hpp"

namespace agricolmap::report {
namespace {

constexpr double kRim = 0.25;        // of ground around the strip [m]
constexpr double kWideAspect = 2.0;  // longer strips lie above the insets, others beside them
constexpr int kSquare = (kInnerWidth - 2 * kGap) / 3;
constexpr int kBigSide = kInnerWidth - kSquare - kGap;
constexpr int kLegendRoom = 44;
constexpr std::array<const char*, 2> kInsetNames = {"A", "B"};

class OverlayPainter {
 public:
  /// `strip`: the moving map, or what it is without the deformation that is followed.
  OverlayPainter(PictureCanvas& canvas, const Scene& scene, const MapLayer& strip,
                 const Eigen::Affine2d& pose)
      : canvas_(canvas),
        scene_(scene),
        strip_(strip),
        pose_(pose),
        moving_from_fixed_(pose.inverse()) {}

  void paint(const View& view) {
    LayerRow fixed(scene_.fixed, Eigen::Affine2d::Identity(), view);
    LayerRow moving(strip_, moving_from_fixed_, view);
    canvas_.paint(view.rect, [&](int y, std::uint32_t* out) {
      fixed.sample(y);
      moving.sample(y);
      for (int i = 0; i < view.rect.width; ++i) {
        const float f = fixed.seen(i) * scene_.fixed_range.strength(fixed.value(i));
        const float m = moving.seen(i) * scene_.moving_range.strength(moving.value(i));
        if (moving.seen(i) > 0.5F) {
          const int magenta = 16 + static_cast<int>(236.0F * f);
          const int green = 16 + static_cast<int>(236.0F * m);
          out[i] = packPixel(magenta, green, magenta);
        } else if (fixed.seen(i) > 0.5F) {
          const int grey = static_cast<int>(96.0F * f);
          out[i] = packPixel(34 + grey, 34 + grey * 9 / 10, 38 + grey);
        } else {
          out[i] = darkHatch(view.rect.x + i, y);
        }
      }
    });
  }

  void outline(const View& view, const Stroke& stroke) {
    const PictureCanvas::Clip clip(canvas_, view.rect);
    std::vector<Eigen::Vector2d> corners = scene_.outlineUnder(pose_);
    for (Eigen::Vector2d& corner : corners) corner = view.pixel(corner);
    canvas_.polygon(corners, stroke);
  }

  /// The ground that inset `i` shows, turned like the strip.
  GroundRect insetGround(std::size_t i) const {
    return {pose_ * scene_.insets[i], scene_.stripUnder(pose_).axes,
            Eigen::Vector2d::Constant(0.5 * kInsetSide)};
  }

  void markInsets(const View& view) {
    const PictureCanvas::Clip clip(canvas_, view.rect);
    for (std::size_t i = 0; i < scene_.insets.size(); ++i) {
      const Eigen::Vector2d middle = view.pixel(insetGround(i).centre);
      const int side = static_cast<int>(kInsetSide * view.scale);
      const PixelRect box{static_cast<int>(middle.x()) - side / 2,
                          static_cast<int>(middle.y()) - side / 2, side, side};
      canvas_.frame(box, {2.0, palette::kInset, {}});
      canvas_.text({box.x + 6.0, box.y + 18.0}, kInsetNames[i],
                   {15.0, palette::kInset, true, Align::kLeft});
    }
  }

  void drawInset(const PixelRect& rect, std::size_t i) {
    const View view = fitView(rect, insetGround(i));
    paint(view);
    canvas_.frame(rect, {2.0, palette::kInset, {}});
    drawPlate(canvas_, view,
              fmt::format("{}: {:g} × {:g} m", kInsetNames[i], kInsetSide, kInsetSide));
    drawScaleBar(canvas_, view);
    drawNorth(canvas_, view, scene_.registration.maps.frames.turn);
  }

  void drawStrip(const PixelRect& rect) {
    const View view = fitView(rect, scene_.stripUnder(pose_).grown(kRim));
    paint(view);
    outline(view, {1.0, hexColour(0xffffff, 0.7), {}});
    markInsets(view);
    drawScaleBar(canvas_, view);
    drawNorth(canvas_, view, scene_.registration.maps.frames.turn);
  }

  void drawOverview(const PixelRect& rect) {
    const GridFrame& frame = scene_.fixed.map().frame;
    map::Box2 box(frame.corner,
                  frame.corner + frame.cell * Eigen::Vector2d(frame.cols, frame.rows));
    for (const Eigen::Vector2d& corner : scene_.outlineUnder(pose_)) box.extend(corner);
    const View view = fitView(rect, {box.center(), Eigen::Matrix2d::Identity(), 0.5 * box.sizes()});
    paint(view);
    outline(view, {2.0, hexColour(0xffffff), {}});
    drawPlate(canvas_, view, "Whole map");
    drawScaleBar(canvas_, view);
    drawNorth(canvas_, view, scene_.registration.maps.frames.turn);
  }

 private:
  PictureCanvas& canvas_;
  const Scene& scene_;
  const MapLayer& strip_;
  Eigen::Affine2d pose_;
  Eigen::Affine2d moving_from_fixed_;
};

void drawFooter(PictureCanvas& canvas, int top) {
  drawLegend(canvas, {kMargin, top + 26.0},
             {{LegendItem::Kind::kSquare, hexColour(0xfc10fc), "only in the fixed map", {}},
              {LegendItem::Kind::kSquare, hexColour(0x10fc10), "only in the moving map", {}},
              {LegendItem::Kind::kSquare, hexColour(0xffffff), "in both", {}},
              {LegendItem::Kind::kSquare, hexColour(0x101010), "soil in both", {}},
              {LegendItem::Kind::kSquare, hexColour(0x646068), "moving map sees nothing", {}},
              {LegendItem::Kind::kHatch, {}, "no data", {}}},
             false);
}

std::string subtitle(const Scene& scene, bool after) {
  std::string names = fmt::format("{} on {}", scene.info.moving_name, scene.info.fixed_name);
  if (!after) return names;
  return fmt::format("{}; correlation {:.2f}, overlap {:.0f} %", describeMove(scene.registration),
                     scene.registration.placed->correlation,
                     100.0 * scene.registration.placed->overlap);
}

}  // namespace

void writeOverlayPicture(const io::OutputPath& path, const Scene& scene, bool after) {
  const Eigen::Affine2d pose =
      after ? scene.registration.placed->pose : Eigen::Affine2d::Identity();
  const double aspect = scene.stripUnder(pose).grown(kRim).aspect();
  const bool wide = aspect >= kWideAspect;
  const int strip_height =
      wide ? std::max(90, static_cast<int>(kInnerWidth / aspect))
           : std::max(2 * kSquare + kGap, std::min(kBigSide, static_cast<int>(kBigSide / aspect)));
  Page page(strip_height + (wide ? kGap + kSquare : 0) + kLegendRoom,
            after ? "After: the moving map where the registration puts it"
                  : "Before: the moving map where the initial guess puts it",
            subtitle(scene, after), scene.registration.verdict, after);
  const MapLayer& strip = after && scene.straight ? *scene.straight : scene.moving;
  OverlayPainter painter(page.canvas, scene, strip, pose);
  const int top = page.top;
  if (wide) {
    painter.drawStrip({kMargin, top, kInnerWidth, strip_height});
    const int below = top + strip_height + kGap;
    painter.drawOverview({kMargin, below, kSquare, kSquare});
    painter.drawInset({kMargin + kSquare + kGap, below, kSquare, kSquare}, 0);
    painter.drawInset({kMargin + 2 * (kSquare + kGap), below, kSquare, kSquare}, 1);
  } else {
    painter.drawStrip({kMargin, top, kBigSide, strip_height});
    painter.drawInset({kMargin + kBigSide + kGap, top, kSquare, kSquare}, 0);
    painter.drawInset({kMargin + kBigSide + kGap, top + kSquare + kGap, kSquare, kSquare}, 1);
  }
  drawFooter(page.canvas, page.canvas.height() - kLegendRoom);
  page.canvas.write(path);
}

}  // namespace agricolmap::report
