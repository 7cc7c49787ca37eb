// flow.png: how the registration moves the moving map, and the matches that say so.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/report/counts.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/pictures/picture_kinds.hpp"

namespace agricolmap::report {
namespace {

constexpr int kPanelWidth = 920;
constexpr int kMaxPanelHeight = 760;
constexpr int kMinPanelHeight = 320;
constexpr double kRim = 1.5;  // of ground around what moves [m]
constexpr std::size_t kMaxMatches = 400;
constexpr std::size_t kMaxWinners = 160;
constexpr Colour kMatchColour = hexColour(0xffdf40, 0.55);
constexpr Colour kWinnerColour = hexColour(0x3ff07a, 0.9);

/// What the picture must show: both outlines with a rim.
GroundRect region(const Scene& scene) {
  map::Box2 box;
  for (const auto& corner : scene.outlineUnder(Eigen::Affine2d::Identity())) box.extend(corner);
  if (scene.registration.transform.has_value()) {
    for (const auto& corner : scene.outlineUnder(scene.registration.placed->pose))
      box.extend(corner);
  }
  return GroundRect{box.center(), Eigen::Matrix2d::Identity(), 0.5 * box.sizes()}.grown(kRim);
}

std::uint32_t dimGreen(float strength) {
  return packPixel(42 + static_cast<int>(34.0F * strength), 40 + static_cast<int>(70.0F * strength),
                   38 + static_cast<int>(24.0F * strength));
}

/// Every how many-th of `size` matches is drawn, so that at most about `limit` are.
std::size_t stride(std::size_t size, std::size_t limit) { return (size + limit - 1) / limit; }

/// Ends of the lines of some matches, evenly through the list (which is ordered by place).
std::vector<Eigen::Vector2d> lineEnds(const std::vector<Match>& matches, std::size_t limit,
                                      const View& view) {
  std::vector<Eigen::Vector2d> ends;
  for (std::size_t i = 0; i < matches.size(); i += stride(matches.size(), limit)) {
    ends.push_back(view.pixel(matches[i].moving));
    ends.push_back(view.pixel(matches[i].fixed));
  }
  return ends;
}

void drawMatches(PictureCanvas& canvas, const Scene& scene, const View& view) {
  canvas.lines(lineEnds(scene.registration.trace.located.matches, kMaxMatches, view),
               {1.0, kMatchColour, {}});
  const auto ends = lineEnds(scene.winningMatches(), kMaxWinners, view);
  canvas.lines(ends, {1.4, kWinnerColour, {}});
  for (std::size_t i = 1; i < ends.size(); i += 2) canvas.disc(ends[i], 2.5, kWinnerColour);
}

/// From where the guess puts points of the strip to where the registration puts them.
void drawFlow(PictureCanvas& canvas, const Scene& scene, const View& view) {
  const GroundRect& strip = scene.strip;
  const int along = std::clamp(static_cast<int>(strip.half_extent.x() * view.scale / 60.0), 2, 9);
  const int across = std::clamp(static_cast<int>(strip.half_extent.y() * view.scale / 60.0), 1, 9);
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      const Eigen::Vector2d local((2.0 * i + 1.0) / along - 1.0, (2.0 * j + 1.0) / across - 1.0);
      const Eigen::Vector2d from =
          strip.centre + strip.axes * local.cwiseProduct(strip.half_extent);
      const Eigen::Vector2d tail = view.pixel(from);
      const Eigen::Vector2d head = view.pixel(scene.registration.placed->pose * from);
      canvas.arrow(tail, head, {4.0, hexColour(0x000000, 0.55), {}});
      canvas.arrow(tail, head, {2.2, palette::kAfter, {}});
    }
  }
}

void drawOutline(PictureCanvas& canvas, const View& view,
                 const std::vector<Eigen::Vector2d>& ground, const Stroke& stroke) {
  std::vector<Eigen::Vector2d> corners(ground.size());
  std::transform(ground.begin(), ground.end(), corners.begin(),
                 [&](const Eigen::Vector2d& p) { return view.pixel(p); });
  canvas.polygon(corners, {stroke.width + 2.0, hexColour(0x000000, 0.5), {}});
  canvas.polygon(corners, stroke);
}

