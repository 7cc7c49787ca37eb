// Success over the error of the guess: the paper's fig. correct_reg_rate.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "page/comparison_page.hpp"
#include "page/paper_figures.hpp"
#include "page/statistics.hpp"
#include "svg_plot.hpp"

namespace agricolmap::compare {
namespace {

using campaign::PlotColour;
using campaign::PlotFigure;
using campaign::PlotLine;
using campaign::PlotPanel;

/// Five lines are what a panel of this size can be read with; the default preset is in all.
struct Family {
  const char* name;
  const char* title;
  std::array<const char*, 5> methods;
};
constexpr std::array<Family, 4> kFamilies = {{
    {"chain",
     "the paper's chain and its variants",
     {"default", "agricolmap", "agricolmap-rgb", "agricolmap-exg", "agricolmap-height"}},
    {"points",
     "methods on points",
     {"default", "icp-affine", "cpd-affine", "go-icp", "go-icp-oracle-scale"}},
    {"features",
     "methods on features of pictures",
     {"default", "surf", "orb", "fast-brief", "sift-affine"}},
    {"global",
     "global methods",
     {"default", "fft-affine", "fpfh-gicp", "fpfh-gicp-oracle-scale", ""}},
}};
constexpr std::array<PlotColour, 5> kColours = {PlotColour::kBlue, PlotColour::kOrange,
                                                PlotColour::kGreen, PlotColour::kPurple,
                                                PlotColour::kRed};

std::string tickText(double value) { return fmt::format("{:g}", value); }

PlotLine lineOf(const std::vector<Row>& rows, const std::vector<double>& settings,
                const std::string& method, std::size_t colour) {
  PlotLine line;
  line.label = method;
  line.colour = kColours[colour];
  line.whiskers = true;
  // Aside of each other, or equal shares would hide all but one.
  const double aside = 0.09 * (static_cast<double>(colour) - 2.0);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const Group group = groupOf(
        rows, [&](const Row& row) { return row.method == method && row.setting == settings[i]; });
    if (group.runs == 0) continue;
    const campaign::Interval interval = group.interval();
    line.points.push_back(
        {static_cast<double>(i) + aside, group.share(), interval.low, interval.high});
  }
  return line;
}

/// The paper's curve of the method, where it gives one.
PlotLine paperLineOf(const std::string& experiment, const std::vector<double>& settings,
                     const std::string& method, std::size_t colour) {
  PlotLine line;
  line.label = "paper, real data";
  line.colour = kColours[colour];
  line.dashed = true;
  for (const auto& [setting, share] : paperCurve(experiment, method)) {
    const auto found = std::find(settings.begin(), settings.end(), setting);
    if (found == settings.end()) continue;
    line.points.push_back({static_cast<double>(found - settings.begin()), share, share, share});
  }
  return line;
}

/// Settings stand at equal distances: their steps range from centimetres to metres.
PlotPanel panelOf(const std::vector<Row>& rows, const Family& family, double scale,
                  const std::string& experiment) {
  PlotPanel panel;
  panel.title = fmt::format("scale {:.0f} %", 100.0 * scale);
  std::vector<Row> here;
  for (const Row& row : rows) {
    if (row.scale == scale) here.push_back(row);
  }
  const std::vector<double> settings =
      distinctNumbers(here, &Row::setting, [](const Row&) { return true; });
  panel.x.label = experiment == "translation" ? "error [m]" : "error [rad]";
  panel.x.low = -0.4;
  panel.x.high = static_cast<double>(settings.size()) - 0.6;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    panel.x.ticks.push_back(static_cast<double>(i));
    panel.x.tick_labels.push_back(tickText(settings[i]));
  }
  for (std::size_t i = 0; i < family.methods.size(); ++i) {
    PlotLine line = lineOf(here, settings, family.methods[i], i);
    if (line.points.empty()) continue;
    panel.lines.push_back(std::move(line));
    PlotLine paper = paperLineOf(experiment, settings, family.methods[i], i);
    if (scale == 0.0 && !paper.points.empty()) panel.lines.push_back(std::move(paper));
  }
  return panel;
}

bool hasOthers(const PlotFigure& figure) {
  return std::any_of(figure.panels.begin(), figure.panels.end(),
                     [](const PlotPanel& panel) { return panel.lines.size() > 1; });
}

}  // namespace

std::vector<Figure> successFigures(const std::vector<Row>& rows) {
  std::vector<Figure> figures;
  for (const std::string experiment : {"translation", "heading"}) {
    for (const std::string& kind : kindsOf(rows)) {
      std::vector<Row> here;
      for (const Row& row : rows) {
        if (row.experiment == experiment && row.kind == kind) here.push_back(row);
      }
      const std::vector<double> scales =
          distinctNumbers(here, &Row::scale, [](const Row&) { return true; });
      if (scales.empty()) continue;
      for (const Family& family : kFamilies) {
        const std::string caption =
            fmt::format("Success over {} error, {}: {}", experiment, kind, family.title);
        PlotFigure figure;
        figure.description = caption;
        figure.note = kind + ", bars: 95 % intervals; settings at equal distances";
        figure.y = {"success", 0.0, 1.0, {0.0, 0.25, 0.5, 0.75, 1.0}, {}};
        for (const double scale : scales) {
          figure.panels.push_back(panelOf(here, family, scale, experiment));
        }
        if (!hasOthers(figure)) continue;
        figures.push_back({fmt::format("success_{}_{}_{}.svg", experiment, kind, family.name),
                           caption, campaign::drawFigure(figure)});
      }
    }
  }
  return figures;
}

}  // namespace agricolmap::compare
