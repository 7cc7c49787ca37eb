#include "locating_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "agricolmap/io/text/text.hpp"
#include "campaign_cases.hpp"
#include "campaign_summary.hpp"
#include "svg_plot.hpp"

namespace agricolmap::campaign {
namespace {

using Rows = std::vector<const PairRow*>;

constexpr const char* kNote = "simulated pairs; bands: Wilson's 95 % interval";

/// How a series of cases is shown.
struct SeriesStyle {
  std::string name;   ///< in the cases' names
  std::string title;  ///< of its section
  std::string axis;
  double scale = 1.0;  ///< shown = offset + scale · value
  double offset = 0.0;
};

const std::vector<SeriesStyle>& seriesStyles() {
  static const std::vector<SeriesStyle> all = {
      {"length", "Length of the strip", "length of the strip [m]"},
      {"overhang", "Overlap", "part of the strip on the map [%]", -100.0, 100.0},
      {"gaps", "Missing plants", "plants missing [%]", 100.0},
      {"plant-size", "Canopy", "size of the plants, of the crop's usual"},
      {"leaf-unshared", "Leaf texture", "leaf texture that the views do not share [%]", 100.0},
      {"growth", "Growth between the views", "size on the ground over size from the air"},
      {"drift", "Drift", "drift, of the strip's length [%]", 100.0}};
  return all;
}

PlotPoint shareOf(double x, std::size_t hits, std::size_t trials) {
  const Interval interval = wilsonInterval(hits, trials);
  const double share = trials == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(trials);
  return {x, 100.0 * share, 100.0 * interval.low, 100.0 * interval.high};
}

/// One crop of a series: success, refusal and false acceptance over its values.
PlotPanel curvePanel(const SeriesStyle& style, const std::string& crop,
                     const std::map<double, Rows>& by_value) {
  PlotPanel panel;
  panel.title = crop;
  panel.x.label = style.axis;
  PlotLine success{"accepted and right", PlotColour::kBlue, {}, true, false};
  PlotLine refused{"not accepted", PlotColour::kOrange, {}, true, false};
  PlotLine wrong{"accepted and wrong", PlotColour::kRed, {}, true, false};
  for (const auto& [value, rows] : by_value) {
    const double x = style.offset + style.scale * value;
    const auto count = [&](auto&& is) {
      return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), is));
    };
    success.points.push_back(
        shareOf(x, count([](const PairRow* row) { return row->success(); }), rows.size()));
    refused.points.push_back(
        shareOf(x, count([](const PairRow* row) { return !row->accepted; }), rows.size()));
    wrong.points.push_back(shareOf(
        x, count([](const PairRow* row) { return row->accepted && !row->correct; }), rows.size()));
    panel.x.ticks.push_back(x);
  }
  for (PlotLine* line : {&success, &refused, &wrong}) {
    std::sort(line->points.begin(), line->points.end(),
              [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
    panel.lines.push_back(std::move(*line));
  }
  std::sort(panel.x.ticks.begin(), panel.x.ticks.end());
  const double margin = std::max(1e-9, 0.04 * (panel.x.ticks.back() - panel.x.ticks.front()));
  panel.x.low = panel.x.ticks.front() - margin;
  panel.x.high = panel.x.ticks.back() + margin;
  return panel;
}

PlotAxis percentAxis(std::string label) {
  return {std::move(label), 0.0, 100.0, {0.0, 20.0, 40.0, 60.0, 80.0, 100.0}};
}

/// Adds a picture and the lines that show it.
void addFigure(const std::string& name, const PlotFigure& figure, std::vector<PageFile>& files,
               std::string& page) {
  const std::string path = "images/locating-" + name + ".svg";
  files.push_back({path, drawFigure(figure)});
  page += fmt::format("![{}]({})\n\n", figure.description, path);
}

void addCurves(const Rows& rows, std::vector<PageFile>& files, std::string& page) {
  std::map<std::string, std::map<std::string, std::map<double, Rows>>> series;
  for (const PairRow* row : rows) {
    if (const auto name = parseCurveName(row->case_name)) {
      series[name->series][name->crop][name->value].push_back(row);
    }
  }
  if (series.empty()) return;
  page +=
      "## Until it breaks\n\nOne setting varied at a time; all others as in fair views, the guess "
      "with the paper's errors. Simulated.\n\n";
  for (const SeriesStyle& style : seriesStyles()) {
    const auto found = series.find(style.name);
    if (found == series.end()) continue;
    PlotFigure figure;
    figure.description = "Success, refusal and false acceptance over: " + style.axis;
    figure.note = kNote;
    figure.y = percentAxis("share of pairs [%]");
    std::set<std::size_t> counts;
    for (const auto& [crop, by_value] : found->second) {
      figure.panels.push_back(curvePanel(style, crop, by_value));
      for (const auto& [value, of_value] : by_value) counts.insert(of_value.size());
    }
    page += fmt::format("### {}\n\n", style.title);
    addFigure(style.name, figure, files, page);
    page += fmt::format("{} pairs a point.\n\n",
                        *counts.begin() == *counts.rbegin()
                            ? fmt::format("{}", *counts.begin())
                            : fmt::format("{}–{}", *counts.begin(), *counts.rbegin()));
  }
}

std::vector<SummaryLine> linesOf(const Rows& rows) {
  std::vector<std::string> names;
  std::map<std::string, Target> targets;
  for (const std::string& suite : suiteNames()) {
    for (const CampaignCase& one : suiteCases(suite, false)) {
      names.push_back(one.name);
      targets[one.name] = one.target;
    }
  }
  std::vector<PairRow> copies;
  for (const PairRow* row : rows) {
    if (!parseCurveName(row->case_name)) copies.push_back(*row);
  }
  return summarise(copies, names, targets);
}

/// `97.9 (94.1–99.3)`, in percent.
std::string shareText(std::size_t hits, std::size_t trials) {
  const PlotPoint share = shareOf(0.0, hits, trials);
  return fmt::format("{:.1f} ({:.1f}–{:.1f})", share.y, share.low, share.high);
}

std::string millimetres(double metres) {
  return std::isfinite(metres) ? fmt::format("{:.1f}", 1000.0 * metres) : std::string("–");
}

void addTable(const Rows& rows, std::string& page) {
  const std::vector<SummaryLine> lines = linesOf(rows);
  if (lines.empty()) return;
  page +=
      "## Cases\n\nSuccess: accepted, and within RMS 5 cm, e_t 5 cm, e_r 0.1 rad, e_s 2.5 %. "
      "Wrong: accepted though outside these limits. Found: accepted and within 5 cm in the plane. "
      "RMS: horizontal, to the best affine, of successes. Median / 95th percentile; shares with "
      "Wilson's 95 % interval. [What the cases are](campaign-suites.md).\n\n"
      "| case | pairs | success % | found % | wrong | not accepted % | RMS mm | time s | target | "
      "met "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|---|---|\n";
  for (const SummaryLine& line : lines) {
    const std::optional<bool> met = line.met();
    page += fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} / {} | {:.2f} / {:.2f} | {} | {} |\n", line.case_name,
        line.pairs, line.negative ? "–" : shareText(line.successes, line.pairs),
        line.negative ? "–" : shareText(line.found, line.pairs), line.false_accepts,
        shareText(line.pairs - line.accepted, line.pairs), millimetres(line.rms_median),
        millimetres(line.rms_p95), line.time_median, line.time_p95, targetText(line.target),
        met ? (*met ? "yes" : "**no**") : "–");
  }
  std::size_t negatives = 0;
  std::size_t accepted = 0;
  for (const SummaryLine& line : lines) {
    if (!line.negative) continue;
    negatives += line.pairs;
    accepted += line.accepted;
  }
  if (negatives > 0) {
    page += fmt::format("\nOf {} pairs without a right answer, {} were accepted: {} %.\n",
                        negatives, accepted, shareText(accepted, negatives));
  }
  page += "\n";
}

