#include "agricolmap/pipeline/placing.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "agricolmap/verdict/straighten.hpp"

namespace agricolmap::pipeline {
namespace {

/// What a search that was not accepted is followed by, an ambiguous one, too: among places that fit
/// equally badly the right one may be missing. Finer cells are dearer, and needed where the
/// canopy is closed and only leaves tell places apart; then all headings and scales, should the
/// rows have misled.
struct Attempt {
  double cell;  ///< of the options' cell
  int climbs;   ///< times the options' climbs
  double work;  ///< times the options' limit
  bool rows_on_rows;
};
constexpr std::array<Attempt, 3> kAttempts = {
    {{1.0, 1, 1.0, true}, {2.0 / 3.0, 3, 16.0, true}, {1.0, 2, 4.0, false}}};

/// One block may come to agree by chance.
constexpr std::size_t kOddBlock = 1;

std::unique_ptr<locate::Association> makeAssociation(const RegistrationOptions& options) {
  if (options.association == AssociationKind::kFlow) {
    return std::make_unique<paper::FlowAssociation>(options.flow);
  }
  return std::make_unique<locate::CorrelationSearch>(options.search);
}

double count(const std::vector<std::pair<std::string, double>>& counts, std::string_view name) {
  for (const auto& [key, value] : counts) {
    if (key == name) return value;
  }
  return 0.0;
}

int rankOf(verdict::Status status) {
  return status == verdict::Status::kAccepted ? 2 : status == verdict::Status::kAmbiguous ? 1 : 0;
}

}  // namespace

bool better(const PairOutcome& a, const PairOutcome& b) {
  if (a.has_transform != b.has_transform) return a.has_transform;
  if (rankOf(a.verdict.status) != rankOf(b.verdict.status)) {
    return rankOf(a.verdict.status) > rankOf(b.verdict.status);
  }
  if (a.verdict.probability != b.verdict.probability) {
    return a.verdict.probability > b.verdict.probability;
  }
  return a.evidence.significance > b.evidence.significance;
}

bool supersedes(const PairOutcome& later, const PairOutcome& earlier, double rival) {
  if (earlier.verdict.status != verdict::Status::kAmbiguous) return better(later, earlier);
  double highest = earlier.evidence.significance;
  for (const RefinedPose& other : earlier.rivals) highest = std::max(highest, other.significance);
  return later.verdict.status != verdict::Status::kRejected &&
         highest < rival * later.evidence.significance;
}

std::optional<PairOutcome> PairPlacer::searchOnce(std::size_t index,
                                                  const PairOutcome* before) const {
  if (index >= kAttempts.size()) return std::nullopt;
  const Attempt& attempt = kAttempts[index];
  const bool correlates =
      association_ == nullptr && options_.association == AssociationKind::kCorrelation;
  if (index > 0 && !correlates) return std::nullopt;
  // Nothing new when the rows did not restrict the search before.
  if (before != nullptr && !attempt.rows_on_rows && count(before->counts, "rows_on_rows") < 1.0) {
    return std::nullopt;
  }
  RegistrationOptions now = options_;
  now.search.cell *= attempt.cell;
  now.search.climbs *= attempt.climbs;
  now.search.max_work *= attempt.work;
  now.search.rows_on_rows = options_.search.rows_on_rows && attempt.rows_on_rows;
  PairOutcome outcome;
  outcome.counts = {{"fixed_cells", static_cast<double>(fixed_.filled)},
                    {"moving_cells", static_cast<double>(moving_.filled)},
                    {"attempts", static_cast<double>(index + 1)}};
  // 3.–5. Data association: descriptors, flow and vote (Sec. III-B), or the correlation search.
  const std::unique_ptr<locate::Association> own = association_ ? nullptr : makeAssociation(now);
  outcome.association =
      (association_ ? association_ : own.get())->associate(fixed_, moving_, space_, times_);
  outcome.counts.insert(outcome.counts.end(), outcome.association.counts.begin(),
                        outcome.association.counts.end());
  // 6. Affine with two scales per placement (Eq. 3); 7. refinement of the best.
  const RefineOutcome refined =
      refinement_.choose(outcome.association.placements, times_, outcome.counts);
  judgeOutcome(refined, outcome);
  return outcome;
}

PairOutcome PairPlacer::search() const {
  std::optional<PairOutcome> best;
  std::optional<PairOutcome> last;
  for (std::size_t i = 0; i < kAttempts.size(); ++i) {
    std::optional<PairOutcome> next = searchOnce(i, last ? &*last : nullptr);
    if (!next) break;
    last = next;
    if (!best || supersedes(*next, *best, options_.verdict.rival)) best = std::move(next);
    if (best->verdict.status == verdict::Status::kAccepted) break;
  }
  // How often it was tried, whichever of them was best.
  for (auto& [name, value] : best->counts) {
    if (name == "attempts") value = count(last->counts, "attempts");
  }
  return *std::move(best);
}

PairOutcome PairPlacer::settle(const Placement& placement, std::vector<RefinedPose> rivals) const {
  PairOutcome outcome;
  outcome.association.placements = {placement};
  RefineOutcome refined =
      refinement_.choose(outcome.association.placements, times_, outcome.counts);
  refined.rivals = std::move(rivals);
  judgeOutcome(refined, outcome);
  return outcome;
}

PairPlacer::Judged PairPlacer::judgePose(const Eigen::Affine2d& pose,
                                         const RefineOutcome& refined) const {
  Judged judged;
  judged.pose = pose;
  const Fit fit = refinement_.fit(pose);
  judged.correlation = fit.correlation;
  judged.vertical = times_.run(
      "vertical", [&] { return refine::fitVertical(fixed_, moving_, pose, options_.vertical); });
  times_.run("verdict", [&] {
    judged.finding = refinement_.examine(pose, refined, judged.vertical.residual);
    judged.finding.overlap = fit.overlap;
  });
  return judged;
}

// 7d. The paper's own refinement stays as it is.
std::optional<bool> PairPlacer::straighten(const RefineOutcome& refined, Judged& judged) const {
  if (options_.refine != RefineKind::kDense) return {};
  const auto straight = verdict::straightenedPose(judged.finding.evidence, space_.scale_axes);
  if (!straight) return {};
  Judged other = judgePose(*straight, refined);
  if (other.finding.evidence.agreeing <= judged.finding.evidence.agreeing + kOddBlock) return false;
  // Blocks place themselves by centimetres at best: what they lay straight must also fit better.
  bool changed = false;
  const auto take = [&](Judged& next) {
    const verdict::Evidence& now = next.finding.evidence;
    const verdict::Evidence& before = judged.finding.evidence;
    if (now.agreeing < before.agreeing || now.significance <= before.significance ||
        next.correlation <= judged.correlation) {
      return;
    }
    judged = std::move(next);
    changed = true;
  };
  take(other);
  // It may not have been bent, but caught at the edge of the refinement's basin.
  const auto finer = times_.run("refine", [&] { return refinement_.refineFrom(*straight); });
  if (finer) {
    other = judgePose(finer->pose, refined);
    take(other);
  }
  return changed;
}

void PairPlacer::judgeOutcome(const RefineOutcome& refined, PairOutcome& outcome) const {
  outcome.has_transform = refined.best.has_value();
  if (!refined.best) {
    outcome.verdict = verdict::rejectBecause(refined.failure);
    return;
  }
  outcome.rivals = refined.rivals;
  Judged judged = judgePose(refined.best->pose, refined);
  if (const auto straightened = straighten(refined, judged)) {
    outcome.counts.emplace_back("straightened", *straightened ? 1.0 : 0.0);
  }
  outcome.pose = judged.pose;
  outcome.overlap = judged.finding.overlap;
  outcome.correlation = judged.correlation;
  outcome.vertical = judged.vertical;
  // 8. Verdict.
  outcome.verdict = verdict::judge(judged.finding, space_, options_.verdict);
  outcome.evidence = std::move(judged.finding.evidence);
  outcome.uncertainty = std::move(judged.finding.uncertainty);
  if (outcome.vertical.status != refine::VerticalStatus::kOk) {
    outcome.verdict = verdict::rejectBecause("the heights of the two maps do not fit one another");
  }
  if (outcome.verdict.status == verdict::Status::kAmbiguous) {
    for (const RefinedPose& rival : refined.rivals) {
      if (rival.significance < options_.verdict.rival * outcome.evidence.significance) break;
      outcome.alternatives.push_back({.pose = rival.pose, .significance = rival.significance});
    }
  }
}

}  // namespace agricolmap::pipeline
