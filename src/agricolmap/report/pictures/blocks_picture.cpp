// blocks.png: the evidence. Each block of the moving map is placed alone near where the
// registration predicts it; if the registration is right, most find the predicted place.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/pictures/picture_kinds.hpp"

namespace agricolmap::report {
namespace {

constexpr double kRim = 0.4;  // of ground around the strip [m]
constexpr int kMaxPanelHeight = 620;
constexpr int kLegendRoom = 40;
constexpr int kLine = 22;
constexpr Colour kAgrees = hexColour(0x3ff07a);
constexpr Colour kDisagrees = hexColour(0xff5a4f);

/// How many times longer than true the offsets are drawn: the limit of agreement should fill a
/// good part of a block.
double exaggeration(const verdict::EvidenceOptions& options) {
  return std::max(1.0, std::floor(0.35 * options.block / options.agreement));
}

/// Turned like the blocks; the outline and every block with a rim.
GroundRect blocksGround(const Scene& scene) {
  const pipeline::Registration& result = scene.registration;
  GroundRect ground;
  ground.axes.col(0) = (result.placed->pose.linear() * scene.block_strip.axes.col(0)).normalized();
  if (ground.axes(0, 0) < 0.0) ground.axes.col(0) = -ground.axes.col(0);
  ground.axes.col(1) = Eigen::Vector2d(-ground.axes(1, 0), ground.axes(0, 0));
  map::Box2 box;
  for (const Eigen::Vector2d& corner : scene.outlineUnder(result.placed->pose)) {
    box.extend((ground.axes.transpose() * corner).eval());
  }
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * scene.info.evidence.block);
  for (const verdict::BlockEvidence& block : result.placed->evidence.blocks) {
    const Eigen::Vector2d local = ground.axes.transpose() * block.place;
    box.extend((local - half).eval());
    box.extend((local + half).eval());
  }
  ground.centre = ground.axes * box.center();
  ground.half_extent = 0.5 * box.sizes();
  return ground.grown(kRim);
}

std::uint32_t dimGrey(float strength) {
  const int grey = 40 + static_cast<int>(70.0F * strength);
  return packPixel(grey, grey, grey);
}

void drawBlock(PictureCanvas& canvas, const Scene& scene, const View& view,
               const verdict::BlockEvidence& block, const Eigen::Vector2d& size) {
  const Colour colour = block.agrees ? kAgrees : kDisagrees;
  const Eigen::Matrix2d linear = scene.registration.placed->pose.linear() * scene.block_strip.axes;
  std::array<Eigen::Vector2d, 4> corners;
  constexpr std::array<std::array<double, 2>, 4> kSigns = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d local(0.47 * kSigns[i][0] * size.x(), 0.47 * kSigns[i][1] * size.y());
    corners[i] = view.pixel(block.place + linear * local);
  }
  canvas.fillPolygon(corners, {colour.r, colour.g, colour.b, 0.10});
  canvas.polygon(corners, {1.5, {colour.r, colour.g, colour.b, 0.8}, {}});
  const double times = exaggeration(scene.info.evidence);
  const Eigen::Vector2d tail = view.pixel(block.place);
  canvas.circle(tail, times * scene.info.evidence.agreement * view.scale,
                {1.0, hexColour(0xffffff, 0.6), {4.0, 4.0}});
  const Eigen::Vector2d head = view.pixel(block.place + times * block.offset);
  canvas.arrow(tail, head, {4.5, hexColour(0x000000, 0.6), {}});
  canvas.arrow(tail, head, {2.5, colour, {}});
  canvas.disc(tail, 3.0, colour);
}

std::vector<std::pair<std::string, std::string>> figures(const pipeline::Registration& result) {
  const verdict::Evidence& evidence = result.placed->evidence;
  return {{"blocks that agree", fmt::format("{} of {}", evidence.agreeing, evidence.blocks.size())},
          {"uniqueness (peak / next peak)", fmt::format("{:.2f}", evidence.uniqueness)},
          {"significance (peak / deviation)", fmt::format("{:.1f}", evidence.significance)},
          {"probability of being right", verdict::percentOf(result.verdict.plane_probability)},
          {"heights", toString(result.verdict.heights.status)},
          {"overlap", fmt::format("{:.0f} %", 100.0 * result.placed->overlap)},
          {"correlation", fmt::format("{:.2f}", result.placed->correlation)}};
}

