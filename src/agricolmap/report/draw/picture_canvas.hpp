// A picture in memory and the few things drawn on it. Pixel coordinates: x right, y down.
#pragma once

#include <cairo.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/output/output_path.hpp"
namespace agricolmap::report {

struct Colour {
  double r = 0.0;  ///< 0…1
  double g = 0.0;
  double b = 0.0;
  double a = 1.0;
};

/// 0xRRGGBB as a colour.
constexpr Colour hexColour(std::uint32_t rgb, double alpha = 1.0) {
  return {((rgb >> 16) & 255U) / 255.0, ((rgb >> 8) & 255U) / 255.0, (rgb & 255U) / 255.0, alpha};
}

struct PixelRect {
  int x = 0;  ///< left
  int y = 0;  ///< top
  int width = 0;
  int height = 0;
  Eigen::Vector2d middle() const { return {x + 0.5 * width, y + 0.5 * height}; }
};

enum class Align { kLeft, kCentre, kRight };

struct TextStyle {
  double size = 13.0;  ///< [px]
  Colour colour = hexColour(0x22272e);
  bool bold = false;
  Align align = Align::kLeft;
};

struct Stroke {
  double width = 1.0;  ///< [px]
  Colour colour;
  std::vector<double> dashes;  ///< on, off, … [px]; empty = solid
};

class PictureCanvas {
 public:
  PictureCanvas(int width, int height, const Colour& background);

  int width() const { return width_; }
  int height() const { return height_; }

  void fill(const PixelRect& rect, const Colour& colour);
  void frame(const PixelRect& rect, const Stroke& stroke);
  /// Many separate lines in one go; `ends` holds pairs.
  void lines(std::span<const Eigen::Vector2d> ends, const Stroke& stroke);
  void polygon(std::span<const Eigen::Vector2d> corners, const Stroke& stroke);
  void fillPolygon(std::span<const Eigen::Vector2d> corners, const Colour& colour);
  void circle(const Eigen::Vector2d& centre, double radius, const Stroke& stroke);
  void disc(const Eigen::Vector2d& centre, double radius, const Colour& colour);
  /// A line with a solid head, whose size follows the stroke's width; short ones get a small head.
  void arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Stroke& stroke);

  /// `at`: on the baseline. `text` need not be valid UTF-8.
  void text(const Eigen::Vector2d& at, std::string_view text, const TextStyle& style);
  double textWidth(std::string_view text, const TextStyle& style);
  /// `text` cut at the front so that it fits: the ends of paths say more than their beginnings.
  std::string elided(std::string_view text, double width, const TextStyle& style);
  /// `text` broken at spaces into lines of at most `width`.
  std::vector<std::string> wrapped(std::string_view text, double width, const TextStyle& style);

  /// While it lives nothing is drawn outside `rect`.
  class Clip {
   public:
    Clip(PictureCanvas& canvas, const PixelRect& rect);
    ~Clip();
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;

   private:
    cairo_t* context_;
  };

  /// Calls `shade(y, row)` for each row of `rect`, top first; `row` points to its leftmost pixel,
  /// 0x00RRGGBB. `rect` must lie on the canvas.
  template <typename Shade>
  void paint(const PixelRect& rect, const Shade& shade) {
    cairo_surface_flush(surface_.get());
    for (int y = rect.y; y < rect.y + rect.height; ++y) shade(y, pixelRow(y) + rect.x);
    cairo_surface_mark_dirty_rectangle(surface_.get(), rect.x, rect.y, rect.width, rect.height);
  }

  /// The picture as a PNG file. Throws OutputError.
  void write(const io::OutputPath& path);

 private:
  struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
  };
  std::uint32_t* pixelRow(int y);
  void setStroke(const Stroke& stroke);
  void setFont(const TextStyle& style);

  int width_;
  int height_;
  std::unique_ptr<cairo_surface_t, Destroy> surface_;
  std::unique_ptr<cairo_t, Destroy> context_;
};

}  // namespace agricolmap::report
