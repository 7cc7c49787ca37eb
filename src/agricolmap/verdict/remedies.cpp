#include "agricolmap/verdict/remedies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::verdict {
namespace {

/// Ratios of the peak to the highest wrong one at which strips are told apart with ease.
constexpr double kClearUniqueness = 1.8;
constexpr double kClearDecoy = 1.4;
/// Below this ratio the peak may be chance, and says nothing about a longer strip's.
constexpr double kLeastTelling = 1.1;
constexpr double kFarthestDrive = 40.0;  // [m], more is no advice
constexpr double kNarrow = 1.2;          // strip of two rows [m]
constexpr double kGoodGuess = 1.0;       // [m]
constexpr double kRightPlace = 0.8;
constexpr double kBesideTheMap = 0.5;  // share of the strip that a guess should lay on the map
constexpr double kAtTheEdge = 0.95;    // of what the guess allows
constexpr double kNoPlace = 0.2;       // of so small a probability the strip may be of elsewhere

/// Factor by which the strip's area is too small for a clear peak; 1: it is not.
double areaWanted(const Evidence& evidence) {
  double ratio = kClearUniqueness / std::max(evidence.uniqueness, 1e-3);
  if (!evidence.decoys.empty()) {
    ratio = std::max(ratio, kClearDecoy / std::max(evidence.decoyRatio(), 1e-3));
  }
  return std::max(1.0, ratio * ratio);
}

void adviseLength(const Evidence& evidence, std::vector<std::string>& remedies) {
  const Eigen::Vector2d size = 2.0 * evidence.strip.half_extent;
  const double wanted = areaWanted(evidence);
  if (!(wanted > 1.0)) return;
  const double further = std::ceil((wanted - 1.0) * size.x());
  const double ratio = evidence.decoys.empty()
                           ? evidence.uniqueness
                           : std::min(evidence.uniqueness, evidence.decoyRatio());
  if (ratio >= kLeastTelling && further <= kFarthestDrive) {
    remedies.push_back(fmt::format(
        "drive about {:.0f} m further: the strip is {:.1f} x {:.1f} m, and its peak over the "
        "highest wrong one grows with the root of its area",
        std::max(1.0, further), size.x(), size.y()));
  } else {
    remedies.push_back(
        fmt::format("map a larger strip than {:.1f} x {:.1f} m", size.x(), size.y()));
  }
  if (size.y() < kNarrow) {
    remedies.emplace_back("map a second pass beside it: so narrow a strip holds one row or two");
  }
}

void adviseGuess(const PriorUncertainty& guess, std::vector<std::string>& remedies) {
  if (guess.anywhere()) {
    remedies.emplace_back(
        "say about where the strip lies (a GPS fix of one end will do) and how good that is: "
        "without "
        "it every place of the map competes");
  } else if (guess.translation > kGoodGuess) {
    remedies.push_back(
        fmt::format("if the guess is better than {:.3g} m, {:.3g} deg and {:.0f} % of scale, say "
                    "so: fewer places "
                    "compete then",
                    guess.translation, guess.heading_deg, 100.0 * guess.scale));
  }
}

/// The limits of the guess that the answer is as far from it as: the right one may be farther.
/// Empty: none.
std::string edgeReached(const Finding& finding, const SearchSpace& space) {
  const Eigen::Vector2d moved = finding.pose * space.centre - space.centre;
  const HorizontalParts parts =
      splitHorizontal(space.scale_axes.transpose() * finding.pose.linear() * space.scale_axes);
  const PriorUncertainty& guess = space.uncertainty;
  std::vector<std::string> reached;
  if (moved.norm() > kAtTheEdge * guess.translation) {
    reached.push_back(fmt::format("{:.3g} m", guess.translation));
  }
  if (guess.heading_deg < 180.0 && degrees(std::abs(parts.yaw)) > kAtTheEdge * guess.heading_deg) {
    reached.push_back(fmt::format("{:.3g} deg", guess.heading_deg));
  }
  return fmt::format("{}", fmt::join(reached, " and "));
}

/// What is wrong before anything is compared: the guess, or the files. True where one is told.
bool adviseInputs(const Verdict& verdict, const Finding& finding, const SearchSpace& space,
                  std::vector<std::string>& remedies) {
  const std::size_t before = remedies.size();
  if (verdict.place_probability >= kRightPlace) return false;
  if (finding.guessed_overlap < kBesideTheMap) {
    remedies.push_back(fmt::format(
        "check the guess, and that the fixed map shows the place: the guess lays {:.0f} % of the "
        "strip on it",
        100.0 * finding.guessed_overlap));
  }
  const std::string edge = edgeReached(finding, space);
  if (verdict.status == Status::kRejected && !edge.empty()) {
    remedies.push_back(
        fmt::format("if the guess may be wrong by more than {}, say so: the best answer is as far "
                    "from it as that allows",
                    edge));
  }
  const bool told = remedies.size() > before;
  if (verdict.status == Status::kRejected && verdict.place_probability < kNoPlace) {
    remedies.emplace_back(
        "check that both files are of the same field and of days not far apart: the strip fits "
        "nowhere better than by chance");
  }
  return told;
}

bool beyond(double value, double limit) { return !(value <= limit); }

/// Where the answer lies outside of what the guess allows.
void adviseLimits(const Finding& finding, const SearchSpace& space, const VerdictOptions& options,
                  std::vector<std::string>& remedies) {
  const HorizontalParts parts =
      splitHorizontal(space.scale_axes.transpose() * finding.pose.linear() * space.scale_axes);
  const double limit = std::log(std::exp(logScaleLimit(space.uncertainty)) + options.scale_margin);
  if (beyond(std::abs(std::log(parts.scale_x)), limit) ||
      beyond(std::abs(std::log(parts.scale_y)), limit)) {
    remedies.emplace_back(
        "check the units of both clouds; if the moving cloud's is not known, say so, and its scale "
        "is found, too");
  }
  if (beyond(degrees(std::abs(parts.yaw)),
             space.uncertainty.heading_deg + options.heading_margin_deg)) {
    remedies.emplace_back("allow the guess a larger error of heading");
  }
  if (finding.overlap < options.min_overlap) {
    remedies.emplace_back(
        "use a fixed map that shows the whole strip, or a guess that does not lead beyond it");
  }
}

}  // namespace

