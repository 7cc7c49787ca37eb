#include "agricolmap/report/pictures/change_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/change/distribution.hpp"
#include "agricolmap/core/round_step.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/draw/ramp.hpp"

namespace agricolmap::report {
namespace {

constexpr int kMapWidth = 860;
constexpr int kLeastHeight = 520;
constexpr int kMostHeight = 900;
constexpr int kSide = kMargin + kMapWidth + 2 * kGap;
constexpr int kSideWidth = kPageWidth - kMargin - kSide;
constexpr int kBins = 48;
constexpr Colour kUnsure = hexColour(0xb4b8be);
constexpr std::uint32_t kEmpty = 0xffffff;

/// Of a change in units of the reach.
std::uint32_t colourOf(double change) { return rampColour(kFallToRise, 0.5 * (change + 1.0)); }

/// The cells under one pixel: half-open, along one axis.
struct Span {
  int begin;
  int end;
};

Span spanOf(double low, double high, int count) {
  const int begin = std::clamp(static_cast<int>(std::floor(low)), 0, count - 1);
  return {begin, std::clamp(static_cast<int>(std::floor(high)), begin + 1, count)};
}

/// The mean of a pixel's cells whose change is significant where most of those compared are.
std::uint32_t pixelOf(const change::HeightChange& change, const Span& rows, const Span& cols,
                      double reach, int x, int y) {
  int compared = 0;
  int significant = 0;
  double sum = 0.0;
  for (int r = rows.begin; r < rows.end; ++r) {
    for (int c = cols.begin; c < cols.end; ++c) {
      const float value = change.change(r, c);
      if (std::isnan(value)) continue;
      ++compared;
      if (change.significant(r, c) <= 0.0F) continue;
      ++significant;
      sum += static_cast<double>(value);
    }
  }
  if (compared == 0) return kEmpty;
  return 2 * significant < compared ? lightHatch(x, y) : colourOf(sum / significant / reach);
}

void drawMap(PictureCanvas& canvas, const ChangeScene& scene, const View& view, double reach) {
  const GridFrame& frame = scene.frame;
  canvas.paint(view.rect, [&](int y, std::uint32_t* row) {
    const auto cellAt = [&](double px, double py) {
      return Eigen::Vector2d((view.ground({px, py}) - frame.corner) / frame.cell);
    };
    for (int i = 0; i < view.rect.width; ++i) {
      const Eigen::Vector2d low = cellAt(view.rect.x + i, y + 1.0);
      const Eigen::Vector2d high = cellAt(view.rect.x + i + 1.0, y);
      const Eigen::Vector2d middle = 0.5 * (low + high);
      const bool within =
          (middle.array() >= 0.0).all() && middle.x() < frame.cols && middle.y() < frame.rows;
      row[i] = within ? pixelOf(scene.change, spanOf(low.y(), high.y(), frame.rows),
                                spanOf(low.x(), high.x(), frame.cols), reach, view.rect.x + i, y)
                      : kEmpty;
    }
  });
  canvas.frame(view.rect, {1.0, palette::kFaint, {}});
  drawScaleBar(canvas, view);
  drawNorth(canvas, view);
}

void drawColourBar(PictureCanvas& canvas, const PixelRect& bar, const std::string& quantity) {
  canvas.text({static_cast<double>(bar.x), bar.y - 8.0}, quantity,
              {13.0, palette::kInk, true, Align::kLeft});
  canvas.paint(bar, [&](int /*y*/, std::uint32_t* row) {
    for (int i = 0; i < bar.width; ++i) row[i] = colourOf(2.0 * (i + 0.5) / bar.width - 1.0);
  });
  canvas.frame(bar, {1.0, palette::kFaint, {}});
}

/// Marks below `rect`, which spans twice the reach.
void drawMarks(PictureCanvas& canvas, const PixelRect& rect, double reach) {
  const double step = roundStep(2.0 * reach);
  const double bottom = rect.y + rect.height;
  for (int i = static_cast<int>(std::ceil(-reach / step)); i * step <= reach * 1.0001; ++i) {
    const double x = rect.x + rect.width * 0.5 * (1.0 + i * step / reach);
    canvas.lines(std::array<Eigen::Vector2d, 2>{{{x, bottom}, {x, bottom + 4.0}}},
                 {1.0, palette::kFaint, {}});
    canvas.text({x, bottom + 17.0}, fmt::format("{:g}", std::round(1e4 * i * step) / 100.0),
                {12.0, palette::kFaint, false, Align::kCentre});
  }
}

/// Cells by their change; in grey those that are not significant.
void drawHistogram(PictureCanvas& canvas, const PixelRect& rect,
                   const change::HeightChange& change) {
  const change::Distribution cells = change::distributionOf(change, kBins);
  double most = 1.0;
  for (const change::Distribution::Bin& bin : cells.bins)
    most = std::max(most, bin.sure + bin.unsure);
  canvas.text({static_cast<double>(rect.x), rect.y - 8.0}, "cells by their change",
              {13.0, palette::kInk, true, Align::kLeft});
  const auto edge = [&](int i) { return rect.x + i * rect.width / kBins; };
  for (int i = 0; i < kBins; ++i) {
    const change::Distribution::Bin& bin = cells.bins[static_cast<std::size_t>(i)];
    const int sure = static_cast<int>(std::lround(rect.height * bin.sure / most));
    const int all = static_cast<int>(std::lround(rect.height * (bin.sure + bin.unsure) / most));
    const int bottom = rect.y + rect.height;
    const int width = edge(i + 1) - edge(i);
    canvas.fill({edge(i), bottom - all, width, all - sure}, kUnsure);
    canvas.fill({edge(i), bottom - sure, width, sure},
                hexColour(colourOf(2.0 * (i + 0.5) / kBins - 1.0)));
  }
  const double base = rect.y + rect.height;
  canvas.lines(std::array<Eigen::Vector2d, 2>{{{1.0 * rect.x, base}, {1.0 * edge(kBins), base}}},
               {1.0, palette::kFaint, {}});
  drawMarks(canvas, rect, cells.reach);
}

void drawSide(PictureCanvas& canvas, const ChangeScene& scene, int top, double reach) {
  const PixelRect bar{kSide, top + 20, kSideWidth, 18};
  drawColourBar(canvas, bar, scene.quantity);
  drawMarks(canvas, bar, reach);
  if (scene.levels) {
    const PixelRect key{kSide, top + 72, 26, 15};
    canvas.paint(key, [&](int y, std::uint32_t* row) {
      for (int i = 0; i < key.width; ++i) row[i] = lightHatch(key.x + i, y);
    });
    canvas.frame(key, {1.0, hexColour(0x8a9099), {}});
    canvas.text({kSide + 34.0, top + 84.0}, "no more than its errors (95 %)", {});
  }
  canvas.frame({kSide, top + 96, 26, 15}, {1.0, hexColour(0x8a9099), {}});
  canvas.text({kSide + 34.0, top + 108.0}, "not compared", {});
  drawHistogram(canvas, {kSide, top + 154, kSideWidth, 130}, scene.change);
  double y = top + 340.0;
  for (const std::string& fact : scene.facts) {
    for (const std::string& line : canvas.wrapped(fact, kSideWidth, {})) {
      canvas.text({kSide, y}, line, {});
      y += 19.0;
    }
    y += 3.0;
  }
}

}  // namespace

void writeChangePicture(const io::OutputPath& path, const ChangeScene& scene) {
  const GridFrame& frame = scene.frame;
  const Eigen::Vector2d half = 0.5 * frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  const GroundRect ground{frame.corner + half, Eigen::Matrix2d::Identity(), half};
  const int height = static_cast<int>(
      std::clamp(kMapWidth / ground.aspect(), 1.0 * kLeastHeight, 1.0 * kMostHeight));
  // Nobody judged anything: no banner.
  verdict::Verdict none;
  none.status = verdict::Status::kAccepted;
  Page page(height + kMargin, "Change between two maps", scene.subtitle, none, false);
  const View view = fitView({kMargin, page.top, kMapWidth, height}, ground);
  const double reach = change::reachOf(scene.change.change);
  drawMap(page.canvas, scene, view, reach);
  drawSide(page.canvas, scene, page.top, reach);
  page.canvas.write(path);
}

}  // namespace agricolmap::report
