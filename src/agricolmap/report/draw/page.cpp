#include "agricolmap/report/draw/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

namespace agricolmap::report {
namespace {

constexpr int kHeader = 72;
constexpr int kBannerLine = 19;
constexpr std::size_t kMaxBannerLines = 6;
constexpr TextStyle kBannerText{14.0, hexColour(0xffffff), false, Align::kLeft};

std::vector<std::string> bannerLines(const verdict::Verdict& verdict) {
  if (verdict.status == verdict::Status::kAccepted) return {};
  PictureCanvas scratch(1, 1, {});
  std::vector<std::string> lines = scratch.wrapped(
      fmt::format("{}", fmt::join(verdict.reasons, "; ")), kInnerWidth - 165.0, kBannerText);
  if (lines.size() > kMaxBannerLines) {
    lines.resize(kMaxBannerLines);
    lines.back() += " …";
  }
  return lines;
}

int bannerHeight(std::size_t lines) {
  return lines == 0 ? 0 : static_cast<int>(lines) * kBannerLine + 12 + kGap;
}

/// The largest of 1, 2, 5 × 10ⁿ that is at most `limit`.
double roundLength(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= limit) return factor * power;
  }
  return power;
}

std::string lengthLabel(double metres) {
  return metres < 1.0 ? fmt::format("{:g} cm", 100.0 * metres) : fmt::format("{:g} m", metres);
}

}  // namespace

Page::Page(int content_height, const std::string& title, const std::string& subtitle,
           const verdict::Verdict& verdict, bool show_accepted)
    : canvas(kPageWidth, kHeader + bannerHeight(bannerLines(verdict).size()) + content_height,
             hexColour(0xffffff)) {
  canvas.text({kMargin, 34.0}, title, {21.0, palette::kInk, true, Align::kLeft});
  canvas.text({kMargin, 57.0}, canvas.elided(subtitle, kInnerWidth, {14.0}),
              {14.0, palette::kFaint, false, Align::kLeft});
  if (verdict.status == verdict::Status::kAccepted && show_accepted) {
    const PixelRect tag{kPageWidth - kMargin - 112, 15, 112, 26};
    canvas.fill(tag, palette::kGood);
    canvas.text({tag.middle().x(), 33.0}, "ACCEPTED",
                {15.0, hexColour(0xffffff), true, Align::kCentre});
  }
  top = kHeader;
  const std::vector<std::string> lines = bannerLines(verdict);
  if (lines.empty()) return;
  canvas.fill({0, kHeader, kPageWidth, bannerHeight(lines.size()) - kGap}, palette::kBad);
  double y = kHeader + 20.0;
  canvas.text({kMargin, y},
              verdict.status == verdict::Status::kAmbiguous ? "AMBIGUOUS" : "REJECTED",
              {17.0, hexColour(0xffffff), true, Align::kLeft});
  for (const std::string& line : lines) {
    canvas.text({kMargin + 145.0, y}, line, kBannerText);
    y += kBannerLine;
  }
  top += bannerHeight(lines.size());
}

void drawScaleBar(PictureCanvas& canvas, const View& view) {
  const double length = roundLength(0.2 * view.rect.width / view.scale);
  const double pixels = length * view.scale;
  const TextStyle style{12.0, palette::kInk, true, Align::kCentre};
  const std::string label = lengthLabel(length);
  const double width = std::max(pixels, canvas.textWidth(label, style));
  const PixelRect plate{view.rect.x + 8, view.rect.y + view.rect.height - 38,
                        static_cast<int>(width) + 20, 30};
  canvas.fill(plate, hexColour(0xffffff, 0.85));
  const double left = plate.middle().x() - 0.5 * pixels;
  const double y = plate.y + 23.0;
  canvas.text({plate.middle().x(), plate.y + 14.0}, label, style);
  const Stroke stroke{2.0, palette::kInk, {}};
  canvas.lines(std::array<Eigen::Vector2d, 6>{{{left, y},
                                               {left + pixels, y},
                                               {left, y - 4.0},
                                               {left, y + 4.0},
                                               {left + pixels, y - 4.0},
                                               {left + pixels, y + 4.0}}},
               stroke);
}

void drawNorth(PictureCanvas& canvas, const View& view, double turn) {
  const PixelRect plate{view.rect.x + view.rect.width - 48, view.rect.y + 8, 40, 40};
  canvas.fill(plate, hexColour(0xffffff, 0.85));
  const Eigen::Vector2d up = view.direction({-std::sin(turn), std::cos(turn)}).normalized();
  // The letter stands behind the arrow's tail side, the arrow points away from it.
  const Eigen::Vector2d middle = plate.middle();
  canvas.arrow(middle - 2.0 * up - 13.0 * up, middle + 3.0 * up, {2.0, palette::kInk, {}});
  canvas.text(middle + 11.0 * up + Eigen::Vector2d(0.0, 4.0), "N",
              {12.0, palette::kInk, true, Align::kCentre});
}

void drawPlate(PictureCanvas& canvas, const View& view, const std::string& text) {
  const TextStyle style{13.0, palette::kInk, true, Align::kLeft};
  const std::string fitting = canvas.elided(text, view.rect.width - 80.0, style);
  const int width = static_cast<int>(canvas.textWidth(fitting, style)) + 14;
  canvas.fill({view.rect.x + 8, view.rect.y + 8, width, 22}, hexColour(0xffffff, 0.85));
  canvas.text({view.rect.x + 15.0, view.rect.y + 24.0}, fitting, style);
}

double drawLegend(PictureCanvas& canvas, Eigen::Vector2d at, const std::vector<LegendItem>& items,
                  bool vertical) {
  const TextStyle style{13.0, palette::kInk, false, Align::kLeft};
  double end = at.x();
  for (const LegendItem& item : items) {
    const PixelRect key{static_cast<int>(at.x()), static_cast<int>(at.y()) - 12, 26, 15};
    const Eigen::Vector2d left(key.x + 2.0, key.middle().y());
    const Eigen::Vector2d right(key.x + 24.0, key.middle().y());
    switch (item.kind) {
      case LegendItem::Kind::kText:
        break;
      case LegendItem::Kind::kSquare:
        canvas.fill(key, item.colour);
        canvas.frame(key, {1.0, hexColour(0x8a9099), {}});
        break;
      case LegendItem::Kind::kHatch:
        canvas.paint(key, [&](int y, std::uint32_t* row) {
          for (int i = 0; i < key.width; ++i) row[i] = darkHatch(key.x + i, y);
        });
        break;
      case LegendItem::Kind::kLine:
      case LegendItem::Kind::kArrow:
        canvas.fill(key, hexColour(0x2b2e33));
        if (item.kind == LegendItem::Kind::kArrow) {
          canvas.arrow(left, right, {2.0, item.colour, {}});
        } else {
          canvas.lines(std::array{left, right}, {2.0, item.colour, item.dashes});
        }
        break;
    }
    const double indent = item.kind == LegendItem::Kind::kText ? 0.0 : 34.0;
    canvas.text({at.x() + indent, at.y()}, item.text, style);
    const double width = indent + canvas.textWidth(item.text, style);
    end = std::max(end, at.x() + width);
    if (vertical) {
      at.y() += 24.0;
    } else {
      at.x() += width + 24.0;
    }
  }
  return end;
}

}  // namespace agricolmap::report