std::vector<std::string> remediesFor(const Verdict& verdict, const Finding& finding,
                                     const SearchSpace& space, const VerdictOptions& options) {
  std::vector<std::string> remedies;
  if (verdict.status == Status::kAccepted) return remedies;
  adviseLimits(finding, space, options, remedies);
  const bool beyond_limits = !remedies.empty();  // where no part of it can be right
  const Evidence& evidence = finding.evidence;
  if (verdict.status == Status::kAmbiguous || verdict.place_probability < kRightPlace) {
    const bool inputs = !beyond_limits && adviseInputs(verdict, finding, space, remedies);
    // Where the right place was not looked at, a longer strip or a narrower guess would miss it,
    // too.
    if (!inputs) {
      adviseLength(evidence, remedies);
      adviseGuess(space.uncertainty, remedies);
    }
  }
  if (evidence.parts.apart() && !beyond_limits) {
    remedies.emplace_back("register the strip in parts, or mend its odometry where they join");
  } else if (remedies.empty() || verdict.place_probability >= kRightPlace) {
    remedies.emplace_back(
        "use maps that were made nearer in time, in less wind or with less drift: the place may be "
        "right, but the two do not fit one another to 5 cm");
  }
  return remedies;
}

std::vector<std::string> remediesForNothing(const SearchSpace& space) {
  std::vector<std::string> remedies = {
      "check that both clouds show the same place, and that the guess leads from the moving file's "
      "coordinates to the fixed one's"};
  if (!space.uncertainty.anywhere()) {
    remedies.push_back(fmt::format("allow the guess a larger error than {:.3g} m and {:.3g} deg",
                                   space.uncertainty.translation, space.uncertainty.heading_deg));
  }
  if (!space.uncertainty.scale_unknown) {
    remedies.emplace_back("if the moving cloud's unit is not known, say so");
  }
  remedies.emplace_back("use denser clouds: both are compared in cells of centimetres");
  return remedies;
}

}  // namespace agricolmap::verdict
