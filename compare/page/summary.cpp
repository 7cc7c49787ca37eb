#include "page/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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
          Contest contest;
          contest.place = placeText(kind, experiment, scale, setting);
          for (const std::string& method : methods) {
            const Group group = groupOf(rows, [&](const Row& r) {
              return scaled(r) && r.setting == setting && r.method == method;
            });
            if (group.runs == 0) continue;
            if (method == kOurs) {
              contest.ours = group;
            } else if (contest.best.runs == 0 || group.share() > contest.best.share()) {
              contest.best = group;
              contest.best_method = method;
            }
          }
          if (contest.ours.runs > 0 && contest.best.runs > 0) contests.push_back(contest);
        }
      }
    }
  }
  return contests;
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

/// Cells of the accuracy table: data sets by scale errors.
std::string accuracySentence(const std::vector<Row>& rows) {
  std::size_t cells = 0;
  std::size_t first = 0;
  std::optional<std::pair<double, std::string>> worst;
  for (const std::string& dataset : dataSetsOf(rows)) {
    const auto ours = [&](const Row& r) {
      return r.experiment == "accuracy" && r.dataset == dataset;
    };
    for (const double scale : distinctNumbers(rows, &Row::scale, ours)) {
      double best = std::numeric_limits<double>::infinity();
      double mine = best;
      std::string best_method;
      for (const std::string& method : methodsOf(rows)) {
        const double rms = groupOf(rows, [&](const Row& r) {
                             return ours(r) && r.scale == scale && r.method == method;
                           }).rms_affine;
        if (method == kOurs && std::isfinite(rms)) mine = rms;
        if (method != kOurs && rms < best) best_method = method;
        if (method != kOurs && rms < best) best = rms;
      }
      if (!std::isfinite(mine)) continue;
      ++cells;
      first += mine <= best ? 1 : 0;
      if (mine > best && (!worst || mine - best > worst->first)) {
        worst = {mine - best,
                 fmt::format("{} at {:.0f} % ({:.1f} mm against {:.1f} mm of {})", dataset,
                             100.0 * scale, 1000.0 * mine, 1000.0 * best, best_method)};
      }
    }
  }
  if (cells == 0) return "Accuracy was not measured.";
  std::string text = fmt::format(
      "Of the {} cells of the accuracy table its median error is the smallest in {}", cells, first);
  if (worst) text += fmt::format("; it is farthest behind on {}", worst->second);
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
      "At {} of {} settings the default preset succeeds more often than every other method, at {} "
      "as often as the best of them. Beside the methods of others alone it is ahead at {} of {}. "
      "{} {}",
      ahead(contests), contests.size(), level, ahead(others), others.size(),
      behindSentence(contests), accuracySentence(rows));
}

}  // namespace agricolmap::compare
