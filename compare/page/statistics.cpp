#include "page/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "agricolmap/io/text/text.hpp"
#include "runner/datasets.hpp"

namespace agricolmap::compare {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Order of reports. Methods that are not here come last.
const std::vector<std::string> kMethodOrder = {"default",
                                               "agricolmap",
                                               "agricolmap-rgb",
                                               "agricolmap-exg",
                                               "agricolmap-height",
                                               "icp-affine",
                                               "cpd-affine",
                                               "go-icp",
                                               "go-icp-oracle-scale",
                                               "surf",
                                               "orb",
                                               "fast-brief",
                                               "fft-affine",
                                               "sift-affine",
                                               "fpfh-gicp",
                                               "fpfh-gicp-oracle-scale"};

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? kNan : sum / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
  if (values.size() < 2) return kNan;
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// `a=1;b=2` added up by name.
void addStages(std::string_view text, std::map<std::string, double>& sums) {
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find(';'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) continue;
    if (const auto value = io::parseNumber(part.substr(equals + 1))) {
      sums[std::string(part.substr(0, equals))] += *value;
    }
  }
}

/// `known` first and in its order.
std::vector<std::string> ordered(std::vector<std::string> names,
                                 const std::vector<std::string>& known) {
  std::stable_sort(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return std::find(known.begin(), known.end(), a) < std::find(known.begin(), known.end(), b);
  });
  return names;
}

}  // namespace

double Group::share() const {
  return runs == 0 ? kNan : static_cast<double>(successes) / static_cast<double>(runs);
}

campaign::Interval Group::interval() const { return campaign::wilsonInterval(successes, runs); }

Group groupOf(const std::vector<Row>& rows, const RowTest& test) {
  Group group;
  std::vector<double> e_t, e_r, e_s, rms, rms_affine;
  for (const Row& row : rows) {
    if (!test(row)) continue;
    ++group.runs;
    group.right += row.correct ? 1 : 0;
    group.wrong += row.accepted && !row.correct ? 1 : 0;
    group.skipped += row.status == "skipped" ? 1 : 0;
    group.timeouts += row.status == "timeout" ? 1 : 0;
    if (!row.success()) continue;
    ++group.successes;
    e_t.push_back(row.errors.translation);
    e_r.push_back(row.errors.rotation);
    e_s.push_back(row.errors.scale);
    rms.push_back(row.errors.rms);
    rms_affine.push_back(row.errors.rms_to_best_affine);
  }
  group.e_t = mean(e_t);
  group.e_r = mean(e_r);
  group.e_s = mean(e_s);
  group.rms = campaign::quantile(rms, 0.5);
  group.rms_affine = campaign::quantile(rms_affine, 0.5);
  return group;
}

std::vector<Row> withHeldAnswers(std::vector<Row> rows) {
  for (Row& row : rows) {
    // Both variants; unlike the others that may refuse, they only say that time was short.
    if (row.method.starts_with("go-icp") && row.status == "not_accepted") row.accepted = true;
  }
  return rows;
}

PairKey pairOf(const Row& row) { return {row.dataset, row.seed}; }

std::set<PairKey> pairsOf(const std::vector<Row>& rows, const RowTest& test) {
  std::set<PairKey> pairs;
  for (const Row& row : rows) {
    if (test(row)) pairs.insert(pairOf(row));
  }
  return pairs;
}

std::vector<std::string> distinct(const std::vector<Row>& rows,
                                  const std::function<std::string(const Row&)>& column) {
  std::vector<std::string> values;
  for (const Row& row : rows) {
    std::string value = column(row);
    if (std::find(values.begin(), values.end(), value) == values.end()) {
      values.push_back(std::move(value));
    }
  }
  return values;
}

std::vector<double> distinctNumbers(const std::vector<Row>& rows, double Row::*column,
                                    const RowTest& test) {
  std::vector<double> values;
  for (const Row& row : rows) {
    if (test(row)) values.push_back(row.*column);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<std::string> dataSetsOf(const std::vector<Row>& rows) {
  return ordered(distinct(rows, [](const Row& row) { return row.dataset; }), dataSetNames());
}

std::vector<std::string> kindsOf(const std::vector<Row>& rows) {
  return ordered(
      distinct(rows, [](const Row& row) { return row.kind; }),
      {toString(DataKind::kSimulated), toString(DataKind::kSemiReal), toString(DataKind::kReal)});
}

std::vector<std::string> methodsOf(const std::vector<Row>& rows) {
  return ordered(distinct(rows, [](const Row& row) { return row.method; }), kMethodOrder);
}

std::string shareText(double share) {
  if (!std::isfinite(share)) return "–";
  return share == 0.0 || share == 1.0 ? fmt::format("{:.0f}", share) : fmt::format("{:.2f}", share);
}

std::string numberText(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string("–");
}

namespace {

/// Seconds of computing: what a run took, less what other programs on the machine took of its core.
double computingSeconds(const Row& row) {
  const double share = row.cpu_s / row.wall_s;
  return std::isfinite(share) ? row.run_s * std::min(1.0, share) : row.run_s;
}

}  // namespace

std::vector<TimeLine> timeLines(const std::vector<Row>& rows) {
  std::vector<TimeLine> lines;
  for (const std::string& method : methodsOf(rows)) {
    TimeLine line;
    line.method = method;
    std::vector<double> right, all, memory;
    std::map<std::string, double> stages;
    for (const Row& row : rows) {
      if (row.method != method || row.status == "skipped") continue;
      ++line.runs;
      line.timeouts += row.status == "timeout" ? 1 : 0;
      if (std::isfinite(row.peak_mib)) memory.push_back(row.peak_mib);
      if (!std::isfinite(row.run_s)) continue;
      all.push_back(computingSeconds(row));
      if (!row.success()) continue;
      right.push_back(computingSeconds(row));
      addStages(row.stages, stages);
    }
    line.successes = right.size();
    line.min = campaign::quantile(right, 0.0);
    line.max = campaign::quantile(right, 1.0);
    line.mean = mean(right);
    line.mean_all = mean(all);
    line.peak_mib = campaign::quantile(memory, 0.5);
    double sum = 0.0;
    for (const auto& [name, seconds] : stages) sum += seconds;
    for (const auto& [name, seconds] : stages) line.stages.emplace_back(name, seconds / sum);
    std::stable_sort(line.stages.begin(), line.stages.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    lines.push_back(std::move(line));
  }
  return lines;
}

namespace {

MatchShares sharesOf(const std::vector<MatchCounts>& runs) {
  std::vector<double> matches, right, coherent;
  for (const MatchCounts& counts : runs) {
    if (!(counts.matches > 0.0)) continue;
    matches.push_back(counts.matches);
    right.push_back(100.0 * counts.right / counts.matches);
    coherent.push_back(100.0 * counts.coherent / counts.matches);
  }
  return {matches.size(),   mean(matches),  mean(right),
          deviation(right), mean(coherent), deviation(coherent)};
}

}  // namespace

std::vector<InlierLine> inlierLines(const std::vector<Row>& rows) {
  std::vector<InlierLine> lines;
  for (const std::string& dataset : dataSetsOf(rows)) {
    for (const std::string& method : methodsOf(rows)) {
      InlierLine line{dataset, {}, method, {}, {}};
      std::vector<MatchCounts> first, last;
      for (const Row& row : rows) {
        if (row.experiment != "inliers" || row.dataset != dataset || row.method != method) continue;
        line.kind = row.kind;
        first.push_back(row.first);
        last.push_back(row.last);
      }
      line.first = sharesOf(first);
      line.last = sharesOf(last);
      if (line.first.runs > 0) lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace agricolmap::compare
