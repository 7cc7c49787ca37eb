#include "agricolmap/report/draw/picture_canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/report/draw/png_file.hpp"
#include "agricolmap/report/json/utf8.hpp"

namespace agricolmap::report {
namespace {

void setColour(cairo_t* context, const Colour& colour) {
  cairo_set_source_rgba(context, colour.r, colour.g, colour.b, colour.a);
}

void addPath(cairo_t* context, std::span<const Eigen::Vector2d> corners) {
  for (const Eigen::Vector2d& p : corners) cairo_line_to(context, p.x(), p.y());
  cairo_close_path(context);
}

}  // namespace

PictureCanvas::PictureCanvas(int width, int height, const Colour& background)
    : width_(width),
      height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
      context_(cairo_create(surface_.get())) {
  if (cairo_status(context_.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  fill({0, 0, width, height}, background);
}

std::uint32_t* PictureCanvas::pixelRow(int y) {
  unsigned char* data = cairo_image_surface_get_data(surface_.get());
  void* row =
      data + static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface_.get());
  return static_cast<std::uint32_t*>(row);
}

void PictureCanvas::setStroke(const Stroke& stroke) {
  setColour(context_.get(), stroke.colour);
  cairo_set_line_width(context_.get(), stroke.width);
  cairo_set_dash(context_.get(), stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0.0);
}

void PictureCanvas::fill(const PixelRect& rect, const Colour& colour) {
  setColour(context_.get(), colour);
  cairo_rectangle(context_.get(), rect.x, rect.y, rect.width, rect.height);
  cairo_fill(context_.get());
}

void PictureCanvas::frame(const PixelRect& rect, const Stroke& stroke) {
  setStroke(stroke);
  cairo_rectangle(context_.get(), rect.x - 0.5, rect.y - 0.5, rect.width + 1.0, rect.height + 1.0);
  cairo_stroke(context_.get());
}

void PictureCanvas::lines(std::span<const Eigen::Vector2d> ends, const Stroke& stroke) {
  setStroke(stroke);
  // Stroked one by one: a path of hundreds of lines costs cairo the square of their number.
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    cairo_move_to(context_.get(), ends[i].x(), ends[i].y());
    cairo_line_to(context_.get(), ends[i + 1].x(), ends[i + 1].y());
    cairo_stroke(context_.get());
  }
}

void PictureCanvas::polygon(std::span<const Eigen::Vector2d> corners, const Stroke& stroke) {
  setStroke(stroke);
  addPath(context_.get(), corners);
  cairo_stroke(context_.get());
}

void PictureCanvas::fillPolygon(std::span<const Eigen::Vector2d> corners, const Colour& colour) {
  setColour(context_.get(), colour);
  addPath(context_.get(), corners);
  cairo_fill(context_.get());
}

void PictureCanvas::circle(const Eigen::Vector2d& centre, double radius, const Stroke& stroke) {
  setStroke(stroke);
  cairo_new_sub_path(context_.get());
  cairo_arc(context_.get(), centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
  cairo_stroke(context_.get());
}

void PictureCanvas::disc(const Eigen::Vector2d& centre, double radius, const Colour& colour) {
  setColour(context_.get(), colour);
  cairo_new_sub_path(context_.get());
  cairo_arc(context_.get(), centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
  cairo_fill(context_.get());
}

void PictureCanvas::arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                          const Stroke& stroke) {
  const double length = (to - from).norm();
  if (!(length > 0.5)) return;
  const Eigen::Vector2d along = (to - from) / length;
  const Eigen::Vector2d side(-along.y(), along.x());
  const double head = std::min(3.0 + 3.0 * stroke.width, 0.6 * length);
  const Eigen::Vector2d neck = to - head * along;
  lines(std::array{from, neck}, stroke);
  fillPolygon(std::array{to, Eigen::Vector2d(neck + 0.45 * head * side),
                         Eigen::Vector2d(neck - 0.45 * head * side)},
              stroke.colour);
}

void PictureCanvas::setFont(const TextStyle& style) {
  cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context_.get(), style.size);
}

void PictureCanvas::text(const Eigen::Vector2d& at, std::string_view text, const TextStyle& style) {
  const std::string valid = validUtf8(text);
  const double shift = style.align == Align::kLeft     ? 0.0
                       : style.align == Align::kCentre ? 0.5
                                                       : 1.0;
  const double left = at.x() - shift * (shift > 0.0 ? textWidth(valid, style) : 0.0);
  setFont(style);
  setColour(context_.get(), style.colour);
  cairo_move_to(context_.get(), std::round(left), std::round(at.y()));
  cairo_show_text(context_.get(), valid.c_str());
  cairo_new_path(context_.get());
}

double PictureCanvas::textWidth(std::string_view text, const TextStyle& style) {
  setFont(style);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), validUtf8(text).c_str(), &extents);
  return extents.x_advance;
}

std::string PictureCanvas::elided(std::string_view text, double width, const TextStyle& style) {
  std::string rest = validUtf8(text);
  if (textWidth(rest, style) <= width) return rest;
  const auto isContinuation = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  while (!rest.empty() && textWidth("…" + rest, style) > width) {
    std::size_t next = 1;
    while (next < rest.size() && isContinuation(rest[next])) ++next;
    rest.erase(0, next);
  }
  return "…" + rest;
}

std::vector<std::string> PictureCanvas::wrapped(std::string_view text, double width,
                                                const TextStyle& style) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word(text.substr(begin, end - begin));
    const std::string longer = line.empty() ? word : fmt::format("{} {}", line, word);
    if (!line.empty() && textWidth(longer, style) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
    begin = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

PictureCanvas::Clip::Clip(PictureCanvas& canvas, const PixelRect& rect)
    : context_(canvas.context_.get()) {
  cairo_save(context_);
  cairo_rectangle(context_, rect.x, rect.y, rect.width, rect.height);
  cairo_clip(context_);
}

PictureCanvas::Clip::~Clip() { cairo_restore(context_); }

void PictureCanvas::write(const io::OutputPath& path) {
  const cairo_status_t status = cairo_status(context_.get());
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) {
    throw OutputError(
        fmt::format("{}: cannot be drawn: {}", path.shown(), cairo_status_to_string(status)));
  }
  cairo_surface_flush(surface_.get());
  const std::size_t stride =
      static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get())) /
      sizeof(std::uint32_t);
  const std::vector<std::uint8_t> png = encodePng(pixelRow(0), width_, height_, stride);
  io::FileSink sink(path);
  sink.write(std::as_bytes(std::span(png)));
  sink.close();
}

}  // namespace agricolmap::report