void addReliability(const Rows& rows, std::vector<PageFile>& files, std::string& page) {
  std::vector<Statement> statements;
  for (const PairRow* row : rows) {
    if (!std::isfinite(row->probability)) continue;
    const bool right = !row->negative && row->errors.rms <= evaluate::SuccessLimits{}.rms;
    statements.push_back({row->probability, right});
  }
  if (statements.empty()) return;
  PlotLine stated{"what came true", PlotColour::kBlue, {}, true, false};
  for (const ReliabilityBin& bin : reliability(statements)) {
    stated.points.push_back(shareOf(100.0 * bin.mean_probability, bin.right, bin.count));
  }
  PlotFigure figure;
  figure.description = "Reliability diagram: share of right answers over the stated probability";
  figure.note = kNote;
  figure.y = percentAxis("answers that are right [%]");
  PlotPanel panel;
  panel.title = fmt::format("{} answers", statements.size());
  panel.x = percentAxis("stated probability [%]");
  panel.lines = {{"ideal", PlotColour::kGrey, {{0.0, 0.0}, {100.0, 100.0}}, false, true},
                 std::move(stated)};
  figure.panels.push_back(std::move(panel));
  page += "## Does the probability hold?\n\n";
  addFigure("reliability", figure, files, page);
  page += fmt::format(
      "Simulated. Expected calibration error {:.4f} in ten bins of equal width, {:.4f} in ten of "
      "equal number; area under the curve {:.4f}.\n\n",
      calibrationError(statements, false), calibrationError(statements, true),
      areaUnderCurve(statements));
}

