#include "svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace agricolmap::campaign {
namespace {

// Sizes in user units, pixels where nothing scales them.
constexpr double kPlotHeight = 190.0;
constexpr double kLeft = 62.0;  // of the first panel: room for the axis of y
constexpr double kGap = 26.0;   // between panels
constexpr double kRight = 18.0;
constexpr double kTop = 58.0;     // room for the legend and the panels' titles
constexpr double kBottom = 62.0;  // room for the axis of x and the note
constexpr double kLetter = 6.4;   // mean width of a letter of the labels
constexpr double kWholeWidth = 720.0;

// Hues that differ in lightness, too, and stand out from white and from black.
const char* classOf(PlotColour colour) {
  switch (colour) {
    case PlotColour::kBlue:
      return "blue";
    case PlotColour::kOrange:
      return "orange";
    case PlotColour::kRed:
      return "red";
    case PlotColour::kGreen:
      return "green";
    case PlotColour::kPurple:
      return "purple";
    case PlotColour::kGrey:
      return "grey";
  }
  return "grey";
}

constexpr const char* kStyle = R"(<style>
text { font: 12px "DejaVu Sans", Verdana, sans-serif; fill: #6e7781; }
.title { font-weight: bold; }
.note { font-size: 11px; font-style: italic; }
.frame { fill: none; stroke: #8b949e; stroke-width: 1; }
.grid { fill: none; stroke: #8b949e; stroke-width: 1; stroke-opacity: 0.3; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; }
.bar { fill: none; stroke-width: 1.5; stroke-opacity: 0.55; }
.band { stroke: none; fill-opacity: 0.18; }
.blue { stroke: #2477c9; } .band.blue, .dot.blue { fill: #2477c9; }
.orange { stroke: #d98200; } .band.orange, .dot.orange { fill: #d98200; }
.red { stroke: #d13438; } .band.red, .dot.red { fill: #d13438; }
.green { stroke: #009e73; } .band.green, .dot.green { fill: #009e73; }
.purple { stroke: #b0609a; } .band.purple, .dot.purple { fill: #b0609a; }
.grey { stroke: #8b949e; } .band.grey, .dot.grey { fill: #8b949e; }
.dot, .bar { fill: none; stroke-width: 1.5; stroke-opacity: 0.55; }
.band { stroke: none; }
@media (prefers-color-scheme: dark) { text { fill: #b1bac4; } }
</style>
)";

/// Places of one panel.
class Canvas {
 public:
  Canvas(double left, double width, const PlotAxis& x, const PlotAxis& y)
      : left_(left), width_(width), x_(&x), y_(&y) {}
  double left() const { return left_; }
  double right() const { return left_ + width_; }
  double column(double x) const {
    return left_ + width_ * (x - x_->low) / std::max(1e-12, x_->high - x_->low);
  }
  double row(double y) const {
    const double share = (y - y_->low) / std::max(1e-12, y_->high - y_->low);
    return kTop + kPlotHeight * (1.0 - std::clamp(share, 0.0, 1.0));
  }

 private:
  double left_;
  double width_;
  const PlotAxis* x_;
  const PlotAxis* y_;
};

std::string text(double x, double y, std::string_view anchor, std::string_view content,
                 std::string_view style = {}) {
  const std::string kind = style.empty() ? std::string() : fmt::format(" class=\"{}\"", style);
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchor, kind, escapeXml(content));
}

std::string segment(double x1, double y1, double x2, double y2, std::string_view style) {
  return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", style, x1, y1, x2,
                     y2);
}

/// As short as it goes: 0.25, 1, 20.
std::string tickText(double value) { return fmt::format("{:.4g}", value); }

std::string drawAxes(const Canvas& canvas, const PlotPanel& panel, const PlotAxis& y, bool first) {
  std::string svg;
  const double bottom = kTop + kPlotHeight;
  for (const double tick : y.ticks) {
    svg += segment(canvas.left(), canvas.row(tick), canvas.right(), canvas.row(tick), "grid");
    if (first) svg += text(canvas.left() - 7.0, canvas.row(tick) + 4.0, "end", tickText(tick));
  }
  double free_from = -1e9;
  for (std::size_t i = 0; i < panel.x.ticks.size(); ++i) {
    const double at = canvas.column(panel.x.ticks[i]);
    svg += segment(at, bottom, at, bottom + 5.0, "frame");
    const std::string label = panel.x.tick_labels.size() == panel.x.ticks.size()
                                  ? panel.x.tick_labels[i]
                                  : tickText(panel.x.ticks[i]);
    const double half = 0.5 * kLetter * static_cast<double>(label.size()) + 2.0;
    if (at - half < free_from) continue;
    svg += text(at, bottom + 18.0, "middle", label);
    free_from = at + half;
  }
  svg += fmt::format(
      "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
      canvas.left(), kTop, canvas.right() - canvas.left(), kPlotHeight);
  const double middle = 0.5 * (canvas.left() + canvas.right());
  svg += text(middle, bottom + 37.0, "middle", panel.x.label);
  svg += text(middle, kTop - 10.0, "middle", panel.title, "title");
  return svg;
}

std::string drawLine(const Canvas& canvas, const PlotLine& line) {
  if (line.points.empty()) return {};
  const std::string colour = classOf(line.colour);
  std::string path;
  std::string upper;
  std::string lower;
  std::string dots;
  std::string bars;
  bool band = false;
  for (const PlotPoint& point : line.points) {
    const double column = canvas.column(point.x);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", column, canvas.row(point.y));
    upper +=
        fmt::format("{}{:.1f} {:.1f}", upper.empty() ? "M" : "L", column, canvas.row(point.high));
    lower.insert(0, fmt::format("L{:.1f} {:.1f}", column, canvas.row(point.low)));
    band = band || (point.high > point.low && !line.whiskers);
    if (line.whiskers && point.high > point.low) {
      bars += fmt::format("<path class=\"bar {}\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", colour, column,
                          canvas.row(point.low), canvas.row(point.high));
    }
    if (line.marks) {
      dots += fmt::format("<circle class=\"dot {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n",
                          colour, column, canvas.row(point.y));
    }
  }
  std::string svg;
  if (band) svg += fmt::format("<path class=\"band {}\" d=\"{}{}Z\"/>\n", colour, upper, lower);
  svg += fmt::format("<path class=\"line {}\"{} d=\"{}\"/>\n", colour,
                     line.dashed ? " stroke-dasharray=\"5 4\"" : "", path);
  return svg + bars + dots;
}

/// Each label once, in a row above the panels. `end`: where the row ends.
std::string drawLegend(const PlotFigure& figure, double& end) {
  std::vector<const PlotLine*> named;
  for (const PlotPanel& panel : figure.panels) {
    for (const PlotLine& line : panel.lines) {
      const bool known = std::any_of(named.begin(), named.end(), [&](const PlotLine* other) {
        return other->label == line.label;
      });
      if (!known && !line.label.empty()) named.push_back(&line);
    }
  }
  std::string svg;
  double at = kLeft;
  for (const PlotLine* line : named) {
    svg += fmt::format("<path class=\"line {}\"{} d=\"M{:.1f} 18L{:.1f} 18\"/>\n",
                       classOf(line->colour), line->dashed ? " stroke-dasharray=\"5 4\"" : "", at,
                       at + 22.0);
    svg += text(at + 28.0, 22.0, "start", line->label);
    end = at + 28.0 + (kLetter + 0.6) * static_cast<double>(line->label.size());
    at = end + 20.0;
  }
  return svg;
}

}  // namespace

std::string escapeXml(std::string_view raw) {
  std::string escaped;
  for (const char c : raw) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string drawFigure(const PlotFigure& figure) {
  const auto panels = static_cast<double>(std::max<std::size_t>(1, figure.panels.size()));
  // A single panel is no wider than one of two.
  const double room = kWholeWidth - kLeft - kRight - kGap * (std::max(panels, 2.0) - 1.0);
  const double width = room / std::max(panels, 2.0);
  double legend_end = 0.0;
  const std::string legend = drawLegend(figure, legend_end);
  const double whole =
      std::max(kLeft + kRight + panels * width + kGap * (panels - 1.0), legend_end + kRight);
  const double height = kTop + kPlotHeight + kBottom;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "width=\"{0:.0f}\" height=\"{1:.0f}\">\n<title>{2}</title>\n",
      whole, height, escapeXml(figure.description));
  svg += kStyle;
  svg += legend;
  const double middle = kTop + 0.5 * kPlotHeight;
  svg += fmt::format(
      "<text x=\"16\" y=\"{0:.1f}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {0:.1f})\">{1}"
      "</text>\n",
      middle, escapeXml(figure.y.label));
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const PlotPanel& panel = figure.panels[i];
    const Canvas canvas(kLeft + static_cast<double>(i) * (width + kGap), width, panel.x, figure.y);
    svg += drawAxes(canvas, panel, figure.y, i == 0);
    for (const PlotLine& line : panel.lines) svg += drawLine(canvas, line);
  }
  svg += text(whole - kRight, height - 7.0, "end", figure.note, "note");
  return svg + "</svg>\n";
}

}  // namespace agricolmap::campaign
