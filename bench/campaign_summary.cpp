#include "campaign_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace agricolmap::campaign {
namespace {

double share(std::size_t hits, std::size_t trials) {
  return trials == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(trials);
}

SummaryLine summariseOne(const std::vector<const PairRow*>& rows) {
  SummaryLine line;
  std::vector<double> rms;
  std::vector<double> rms3d;
  std::vector<double> times;
  for (const PairRow* row : rows) {
    ++line.pairs;
    line.negative = row->negative;
    line.accepted += row->accepted ? 1 : 0;
    line.successes += row->success() ? 1 : 0;
    line.found += !row->negative && row->accepted &&
                          row->errors.rms_horizontal <= evaluate::SuccessLimits{}.rms
                      ? 1
                      : 0;
    line.false_accepts += row->accepted && !row->correct ? 1 : 0;
    times.push_back(row->total_s);
    if (!row->success()) continue;
    rms.push_back(row->errors.rms_to_best_affine);
    rms3d.push_back(row->errors.rms);
  }
  line.success_interval = wilsonInterval(line.successes, line.pairs);
  line.accepted_interval = wilsonInterval(line.accepted, line.pairs);
  line.rms_median = quantile(rms, 0.5);
  line.rms_p95 = quantile(rms, 0.95);
  line.rms_worst = quantile(rms, 1.0);
  line.rms3d_median = quantile(rms3d, 0.5);
  line.rms3d_p95 = quantile(rms3d, 0.95);
  line.time_median = quantile(times, 0.5);
  line.time_p95 = quantile(times, 0.95);
  return line;
}

std::string fixed(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string();
}

/// Millimetres, or a dash.
std::string millimetres(double metres) {
  return std::isfinite(metres) ? fmt::format("{:.1f}", 1000.0 * metres) : std::string("–");
}

std::string percent(double value) { return fmt::format("{:.1f}", 100.0 * value); }

}  // namespace

std::string targetText(const Target& target) {
  std::string text;
  const auto add = [&](const std::string& part) {
    if (!text.empty()) text += ", ";
    text += part;
  };
  if (target.min_success) add(fmt::format("success ≥ {:.0f} %", 100.0 * *target.min_success));
  if (target.max_rms) {
    add(fmt::format("{} ≤ {:.0f} mm", target.worst_rms ? "worst" : "median",
                    1000.0 * *target.max_rms));
  }
  if (target.max_rms3d) add(fmt::format("3-D ≤ {:.0f} mm", 1000.0 * *target.max_rms3d));
  if (target.max_time) add(fmt::format("≤ {:.1f} s", *target.max_time));
  const auto addShare = [&](const char* name, const char* sign, std::optional<double> limit) {
    if (limit) add(fmt::format("{} {} {:.0f} %", name, sign, 100.0 * *limit));
  };
  addShare("found", "≥", target.min_found);
  addShare("refused", "≤", target.max_refused);
  addShare("accepted", "≤", target.max_accepted);
  addShare("wrong", "≤", target.max_false);
  return text.empty() ? "–" : text;
}

Interval wilsonInterval(std::size_t hits, std::size_t trials) {
  if (trials == 0) return {};
  constexpr double kZ = 1.959963984540054;
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(hits) / n;
  const double spread = kZ * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n));
  const double middle = p + kZ * kZ / (2.0 * n);
  const double norm = 1.0 + kZ * kZ / n;
  return {std::max(0.0, (middle - spread) / norm), std::min(1.0, (middle + spread) / norm)};
}

double quantile(std::vector<double> values, double share_below) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double at = share_below * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

std::optional<bool> SummaryLine::met() const {
  bool asked = false;
  bool met = true;
  const auto atLeast = [&](std::optional<double> limit, double value) {
    if (!limit) return;
    asked = true;
    met = met && value >= *limit;  // NaN, no success at all, meets nothing
  };
  const auto atMost = [&](std::optional<double> limit, double value) {
    if (limit) atLeast(-*limit, -value);
  };
  atLeast(target.min_success, share(successes, pairs));
  atLeast(target.min_found, share(found, pairs));
  atMost(target.max_accepted, share(accepted, pairs));
  atMost(target.max_false, share(false_accepts, pairs));
  atMost(target.max_refused, share(pairs - accepted, pairs));
  atMost(target.max_rms, target.worst_rms ? rms_worst : rms_median);
  atMost(target.max_rms3d, rms3d_median);
  atMost(target.max_time, time_median);
  return asked ? std::optional<bool>(met) : std::nullopt;
}