/// Share of errors inside the ellipse of each nominal probability.
PlotLine coverageLine(std::vector<double> nominal, std::string label, PlotColour colour) {
  PlotLine line{std::move(label), colour, {}, false, false};
  std::sort(nominal.begin(), nominal.end());
  for (int percent = 0; percent <= 100; percent += 5) {
    const double limit = 0.01 * percent;
    const auto inside = std::upper_bound(nominal.begin(), nominal.end(), limit) - nominal.begin();
    line.points.push_back(shareOf(percent, static_cast<std::size_t>(inside), nominal.size()));
  }
  return line;
}

void addCoverage(const Rows& rows, std::vector<PageFile>& files, std::string& page) {
  std::vector<double> all;
  std::vector<double> centre;
  for (const PairRow* row : rows) {
    if (!row->success() || !std::isfinite(row->mahalanobis2)) continue;
    all.push_back(chiSquaredBelow(row->mahalanobis2, 5));
    centre.push_back(chiSquaredBelow(row->centre_mahalanobis2, 2));
  }
  if (all.empty()) return;
  PlotFigure figure;
  figure.description = "Share of true errors inside the stated ellipse over its probability";
  figure.note = kNote;
  figure.y = percentAxis("errors inside [%]");
  PlotPanel panel;
  panel.title = fmt::format("{} successes", all.size());
  panel.x = percentAxis("stated ellipse [%]");
  PlotLine ideal{"ideal", PlotColour::kGrey, {{0.0, 0.0}, {100.0, 100.0}}, false, true};
  panel.lines = {std::move(ideal), coverageLine(all, "five parameters", PlotColour::kBlue),
                 coverageLine(centre, "the strip's centre", PlotColour::kOrange)};
  figure.panels.push_back(std::move(panel));
  const auto inside = [](const std::vector<double>& values) {
    const auto hits =
        std::count_if(values.begin(), values.end(), [](double v) { return v <= 0.9; });
    return shareText(static_cast<std::size_t>(hits), values.size());
  };
  page += "## Does the covariance hold?\n\n";
  addFigure("coverage", figure, files, page);
  page += fmt::format(
      "Simulated. Inside the 90 % ellipse lie {} % of the errors of all five parameters and {} % "
      "of "
      "those of the strip's centre.\n\n",
      inside(all), inside(centre));
}

}  // namespace

std::optional<CurveName> parseCurveName(const std::string& case_name) {
  constexpr std::string_view kBegin = "curve-";
  const std::size_t equals = case_name.rfind('=');
  if (!case_name.starts_with(kBegin) || equals == std::string::npos) return std::nullopt;
  const auto value = io::parseNumber(std::string_view(case_name).substr(equals + 1));
  if (!value) return std::nullopt;
  const std::string middle = case_name.substr(kBegin.size(), equals - kBegin.size());
  for (const SeriesStyle& style : seriesStyles()) {
    const std::string end = "-" + style.name;
    if (!middle.ends_with(end)) continue;
    return CurveName{middle.substr(0, middle.size() - end.size()), style.name, *value};
  }
  return std::nullopt;
}

double chiSquaredBelow(double value, int degrees) {
  if (value <= 0.0) return 0.0;
  if (degrees == 2) return 1.0 - std::exp(-0.5 * value);
  return std::erf(std::sqrt(0.5 * value)) -
         std::sqrt(2.0 * value / std::numbers::pi) * std::exp(-0.5 * value) * (1.0 + value / 3.0);
}

std::vector<PageFile> locatingPage(const std::vector<PairRow>& rows,
                                   const std::vector<std::string>& origins,
                                   const std::string& preset) {
  Rows chosen;
  for (const PairRow& row : rows) {
    if (row.preset == preset) chosen.push_back(&row);
  }
  std::string page = fmt::format(
      "# Finding the strip, and knowing when it is wrong\n\n<!-- Written by agricolmap_plots. "
      "-->\n\n"
      "All pairs are simulated, or cut from real imagery where a case is called semireal or real. "
      "Preset `{}`, {} pairs:\n\n",
      preset, chosen.size());
  for (const std::string& origin : origins) page += fmt::format("- {}\n", origin);
  page += "\n";
  std::vector<PageFile> files;
  addTable(chosen, page);
  addReliability(chosen, files, page);
  addCoverage(chosen, files, page);
  addCurves(chosen, files, page);
  while (page.ends_with("\n\n")) page.pop_back();
  files.insert(files.begin(), {"locating.md", std::move(page)});
  return files;
}

}  // namespace agricolmap::campaign
