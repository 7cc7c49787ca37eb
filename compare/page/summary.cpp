#include "page/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "page/statistics.hpp"

namespace agricolmap::compare {
namespace {

constexpr const char* kOurs = "default";
constexpr std::size_t kNamed = 3;  // places where it is behind that are named

/// One setting on one kind of data: the default preset and the best of the others.
struct Contest {
  std::string place;
  Group ours;
  Group best;
  std::string best_method;
  double lead() const { return ours.share() - best.share(); }
};

std::string placeText(const std::string& kind, const std::string& experiment, double scale,
                      double setting) {
  std::string size = fmt::format("{:g}", setting);
  if (experiment == "translation") size = fmt::format("{:g} m", setting);
  if (experiment == "heading") size = fmt::format("{:g} rad", setting);
  if (experiment == "joint") return fmt::format("{:.0f} % of all errors, {}", 100 * setting, kind);
  if (experiment == "accuracy")
    return fmt::format("accuracy at {:.0f} % scale, {}", 100 * scale, kind);
  return fmt::format("{} with {:.0f} % scale, {}", size, 100 * scale, kind);
}

/// The default preset at one setting beside the method that does best against it, each on the
/// pairs that both were run on: some pairs are harder than others.
Contest contestAt(const std::vector<Row>& rows, const std::vector<std::string>& methods,
                  const RowTest& here) {
  Contest worst;
  for (const std::string& method : methods) {
    if (method == kOurs) continue;
    const auto of = [&](const Row& r) { return here(r) && r.method == method; };
    const std::set<PairKey> pairs = pairsOf(rows, of);
    Contest contest;
    contest.best = groupOf(rows, of);
    contest.best_method = method;
    contest.ours = groupOf(rows, [&](const Row& r) {
      return here(r) && r.method == kOurs && pairs.contains(pairOf(r));
    });
    if (contest.ours.runs == 0) continue;
    if (worst.ours.runs == 0 || contest.lead() < worst.lead()) worst = contest;
  }
  return worst;
}

/// Against all methods, or only those of others: not the paper's chain, which is ours as well.
std::vector<Contest> contestsOf(const std::vector<Row>& rows, bool only_others) {
  std::vector<Contest> contests;
  std::vector<std::string> methods = methodsOf(rows);
  if (only_others) {
    std::erase_if(methods, [](const std::string& name) { return name.starts_with("agricolmap"); });
  }
  for (const std::string& kind : kindsOf(rows)) {
    for (const std::string experiment : {"translation", "heading", "joint", "accuracy"}) {
      const auto ours = [&](const Row& r) { return r.experiment == experiment && r.kind == kind; };
      for (const double scale : distinctNumbers(rows, &Row::scale, ours)) {
        const auto scaled = [&](const Row& r) { return ours(r) && r.scale == scale; };
        for (const double setting : distinctNumbers(rows, &Row::setting, scaled)) {
          Contest contest = contestAt(
              rows, methods, [&](const Row& r) { return scaled(r) && r.setting == setting; });
          contest.place = placeText(kind, experiment, scale, setting);
          if (contest.ours.runs > 0) contests.push_back(contest);
        }
      }
    }
  }
  return contests;
}

/// Within what the paper tries: 5 m, 11.5°, 30 %.
bool withinPaper(const Row& row) {
  if (row.experiment == "translation") return row.setting <= 5.0;
  if (row.experiment == "heading") return row.setting <= 0.2;
  return row.experiment == "accuracy" || row.experiment == "joint";
}

std::string successSentence(const std::vector<Row>& rows) {
  const Group within =
      groupOf(rows, [](const Row& r) { return r.method == kOurs && withinPaper(r); });
  if (within.runs == 0) return {};
  const campaign::Interval interval = within.interval();
  std::string text = fmt::format(
      "Within the errors that the paper tries (5 m, 0.2 rad, 30 % of scale) the default preset is "
      "right and says so in {} of {} runs on {} pairs ({:.1f} to {:.1f} % if runs were "
      "independent). ",
      within.successes, within.runs,
      pairsOf(rows, [](const Row& r) { return r.method == kOurs; }).size(), 100.0 * interval.low,
      100.0 * interval.high);
  std::string wrong;
  for (const std::string& method : methodsOf(rows)) {
    const Group all = groupOf(
        rows, [&](const Row& r) { return r.method == method && r.experiment != "inliers"; });
    const std::size_t made = all.runs - all.skipped;
    if (made == 0) continue;
    wrong += fmt::format("{}{} {} of {}", wrong.empty() ? "" : ", ", method, all.wrong, made);
  }
  return text + "Answers that are wrong and stood by: " + wrong + ".";
}

std::string behindSentence(std::vector<Contest> contests) {
  std::erase_if(contests, [](const Contest& one) { return one.lead() >= 0.0; });
  if (contests.empty()) return "There is no setting at which another method succeeds more often.";
  std::stable_sort(contests.begin(), contests.end(),
                   [](const Contest& a, const Contest& b) { return a.lead() < b.lead(); });
  const auto clear = std::count_if(contests.begin(), contests.end(), [](const Contest& one) {
    return one.ours.interval().high < one.best.interval().low;
  });
  std::string text =
      fmt::format("It is behind at {} ({} of them beyond the intervals): ", contests.size(), clear);
  for (std::size_t i = 0; i < std::min(kNamed, contests.size()); ++i) {
    const Contest& one = contests[i];
    text += fmt::format("{}{} ({} against {} of {})", i == 0 ? "" : "; ", one.place,
                        shareText(one.ours.share()), shareText(one.best.share()), one.best_method);
  }
  if (contests.size() > kNamed) text += fmt::format("; and {} more", contests.size() - kNamed);
  return text + ".";
}

/// How far the default preset's median error is behind another method's, on the pairs that both get
/// right; nothing without such pairs [m].
struct Gap {
  double behind = -std::numeric_limits<double>::infinity();
  std::string text;
};
std::optional<Gap> accuracyGap(const std::vector<Row>& rows, const std::vector<std::string>& others,
                               const RowTest& here) {
  std::optional<Gap> worst;
  const std::set<PairKey> ours =
      pairsOf(rows, [&](const Row& r) { return here(r) && r.method == kOurs && r.success(); });
  for (const std::string& method : others) {
    const std::set<PairKey> both = pairsOf(rows, [&](const Row& r) {
      return here(r) && r.method == method && r.success() && ours.contains(pairOf(r));
    });
    if (both.empty()) continue;
    const auto median = [&](const std::string& of) {
      return groupOf(rows,
                     [&](const Row& r) {
                       return here(r) && r.method == of && both.contains(pairOf(r));
                     })
          .rms_affine;
    };
    const double mine = median(kOurs), theirs = median(method);
    if (worst && mine - theirs <= worst->behind) continue;
    worst = {mine - theirs, fmt::format("({:.1f} mm against {:.1f} mm of {})", 1000.0 * mine,
                                        1000.0 * theirs, method)};
  }
  return worst;
}

/// Cells of the accuracy table: data sets by scale errors.
std::string accuracySentence(const std::vector<Row>& rows) {
  std::size_t cells = 0;
  std::size_t first = 0;
  Gap worst;
  std::vector<std::string> others = methodsOf(rows);
  std::erase(others, kOurs);
  for (const std::string& dataset : dataSetsOf(rows)) {
    const auto of = [&](const Row& r) {
      return r.experiment == "accuracy" && r.dataset == dataset;
    };
    for (const double scale : distinctNumbers(rows, &Row::scale, of)) {
      const auto gap =
          accuracyGap(rows, others, [&](const Row& r) { return of(r) && r.scale == scale; });
      if (!gap) continue;
      ++cells;
      first += gap->behind <= 0.0 ? 1 : 0;
      if (gap->behind <= std::max(0.0, worst.behind)) continue;
      worst.behind = gap->behind;
      worst.text = fmt::format("{} at {:.0f} % {}", dataset, 100.0 * scale, gap->text);
    }
  }
  if (cells == 0) return "Accuracy was not measured.";
  std::string text = fmt::format(
      "Of the {} cells of the accuracy table in which another method succeeds, too, its median "
      "error on the pairs of both is the smallest in {}",
      cells, first);
  if (!worst.text.empty()) text += fmt::format("; it is farthest behind on {}", worst.text);
  return text + ".";
}

}  // namespace

std::string summarySentences(const std::vector<Row>& rows) {
  const std::vector<Contest> contests = contestsOf(rows, false);
  if (contests.empty())
    return "The rows have no setting with the default preset and another method.";
  const auto ahead = [](const std::vector<Contest>& of) {
    return std::count_if(of.begin(), of.end(), [](const Contest& one) { return one.lead() > 0.0; });
  };
  const auto level = std::count_if(contests.begin(), contests.end(),
                                   [](const Contest& one) { return one.lead() == 0.0; });
  const std::vector<Contest> others = contestsOf(rows, true);
  return fmt::format(
      "{} At {} of {} settings the default preset succeeds more often than every other method, at "
      "{} "
      "as often as the best of them. Beside the methods of others alone it is ahead at {} of {}. "
      "{} {}",
      successSentence(rows), ahead(contests), contests.size(), level, ahead(others), others.size(),
      behindSentence(contests), accuracySentence(rows));
}

}  // namespace agricolmap::compare
