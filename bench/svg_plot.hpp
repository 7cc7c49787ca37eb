// Line plots as SVG, for pages that are read on light and on dark ground.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace agricolmap::campaign {

/// A value with its interval; an interval without extent draws no band.
struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
  double low = 0.0;
  double high = 0.0;
};

enum class PlotColour { kBlue, kOrange, kRed, kGreen, kPurple, kGrey };

struct PlotLine {
  std::string label;  ///< in the legend, which names each label once
  PlotColour colour = PlotColour::kBlue;
  std::vector<PlotPoint> points;  ///< in order of x
  bool marks = true;              ///< a dot at each point
  bool dashed = false;
  bool whiskers = false;  ///< intervals as bars instead of a band: where lines lie close together
};

struct PlotAxis {
  std::string label;  ///< with the unit
  double low = 0.0;
  double high = 1.0;
  std::vector<double> ticks;                  ///< labelled where there is room
  std::vector<std::string> tick_labels = {};  ///< as many, or none: the numbers themselves
};

struct PlotPanel {
  std::string title;
  PlotAxis x;
  std::vector<PlotLine> lines;
};

/// Panels side by side with one axis of y.
struct PlotFigure {
  std::string description;  ///< for those who cannot see it
  std::string note;         ///< small, in the lower right corner: what kind of data it shows
  PlotAxis y;
  std::vector<PlotPanel> panels;
};

/// A whole SVG document.
std::string drawFigure(const PlotFigure& figure);

/// Text with what XML reserves replaced.
std::string escapeXml(std::string_view text);

}  // namespace agricolmap::campaign
