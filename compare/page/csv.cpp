// The tables as CSV, long form: one line per figure and its interval.
#include <fmt/format.h>

#include <cmath>

#include "page/paper_figures.hpp"
#include "page/statistics.hpp"

namespace agricolmap::compare {
namespace {

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string();
}

/// A data set, or all of a kind.
struct Scope {
  std::string name;
  std::string kind;
  bool all;
  bool has(const Row& row) const { return all ? row.kind == kind : row.dataset == name; }
};

std::vector<Scope> scopesOf(const std::vector<Row>& rows) {
  std::vector<Scope> scopes;
  for (const std::string& kind : kindsOf(rows)) scopes.push_back({"all", kind, true});
  for (const std::string& dataset : dataSetsOf(rows)) {
    for (const Row& row : rows) {
      if (row.dataset != dataset) continue;
      scopes.push_back({dataset, row.kind, false});
      break;
    }
  }
  return scopes;
}

std::string groupFields(const Group& group) {
  const campaign::Interval interval = group.interval();
  return fmt::format("{},{},{:.4f},{:.4f},{:.4f},{},{},{},{}", group.runs, group.successes,
                     group.share(), interval.low, interval.high, group.right, group.wrong,
                     group.skipped, group.timeouts);
}

constexpr const char* kGroupColumns =
    "pairs,successes,success,success_low,success_high,right,wrong_accepted,skipped,timeouts";

}  // namespace

std::string successCsv(const std::vector<Row>& rows, const std::string& experiment) {
  std::string text =
      fmt::format("kind,dataset,scale_error,setting,method,{},paper_real_data\n", kGroupColumns);
  const auto ours = [&](const Row& row) { return row.experiment == experiment; };
  const std::vector<double> scales = distinctNumbers(rows, &Row::scale, ours);
  const std::vector<double> settings = distinctNumbers(rows, &Row::setting, ours);
  for (const Scope& scope : scopesOf(rows)) {
    for (const double scale : scales) {
      for (const double setting : settings) {
        for (const std::string& method : methodsOf(rows)) {
          const Group group = groupOf(rows, [&](const Row& row) {
            return ours(row) && scope.has(row) && row.scale == scale && row.setting == setting &&
                   row.method == method;
          });
          if (group.runs == 0) continue;
          text += fmt::format("{},{},{:g},{:g},{},{},{}\n", scope.kind, scope.name, scale, setting,
                              method, groupFields(group),
                              scale == 0.0 ? paperSuccess(experiment, method, setting) : "");
        }
      }
    }
  }
  return text;
}

std::string accuracyCsv(const std::vector<Row>& rows) {
  std::string text = fmt::format(
      "kind,dataset,scale_error,method,{},e_t_mean_m,e_r_mean_deg,e_s_mean,rms_median_m,"
      "rms_to_best_affine_median_m,paper_real_data\n",
      kGroupColumns);
  const auto ours = [](const Row& row) { return row.experiment == "accuracy"; };
  for (const Scope& scope : scopesOf(rows)) {
    for (const double scale : distinctNumbers(rows, &Row::scale, ours)) {
      for (const std::string& method : methodsOf(rows)) {
        const Group group = groupOf(rows, [&](const Row& row) {
          return ours(row) && scope.has(row) && row.scale == scale && row.method == method;
        });
        if (group.runs == 0) continue;
        const auto place = static_cast<std::size_t>(std::lround(scale / 0.05));
        text += fmt::format("{},{},{:g},{},{},{},{},{},{},{},{}\n", scope.kind, scope.name, scale,
                            method, groupFields(group), number(group.e_t, 5),
                            number(group.e_r * 180.0 / M_PI, 4), number(group.e_s, 5),
                            number(group.rms, 5), number(group.rms_affine, 5),
                            scope.all ? "" : paperAccuracy(scope.name, method, place));
      }
    }
  }
  return text;
}

std::string inliersCsv(const std::vector<Row>& rows) {
  std::string text =
      "kind,dataset,method,pairs,matches_mean,right_percent,right_deviation,coherent_percent,"
      "coherent_deviation,rematches_mean,rematches_right_percent,rematches_right_deviation,"
      "rematches_coherent_percent,rematches_coherent_deviation,paper_real_data_percent\n";
  const auto shares = [](const MatchShares& of) {
    if (of.runs == 0) return std::string(",,,,");
    return fmt::format("{:.0f},{:.2f},{},{:.2f},{}", of.matches, of.right,
                       number(of.right_deviation, 2), of.coherent,
                       number(of.coherent_deviation, 2));
  };
  for (const InlierLine& line : inlierLines(rows)) {
    text +=
        fmt::format("{},{},{},{},{},{},{}\n", line.kind, line.dataset, line.method, line.first.runs,
                    shares(line.first), shares(line.last), paperInliers(line.dataset, line.method));
  }
  return text;
}

std::string timesCsv(const std::vector<Row>& rows) {
  std::string text =
      "method,runs,timeouts,successes,min_s,max_s,mean_s,mean_all_s,peak_mib,stages,"
      "paper_real_data_s\n";
  for (const TimeLine& line : timeLines(rows)) {
    std::string stages;
    for (const auto& [name, share] : line.stages) {
      stages += fmt::format("{}{}={:.3f}", stages.empty() ? "" : ";", name, share);
    }
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", line.method, line.runs, line.timeouts,
                        line.successes, number(line.min, 3), number(line.max, 3),
                        number(line.mean, 3), number(line.mean_all, 3), number(line.peak_mib, 0),
                        stages, paperTimes(line.method));
  }
  return text;
}

}  // namespace agricolmap::compare
