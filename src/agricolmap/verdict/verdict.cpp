#include "agricolmap/verdict/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::verdict {

const char* toString(Status status) {
  switch (status) {
    case Status::kAccepted:
      return "accepted";
    case Status::kAmbiguous:
      return "ambiguous";
    case Status::kRejected:
      break;
  }
  return "rejected";
}

void listOptions(OptionTable& table, VerdictOptions& options) {
  table
      .number("min_probability", options.min_probability, 0.0, 1.0, "",
              "least probability of being within 5 cm RMS of the truth in the plane")
      .basic();
  table
      .number("min_uniqueness", options.min_uniqueness, 0.0, 100.0, "",
              "least ratio of the peak to the highest other one, whatever else speaks for it")
      .basic();
  table.number("rival", options.rival, 0.0, 1.0, "",
               "other placements with this share of the best one's significance rival it");
  table.number("min_fit", options.min_fit, 0.0, 1000.0, "deviations",
               "significance from which on rivals mean ambiguity, not chance");
  table
      .number("min_overlap", options.min_overlap, 0.0, 1.0, "",
              "least share of the moving map that must lie on the fixed map")
      .basic();
  table.number("scale_margin", options.scale_margin, 0.0, 1.0, "",
               "how far beyond the prior's limits the scales may come out, relative");
  table.number("heading_margin_deg", options.heading_margin_deg, 0.0, 180.0, "deg",
               "how far beyond the prior's limit the heading may come out");
}

std::string headline(const Verdict& verdict) {
  if (verdict.status != Status::kAccepted || !verdict.heights.limited()) {
    return toString(verdict.status);
  }
  return fmt::format("{} in the plane, heights limited: {}", toString(verdict.status),
                     describe(verdict.heights));
}

void requireHeights(Verdict& verdict) {
  if (verdict.status != Status::kAccepted || !verdict.heights.limited()) return;
  verdict.status = Status::kRejected;
  std::vector<std::string> reasons;
  reasons.push_back(
      fmt::format("heights are required, and limited: {}; in the plane it would be accepted",
                  describe(verdict.heights)));
  for (std::string& reason : verdict.reasons) reasons.push_back(std::move(reason));
  verdict.reasons = std::move(reasons);
  verdict.remedies.emplace_back(
      "map wheel tracks, gaps or the field's edge, too, where both maps see soil");
}

Verdict rejectBecause(std::string reason) { return {Status::kRejected, {std::move(reason)}}; }

