#include "page/comparison_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "page/paper_figures.hpp"
#include "page/statistics.hpp"
#include "page/summary.hpp"
#include "runner/datasets.hpp"

namespace agricolmap::compare {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Where not all runs were made, or some were ended.
std::string marks(const Group& group) {
  return fmt::format("{}{}", group.skipped > 0 ? " *" : "", group.timeouts > 0 ? " †" : "");
}

/// `0.95 (0.76–0.99)` and marks.
std::string successText(const Group& group) {
  if (group.runs == 0) return "–";
  const campaign::Interval interval = group.interval();
  return fmt::format("{} ({:.2f}–{:.2f}){}", shareText(group.share()), interval.low, interval.high,
                     marks(group));
}

RowTest inCell(const std::string& method, double setting) {
  return
      [method, setting](const Row& row) { return row.method == method && row.setting == setting; };
}

/// `default (32)`: on how many pairs the method was run.
std::string withPairs(const std::string& method, const std::vector<Row>& rows) {
  return fmt::format("{} ({})", method,
                     pairsOf(rows, [&](const Row& row) { return row.method == method; }).size());
}

Table successTable(const std::vector<Row>& rows, const std::string& experiment,
                   const std::string& kind, double scale) {
  std::vector<Row> here;
  for (const Row& row : rows) {
    if (row.experiment == experiment && row.kind == kind && row.scale == scale) here.push_back(row);
  }
  const char* unit = experiment == "translation" ? "m" : "rad";
  Table table;
  table.caption =
      fmt::format("{} error at scale error {:.0f} %, {}",
                  experiment == "translation" ? "Translation" : "Heading", 100.0 * scale, kind);
  table.head = {"method (pairs)"};
  const std::vector<double> settings =
      distinctNumbers(here, &Row::setting, [](const Row&) { return true; });
  for (const double setting : settings) table.head.push_back(fmt::format("{:g} {}", setting, unit));
  for (const std::string& method : methodsOf(here)) {
    std::vector<TableCell> row = {{withPairs(method, here)}};
    for (const double setting : settings) {
      row.push_back({successText(groupOf(here, inCell(method, setting))),
                     scale == 0.0 ? paperSuccess(experiment, method, setting) : std::string()});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void addSuccess(const std::vector<Row>& rows, Document& document) {
  document.blocks.emplace_back(Heading{"Success over the error of the guess"});
  document.blocks.emplace_back(Paragraph{
      "Share of pairs that a method gets right and stands by, with Wilson's 95 % interval. Right: "
      "RMS over the points 5 cm, e_t 5 cm, e_r 0.1 rad, e_s 2.5 %; the paper asks for the last "
      "three. Translation: in a random direction, heading exact; heading: of random sign, position "
      "exact. Scale errors stretch or shrink x and y by signs of their own. A star marks cells "
      "with runs that were not made, as the method had failed on all pairs at three smaller "
      "errors or is rigid and the scale error alone too much; they count as failures. A dagger "
      "marks cells with runs that the time limit ended. Go-ICP is counted by the answer that it "
      "held when its time was up, though it could not prove it best. Each method's share is over "
      "all of its own pairs, whose number stands beside its name in the tables: who was run on "
      "more may have met a harder one. The sentences above compare on the pairs of both. "
      "The paper's figures (dashed in the plots) are those of its fig. correct_reg_rate "
      "without scale error, on real data, as released with its code; it gives no others as "
      "numbers."});
  for (Figure& figure : successFigures(rows)) document.blocks.emplace_back(std::move(figure));
  for (const std::string experiment : {"translation", "heading"}) {
    for (const std::string& kind : kindsOf(rows)) {
      const std::vector<double> scales = distinctNumbers(rows, &Row::scale, [&](const Row& row) {
        return row.experiment == experiment && row.kind == kind;
      });
      for (const double scale : scales) {
        document.blocks.emplace_back(successTable(rows, experiment, kind, scale));
      }
    }
  }
}

void addJoint(const std::vector<Row>& rows, Document& document) {
  std::vector<Row> here;
  for (const Row& row : rows) {
    if (row.experiment == "joint") here.push_back(row);
  }
  if (here.empty()) return;
  Table table{"Success with all errors at once", {"method (pairs)"}, {}};
  const std::vector<double> settings =
      distinctNumbers(here, &Row::setting, [](const Row&) { return true; });
  for (const std::string& kind : kindsOf(here)) {
    for (const double share : settings) {
      table.head.push_back(fmt::format("{:g} m, {:g} rad, {:g} %; {}", 5.0 * share, 0.2 * share,
                                       30.0 * share, kind));
    }
  }
  for (const std::string& method : methodsOf(here)) {
    std::vector<TableCell> row = {{withPairs(method, here)}};
    for (const std::string& kind : kindsOf(here)) {
      for (const double share : settings) {
        row.push_back({successText(groupOf(here, [&](const Row& one) {
          return one.kind == kind && one.method == method && one.setting == share;
        }))});
      }
    }
    table.rows.push_back(std::move(row));
  }
  document.blocks.emplace_back(Heading{"All errors at once"});
  document.blocks.emplace_back(
      Paragraph{"The largest errors that the paper allows for, together, and half of them. The "
                "paper has no such experiment."});
  document.blocks.emplace_back(std::move(table));
}

/// e_t / e_R / e_s as the paper writes them, our RMS and how many pairs they are from.
std::string accuracyText(const Group& group) {
  if (group.runs == 0) return "–";
  if (group.successes == 0) return fmt::format("fail (0 of {}){}", group.runs, marks(group));
  return fmt::format("{:.3f} m / {:.2f}° / {:.1f} %; RMS {:.0f} mm, plane {:.0f} mm ({} of {})",
                     group.e_t, group.e_r / kDegree, 100.0 * group.e_s, 1000.0 * group.rms,
                     1000.0 * group.rms_affine, group.successes, group.runs);
}

Table accuracyTable(const std::vector<Row>& rows, const std::string& dataset) {
  std::vector<Row> here;
  for (const Row& row : rows) {
    if (row.experiment == "accuracy" && row.dataset == dataset) here.push_back(row);
  }
  Table table;
  if (here.empty()) return table;
  table.caption = fmt::format("{} ({})", dataset, here.front().kind);
  table.head = {"method"};
  const std::vector<double> scales =
      distinctNumbers(here, &Row::scale, [](const Row&) { return true; });
  for (const double scale : scales) {
    table.head.push_back(fmt::format("scale error {:.0f} %", 100.0 * scale));
  }
  for (const std::string& method : methodsOf(here)) {
    std::vector<TableCell> row = {{method}};
    for (const double scale : scales) {
      const auto place = static_cast<std::size_t>(std::lround(scale / 0.05));
      row.push_back({accuracyText(groupOf(here, inCell(method, scale))),
                     paperAccuracy(dataset, method, place)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void addAccuracy(const std::vector<Row>& rows, Document& document) {
  document.blocks.emplace_back(Heading{"Accuracy"});
  document.blocks.emplace_back(Paragraph{
      "From a guess that is 5 cm and 0.01 rad off: means of e_t, e_r and e_s over the successes, "
      "as in the paper's tab. err_statistic; the median RMS over the strip's points (drift and "
      "heights included) and in the plane against the best affine; how many pairs succeeded. "
      "The paper's figures are from real data; semi-real strips, and real pairs by their names, "
      "stand beside its figures of their crop."});
  for (const std::string& dataset : dataSetsOf(rows)) {
    Table table = accuracyTable(rows, dataset);
    if (!table.rows.empty()) document.blocks.emplace_back(std::move(table));
  }
}

/// Of the first matching of every method, or of the second of those that match again.
Table inlierTable(const std::vector<InlierLine>& lines, const std::string& caption,
                  MatchShares InlierLine::*which) {
  Table table{caption,
              {"data set", "method", "pairs", "matches", "right [%]", "coherent [%]",
               "inliers [%] in the paper, real data"},
              {}};
  const auto spread = [](double mean, double deviation) {
    return std::isfinite(deviation) ? fmt::format("{:.1f} ± {:.1f}", mean, deviation)
                                    : fmt::format("{:.1f}", mean);
  };
  for (const InlierLine& line : lines) {
    const MatchShares& of = line.*which;
    if (of.runs == 0) continue;
    table.rows.push_back({{fmt::format("{} ({})", line.dataset, line.kind)},
                          {line.method},
                          {fmt::format("{}", of.runs)},
                          {fmt::format("{:.0f}", of.matches)},
                          {spread(of.right, of.right_deviation)},
                          {spread(of.coherent, of.coherent_deviation)},
                          {paperInliers(line.dataset, line.method)}});
  }
  return table;
}

void addInliers(const std::vector<Row>& rows, Document& document) {
  const std::vector<InlierLine> lines = inlierLines(rows);
  Table first = inlierTable(lines, "Matches from the guess", &InlierLine::first);
  if (first.rows.empty()) return;
  document.blocks.emplace_back(Heading{"Inliers of the data association"});
  document.blocks.emplace_back(Paragraph{
      "From a guess that is 1 m, 0.05 rad and 5 % off. Right: the match lies within 4 cm, two "
      "cells, of where the truth puts it. Coherent: the method kept it (for the paper's chain, the "
      "vote did). The paper's tab. inliers_percentage does not say against what it counts."});
  document.blocks.emplace_back(std::move(first));
  Table last = inlierTable(lines, "Matches again", &InlierLine::last);
  if (last.rows.empty()) return;
  document.blocks.emplace_back(Paragraph{
      "Our chain of the paper matches once more, with the moving map laid as its first matches "
      "say; its affine is fitted to these."});
  document.blocks.emplace_back(std::move(last));
}

void addTimes(const std::vector<Row>& rows, Document& document) {
  Table table{"Seconds on one thread, without reading files",
              {"method", "min / max / mean of successes", "mean of all that ended",
               "runs, ended at the limit", "peak memory [MiB]", "share of the time"},
              {}};
  for (const TimeLine& line : timeLines(rows)) {
    std::string stages;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, line.stages.size()); ++i) {
      stages += fmt::format("{}{} {:.0f} %", i == 0 ? "" : ", ", line.stages[i].first,
                            100.0 * line.stages[i].second);
    }
    table.rows.push_back({{line.method},
                          {fmt::format("{} / {} / {}", numberText(line.min, 1),
                                       numberText(line.max, 1), numberText(line.mean, 1)),
                           paperTimes(line.method)},
                          {numberText(line.mean_all, 1)},
                          {fmt::format("{}, {}", line.runs, line.timeouts)},
                          {numberText(line.peak_mib, 0)},
                          {stages}});
  }
  document.blocks.emplace_back(Heading{"Time and memory"});
  document.blocks.emplace_back(Paragraph{
      "Over all runs of all experiments, as many at a time as the command said; what other "
      "programs "
      "took of the core is taken off. The paper's "
      "figures (tab. timings_tab) are min / max / average on its authors' machine and data. "
      "Memory is the process's, with the libraries of all methods (some 40 MiB) and both clouds."});
  document.blocks.emplace_back(std::move(table));
}

std::string pairsText(const std::vector<Row>& rows) {
  std::string text;
  for (const std::string& dataset : dataSetsOf(rows)) {
    int low = 0;
    int high = -1;
    for (const Row& row : rows) {
      if (row.dataset != dataset) continue;
      low = high < 0 ? row.seed : std::min(low, row.seed);
      high = high < 0 ? row.seed : std::max(high, row.seed);
    }
    const std::string seeds =
        low == high ? fmt::format("seed {}", low) : fmt::format("seeds {} to {}", low, high);
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", dataset, seeds);
  }
  return text;
}

/// What figures of real pairs mean; empty without any.
std::string realText(const std::vector<Row>& rows) {
  const std::string real = toString(DataKind::kReal);
  if (std::none_of(rows.begin(), rows.end(), [&](const Row& row) { return row.kind == real; })) {
    return {};
  }
  return "Real data sets are one pair of real clouds each, with the truth that came with it: their "
         "seeds vary the error of the guess alone, and their intervals say nothing about other "
         "fields. ";
}

}  // namespace

Document comparisonDocument(const std::vector<Row>& rows, const std::string& identity) {
  Document document;
  document.title = "AgriColMap beside other registration methods";
  int first = rows.empty() ? 0 : rows.front().seed;
  int last = first;
  for (const Row& row : rows) {
    first = std::min(first, row.seed);
    last = std::max(last, row.seed);
  }
  document.subtitle = fmt::format(
      "{} runs: {}. Written by agricolmap_compare (-o DIR --pairs {} --first-seed {}; not all "
      "methods "
      "on all pairs) from rows of: {}. Simulated data sets: field and sensors are. Semi-real ones: "
      "strips cut from real imagery, the robot's view of it simulated. How the two views of a pair "
      "differ (plants, light, wind, colours, noise, drift: compare/runner/views.cpp) is drawn for "
      "each pair; the final settings share no value with those for development. {}Seeds 31 and 51 "
      "to 53 served to tune the other methods.",
      rows.size(), pairsText(rows), last - first + 1, first, identity, realText(rows));
  document.blocks.emplace_back(Paragraph{summarySentences(rows)});
  addSuccess(rows, document);
  addJoint(rows, document);
  addAccuracy(rows, document);
  addInliers(rows, document);
  addTimes(rows, document);
  return document;
}

}  // namespace agricolmap::compare