std::string matchText(std::size_t size, std::size_t limit, const char* what) {
  const std::size_t step = stride(size, limit);
  return step > 1 ? fmt::format("{} {}, 1 in {} drawn", size, what, step)
                  : fmt::format("{} {}", size, what);
}

void drawSidebar(PictureCanvas& canvas, const Scene& scene, int x, int top) {
  const pipeline::Registration& result = scene.registration;
  std::vector<LegendItem> items = {
      {LegendItem::Kind::kLine, palette::kBefore, "moving map by the guess", {6.0, 4.0}}};
  if (result.transform.has_value()) {
    items.push_back({LegendItem::Kind::kLine, palette::kAfter, "moving map registered", {}});
    items.push_back({LegendItem::Kind::kArrow, palette::kAfter, "how it was moved", {}});
  }
  if (!result.trace.located.matches.empty()) {
    items.push_back({LegendItem::Kind::kLine,
                     kMatchColour,
                     matchText(result.trace.located.matches.size(), kMaxMatches, "matches"),
                     {}});
  }
  if (!scene.winningMatches().empty()) {
    items.push_back({LegendItem::Kind::kLine,
                     kWinnerColour,
                     matchText(scene.winningMatches().size(), kMaxWinners, "winning matches"),
                     {}});
  }
  drawLegend(canvas, {static_cast<double>(x), top + 13.0}, items, true);
  double y = top + 24.0 * static_cast<double>(items.size()) + 34.0;
  const auto say = [&](const std::string& name, const std::string& value) {
    canvas.text({static_cast<double>(x), y}, name, {13.0, palette::kFaint});
    canvas.text({kPageWidth - kMargin, y}, value, {13.0, palette::kInk, true, Align::kRight});
    y += 22.0;
  };
  if (result.transform.has_value()) {
    say("shift", fmt::format("{:.3f} m", result.transform->shift.head<2>().norm()));
    say("   x, y", fmt::format("{:+.3f}, {:+.3f} m", result.transform->shift.x(),
                               result.transform->shift.y()));
    say("   up", fmt::format("{:+.3f} m", result.transform->shift.z()));
    say("heading", fmt::format("{:+.2f}°", degrees(result.transform->parts.yaw)));
    say("scale x, y", fmt::format("{:.3f}, {:.3f}", result.transform->parts.scale_x,
                                  result.transform->parts.scale_y));
    y += 10.0;
  }
  for (const auto& [name, count] : countsOf(result)) {
    std::string words = name;
    std::replace(words.begin(), words.end(), '_', ' ');
    say(words,
        count == std::floor(count) ? fmt::format("{:.0f}", count) : fmt::format("{:.2f}", count));
  }
}

}  // namespace

void writeFlowPicture(const io::OutputPath& path, const Scene& scene) {
  const pipeline::Registration& result = scene.registration;
  const GroundRect ground = region(scene);
  const int height =
      std::clamp(static_cast<int>(kPanelWidth / ground.aspect()), kMinPanelHeight, kMaxPanelHeight);
  Page page(height + kMargin, "Flow: from the initial guess to the registration",
            fmt::format("{} (moving) on {} (fixed)", scene.info.moving_name, scene.info.fixed_name),
            result.verdict, true);
  PictureCanvas& canvas = page.canvas;
  const View view = fitView({kMargin, page.top, kPanelWidth, height}, ground);
  paintGround(canvas, scene, view, dimGreen);
  {
    const PictureCanvas::Clip clip(canvas, view.rect);
    drawMatches(canvas, scene, view);
    drawOutline(canvas, view, scene.outlineUnder(Eigen::Affine2d::Identity()),
                {2.0, palette::kBefore, {9.0, 6.0}});
    if (result.transform.has_value()) {
      drawOutline(canvas, view, scene.outlineUnder(result.placed->pose),
                  {2.0, palette::kAfter, {}});
      drawFlow(canvas, scene, view);
    }
  }
  drawScaleBar(canvas, view);
  drawNorth(canvas, view, scene.registration.maps.frames.turn);
  drawSidebar(canvas, scene, kMargin + kPanelWidth + kGap + 8, page.top);
  canvas.write(path);
}

}  // namespace agricolmap::report