const char* headline(verdict::Status status) {
  switch (status) {
    case verdict::Status::kAccepted:
      return "Accepted, because";
    case verdict::Status::kAmbiguous:
      return "Ambiguous, because";
    case verdict::Status::kRejected:
      break;
  }
  return "Rejected, because";
}

void drawText(PictureCanvas& canvas, const Scene& scene, int top) {
  const pipeline::Registration& result = scene.registration;
  double y = top + 14.0;
  for (const auto& [name, value] : figures(result)) {
    canvas.text({kMargin, y}, name, {13.0, palette::kFaint});
    canvas.text({kMargin + 330.0, y}, value, {13.0, palette::kInk, true, Align::kRight});
    y += kLine;
  }
  const bool accepted = result.verdict.status == verdict::Status::kAccepted;
  const double left = kMargin + 400.0;
  y = top + 14.0;
  canvas.text({left, y}, headline(result.verdict.status),
              {14.0, accepted ? palette::kGood : palette::kBad, true, Align::kLeft});
  for (const std::string& reason : result.verdict.reasons) {
    y += kLine;
    const auto lines = canvas.wrapped("• " + reason, kPageWidth - kMargin - left, {13.0});
    canvas.text({left, y}, lines.empty() ? "" : lines.front() + (lines.size() > 1 ? " …" : ""),
                {13.0});
  }
}

}  // namespace

void writeBlocksPicture(const io::OutputPath& path, const Scene& scene) {
  const pipeline::Registration& result = scene.registration;
  const GroundRect ground = blocksGround(scene);
  const int height =
      std::clamp(static_cast<int>(kInnerWidth / ground.aspect()), 120, kMaxPanelHeight);
  const int text_lines =
      static_cast<int>(std::max(figures(result).size(), result.verdict.reasons.size() + 1));
  Page page(height + kLegendRoom + kLine * text_lines + kMargin,
            "Evidence: blocks of the moving map, each placed alone",
            fmt::format("A block agrees when its best place is within {:g} cm of where the "
                        "registration predicts it",
                        100.0 * scene.info.evidence.agreement),
            result.verdict, true);
  PictureCanvas& canvas = page.canvas;
  const View view = fitView({kMargin, page.top, kInnerWidth, height}, ground);
  paintGround(canvas, scene, view, dimGrey);
  {
    const PictureCanvas::Clip clip(canvas, view.rect);
    const Eigen::Vector2d& size = result.placed->evidence.block_size;
    for (const verdict::BlockEvidence& block : result.placed->evidence.blocks) {
      drawBlock(canvas, scene, view, block, size);
    }
  }
  if (result.placed->evidence.blocks.empty()) {
    canvas.text(view.rect.middle(), "no block is seen well enough in both maps",
                {16.0, hexColour(0xffffff), true, Align::kCentre});
  }
  drawScaleBar(canvas, view);
  drawNorth(canvas, view, scene.registration.maps.frames.turn);
  const int below = page.top + height;
  drawLegend(canvas, {kMargin, below + 26.0},
             {{LegendItem::Kind::kArrow, kAgrees, "agrees", {}},
              {LegendItem::Kind::kArrow, kDisagrees, "disagrees", {}},
              {LegendItem::Kind::kLine, hexColour(0xffffff), "limit of agreement", {4.0, 4.0}},
              {LegendItem::Kind::kText,
               {},
               fmt::format("offsets drawn {:g} times as long", exaggeration(scene.info.evidence)),
               {}}},
             false);
  drawText(canvas, scene, below + kLegendRoom);
  canvas.write(path);
}

}  // namespace agricolmap::report