namespace {

// Below these a piece of evidence is worth a sentence in the reasons of a refusal.
constexpr double kWeakUniqueness = 1.8;
constexpr double kWeakDecoy = 1.4;
constexpr double kMirroredDecoy = 0.6;
constexpr double kWeakAgreement = 0.55;
constexpr double kLargeError = 0.03;  // [m]
constexpr double kLikelyPlace = 0.5;  // of a place that is none an error means nothing

/// What no evidence can outweigh.
std::vector<std::string> contradictions(const Finding& finding, const SearchSpace& space,
                                        const VerdictOptions& options) {
  std::vector<std::string> against;
  if (!finding.evidence.decoys.empty() && finding.evidence.decoyRatio() < kMirroredDecoy &&
      finding.evidence.significance < options.min_fit) {
    against.emplace_back(
        "a mirrored copy of the moving map fits far better than the map itself: its axes may be "
        "left-handed, or one of them turned round");
  }
  if (finding.overlap < options.min_overlap) {
    against.push_back(
        fmt::format("only {:.0f} % of the moving map lies on the fixed map (at least "
                    "{:.0f} % needed)",
                    100 * finding.overlap, 100 * options.min_overlap));
  }
  const HorizontalParts parts =
      splitHorizontal(space.scale_axes.transpose() * finding.pose.linear() * space.scale_axes);
  const double scale_limit = std::exp(logScaleLimit(space.uncertainty)) + options.scale_margin;
  for (const auto& [axis, scale] : {std::pair{"x", parts.scale_x}, {"y", parts.scale_y}}) {
    if (!(scale < scale_limit && scale > 1.0 / scale_limit)) {
      against.push_back(
          fmt::format("the scale along {} came out as {:.3f}, beyond what the prior "
                      "allows ({:.3f} to {:.3f})",
                      axis, scale, 1.0 / scale_limit, scale_limit));
    }
  }
  const double heading = degrees(std::abs(parts.yaw));
  if (!(heading <= space.uncertainty.heading_deg + options.heading_margin_deg)) {
    against.push_back(
        fmt::format("the heading came out {:.1f} deg off the prior's, which allows "
                    "{:.1f} deg",
                    heading, space.uncertainty.heading_deg));
  }
  return against;
}

double expectedError(const Finding& finding) {
  if (!finding.uncertainty) return std::numeric_limits<double>::infinity();
  return std::hypot(finding.uncertainty->expected_rms, finding.uncertainty->local_rms);
}

const char* asHigh(double ratio) { return ratio > 1.0 ? "almost as high" : "as high or higher"; }

/// What weakens a registration that is not likely enough.
std::vector<std::string> doubts(const Finding& finding, double probability, double place,
                                const VerdictOptions& options) {
  const Evidence& evidence = finding.evidence;
  std::vector<std::string> against;
  if (!evidence.parts.displaced.empty()) {
    against.push_back(describe(evidence.parts));
  }
  if (evidence.uniqueness < std::max(kWeakUniqueness, options.min_uniqueness)) {
    against.push_back(fmt::format("another place scores {}: this one has {:.2f} times its score",
                                  asHigh(evidence.uniqueness), evidence.uniqueness));
  }
  if (!evidence.decoys.empty() && evidence.decoyRatio() < kWeakDecoy) {
    against.push_back(
        fmt::format("a mirrored copy of the strip, which belongs nowhere, scores {}: the strip has "
                    "{:.2f} times "
                    "its score",
                    asHigh(evidence.decoyRatio()), evidence.decoyRatio()));
  }
  if (evidence.agreement() < kWeakAgreement) {
    against.push_back(fmt::format("only {} of {} blocks, placed alone, agree with the whole",
                                  evidence.agreeing, evidence.blocks.size()));
  }
  const double error = expectedError(finding);
  if (!(error < kLargeError) && (place >= kLikelyPlace || !std::isfinite(error))) {
    // Of squares, which add up.
    const bool slipped = 2.0 * finding.slip_rms * finding.slip_rms > error * error;
    against.push_back(
        std::isfinite(error)
            ? fmt::format("an error of {:.1f} cm RMS must be expected: {}", 100 * error,
                          slipped
                              ? "it is not told well enough where the strip slipped, or whose "
                                "the points are where its parts lie over each other"
                              : "by so much the strip's blocks, or its plants and soil, contradict "
                                "one another")
            : std::string("too few blocks of the strip can be compared"));
  }
  if (probability < options.min_probability) {
    against.push_back(
        fmt::format("the probability of the right place (within 5 cm in the plane) is {} (at "
                    "least {:.0f} % needed)",
                    percentOf(probability), 100 * options.min_probability));
  }
  return against;
}

std::vector<std::string> support(const Finding& finding, double plane) {
  const Evidence& evidence = finding.evidence;
  std::string peak =
      fmt::format("it scores {:.2f} times as high as the next best place", evidence.uniqueness);
  if (!evidence.decoys.empty()) {
    peak += fmt::format(", and {:.2f} times as high as a mirrored copy, which belongs nowhere",
                        evidence.decoyRatio());
  }
  std::vector<std::string> reasons = {
      peak,
      fmt::format("{} of {} blocks, placed alone, agree with the whole", evidence.agreeing,
                  evidence.blocks.size()),
      fmt::format("the probability of the right place (within 5 cm in the plane) is {}",
                  percentOf(plane))};
  if (!evidence.parts.displaced.empty()) {
    reasons.push_back(fmt::format("{}: {:.1f} cm RMS of the whole", describe(evidence.parts),
                                  100 * evidence.parts.rms));
  }
  if (finding.uncertainty) {
    const PoseUncertainty& error = *finding.uncertainty;
    const bool height = std::isfinite(error.height_deviation) && !finding.heights.limited();
    reasons.push_back(fmt::format(
        "expected error {:.1f} cm RMS in the plane{}", 100 * error.expected_rms,
        height ? fmt::format(" and {:.1f} cm in height", 100 * error.height_deviation) : ""));
    reasons.push_back(
        fmt::format("parts of the strip are bent by another {:.1f} cm RMS, which no single "
                    "transformation takes out",
                    100 * error.local_rms));
  }
  return reasons;
}

}  // namespace

VerdictFacts factsOf(const Finding& finding) {
  const Evidence& evidence = finding.evidence;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::optional<PoseUncertainty>& uncertainty = finding.uncertainty;
  return {.uniqueness = evidence.uniqueness,
          .significance = evidence.significance,
          .decoy = evidence.decoyRatio(),
          .agreeing = static_cast<double>(evidence.agreeing),
          .blocks = static_cast<double>(evidence.blocks.size()),
          .expected_rms = uncertainty ? uncertainty->expected_rms : unknown,
          .local_rms = uncertainty ? uncertainty->local_rms : unknown,
          .overlap = finding.overlap};
}

Verdict judge(const Finding& finding, const SearchSpace& space, const VerdictOptions& options) {
  std::vector<std::string> against = contradictions(finding, space, options);
  if (!against.empty()) return {Status::kRejected, std::move(against), 0.0, 0.0, finding.heights};
  const Evidence& evidence = finding.evidence;
  const VerdictFacts facts = factsOf(finding);
  // Whatever the whole says, no pose lays a strip right whose parts do not lie as one.
  const bool apart = evidence.parts.apart();
  const double together = apart ? evidence.parts.probability : 1.0;
  const double plane = together * planeProbability(facts);
  const double place = placeProbability(facts);
  const auto rivals = std::count_if(
      finding.rivals.begin(), finding.rivals.end(),
      [&](double significance) { return significance >= options.rival * evidence.significance; });
  // Of a strip in parts each is the other's rival.
  if (rivals > 0 && !apart && evidence.significance >= options.min_fit) {
    // Right at most as often as the best of so many equals is the true one.
    const double share = 1.0 / (1.0 + static_cast<double>(rivals));
    return {Status::kAmbiguous,
            {fmt::format("{} places fit about equally well, and the data cannot tell them apart; "
                         "a better initial guess can",
                         rivals + 1)},
            std::min(plane, share),
            std::min(place, share),
            finding.heights};
  }
  if (apart || plane < options.min_probability || evidence.uniqueness < options.min_uniqueness) {
    return {Status::kRejected, doubts(finding, plane, place, options), plane, place,
            finding.heights};
  }
  return {Status::kAccepted, support(finding, plane), plane, place, finding.heights};
}

}  // namespace agricolmap::verdict
