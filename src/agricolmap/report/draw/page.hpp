// A page: title, verdict and the furniture that maps on it need.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/report/draw/picture_canvas.hpp"
#include "agricolmap/report/draw/view.hpp"
#include "agricolmap/verdict/verdict.hpp"

namespace agricolmap::report {

inline constexpr int kPageWidth = 1280;
inline constexpr int kMargin = 24;  ///< [px]
inline constexpr int kInnerWidth = kPageWidth - 2 * kMargin;
inline constexpr int kGap = 16;  ///< between panels [px]

/// Colours that mean the same in all pictures.
namespace palette {
inline constexpr Colour kInk = hexColour(0x22272e);
inline constexpr Colour kFaint = hexColour(0x5b636e);
inline constexpr Colour kGood = hexColour(0x1a7f37);
inline constexpr Colour kBad = hexColour(0xc62828);
inline constexpr Colour kBefore = hexColour(0xff9f1c);
inline constexpr Colour kAfter = hexColour(0xffffff);
inline constexpr Colour kInset = hexColour(0xffe14d);
}  // namespace palette

/// A canvas with a header; below it lies `content_height` of room.
class Page {
 public:
  /// A rejection shows as a banner with its reasons; an acceptance, if `show_accepted`, as a tag:
  /// pictures of what was there before the registration carry none.
  Page(int content_height, const std::string& title, const std::string& subtitle,
       const verdict::Verdict& verdict, bool show_accepted);

  PictureCanvas canvas;
  int top = 0;  ///< where the room begins [px]
};

/// A bar of a round length with its label, in the lower left corner of the view.
void drawScaleBar(PictureCanvas& canvas, const View& view);
/// An arrow to the north, in the upper right corner of the view: the levelled y axis, or what is
/// `turn` [rad] counter-clockwise of it.
void drawNorth(PictureCanvas& canvas, const View& view, double turn = 0.0);
/// Text on a plate in the upper left corner of the view.
void drawPlate(PictureCanvas& canvas, const View& view, const std::string& text);

/// What a legend shows beside a text.
struct LegendItem {
  enum class Kind { kSquare, kLine, kArrow, kHatch, kText } kind = Kind::kSquare;
  Colour colour;
  std::string text;
  std::vector<double> dashes;
};
/// In a row from `at` (baseline); returns the x behind the last.
double drawLegend(PictureCanvas& canvas, Eigen::Vector2d at, const std::vector<LegendItem>& items,
                  bool vertical);

/// Packs 0…255 channels as the canvas stores pixels.
constexpr std::uint32_t packPixel(int r, int g, int b) {
  return (static_cast<std::uint32_t>(r) << 16) | (static_cast<std::uint32_t>(g) << 8) |
         static_cast<std::uint32_t>(b);
}
/// Diagonal stripes: nothing was seen here.
constexpr std::uint32_t lightHatch(int x, int y) { return ((x + y) & 7) < 2 ? 0xd3d5da : 0xececef; }
constexpr std::uint32_t darkHatch(int x, int y) { return ((x + y) & 7) < 2 ? 0x34383f : 0x25282e; }

}  // namespace agricolmap::report