std::vector<SummaryLine> summarise(const std::vector<PairRow>& rows,
                                   const std::vector<std::string>& cases,
                                   const std::map<std::string, Target>& targets) {
  const auto place = [&](const std::string& name) {
    return std::find(cases.begin(), cases.end(), name) - cases.begin();
  };
  std::map<std::tuple<std::ptrdiff_t, std::string, std::string>, std::vector<const PairRow*>>
      groups;
  for (const PairRow& row : rows) {
    groups[{place(row.case_name), row.case_name, row.preset}].push_back(&row);
  }
  std::vector<SummaryLine> lines;
  for (const auto& [key, group] : groups) {
    SummaryLine line = summariseOne(group);
    line.case_name = std::get<1>(key);
    line.preset = std::get<2>(key);
    const auto target = targets.find(line.case_name);
    if (target != targets.end()) line.target = target->second;
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string summaryCsv(const std::vector<SummaryLine>& lines) {
  std::string text =
      "case,preset,pairs,success,success_low,success_high,accepted,accepted_low,accepted_high,"
      "false_accepts,rms_to_best_affine_median_m,rms_to_best_affine_p95_m,"
      "rms_to_best_affine_worst_m,rms_median_m,rms_p95_m,time_median_s,time_p95_s,met\n";
  for (const SummaryLine& line : lines) {
    const std::optional<bool> met = line.met();
    text += fmt::format(
        "{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{},{},{},{},{},{},{},{},{}\n",
        line.case_name, line.preset, line.pairs, share(line.successes, line.pairs),
        line.success_interval.low, line.success_interval.high, share(line.accepted, line.pairs),
        line.accepted_interval.low, line.accepted_interval.high, line.false_accepts,
        fixed(line.rms_median, 5), fixed(line.rms_p95, 5), fixed(line.rms_worst, 5),
        fixed(line.rms3d_median, 5), fixed(line.rms3d_p95, 5), fixed(line.time_median, 3),
        fixed(line.time_p95, 3), met ? (*met ? "yes" : "no") : "");
  }
  return text;
}

std::string summaryMarkdown(const std::vector<SummaryLine>& lines, const std::string& identity) {
  std::string text = fmt::format(
      "# Campaign\n\n{}\n\n"
      "Success: accepted and within RMS 5 cm, e_t 5 cm, e_r 0.1 rad, e_s 2.5 %. Shares with "
      "Wilson's 95 % interval. False: accepted though outside these limits. RMS to the best affine "
      "(horizontal) and 3-D RMS (drift included) are over successes, median / 95th percentile; "
      "times are over all pairs.\n\n"
      "| case | preset | pairs | success % | accepted % | false | RMS to best affine mm | 3-D RMS "
      "mm | time s | target | met |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|--:|---|---|\n",
      identity);
  for (const SummaryLine& line : lines) {
    const std::optional<bool> met = line.met();
    const std::string success =
        line.negative
            ? "–"
            : fmt::format("{} ({}–{})", percent(share(line.successes, line.pairs)),
                          percent(line.success_interval.low), percent(line.success_interval.high));
    text += fmt::format(
        "| {} | {} | {} | {} | {} ({}–{}) | {} | {} / {} | {} / {} | {:.1f} / {:.1f} | {} | {} |\n",
        line.case_name, line.preset, line.pairs, success, percent(share(line.accepted, line.pairs)),
        percent(line.accepted_interval.low), percent(line.accepted_interval.high),
        line.false_accepts, millimetres(line.rms_median), millimetres(line.rms_p95),
        millimetres(line.rms3d_median), millimetres(line.rms3d_p95), line.time_median,
        line.time_p95, targetText(line.target), met ? (*met ? "yes" : "**no**") : "–");
  }
  return text;
}

}  // namespace agricolmap::campaign
