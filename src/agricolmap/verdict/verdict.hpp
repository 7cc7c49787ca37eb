// Stage judge: accept, reject or say that the data cannot tell, from evidence, with the reasons in
// plain words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/verdict/evidence.hpp"
#include "agricolmap/verdict/heights.hpp"
#include "agricolmap/verdict/probability.hpp"
#include "agricolmap/verdict/uncertainty.hpp"

namespace agricolmap::verdict {

/// kAmbiguous: the maps fit, but in several places that the data cannot tell apart.
enum class Status { kAccepted, kRejected, kAmbiguous };
const char* toString(Status status);

struct VerdictOptions {
  double min_probability = 0.8;  ///< that the registration is right in the plane
  double min_uniqueness = 1.2;   ///< least ratio of the peak to the next one, whatever else speaks
  double rival = 0.8;            ///< placements of this share of the best significance are rivals
  double min_fit = 8.0;          ///< significance from which on rivals are more than chance
  double min_overlap = 0.25;
  double scale_margin = 0.05;
  double heading_margin_deg = 2.0;
};
void listOptions(OptionTable& table, VerdictOptions& options);

struct Verdict {
  Status status = Status::kRejected;
  std::vector<std::string> reasons;  ///< why, in plain words; never empty
  double plane_probability = 0.0;    ///< that the result is within 5 cm RMS in the plane
  double place_probability = 0.0;    ///< calibrated, that it is the right place, however exact
  HeightsVerdict heights = {};       ///< of the height, which the status does not hang on
  std::vector<std::string> remedies = {};  ///< what may help; empty when accepted
};

/// What is judged.
struct Finding {
  Evidence evidence;
  std::optional<PoseUncertainty> uncertainty;
  HeightsVerdict heights = {};
  double overlap = 0.0;  ///< share of the moving map's cells that the fixed map sees
  /// What the guess is held against, levelled moving → levelled fixed: the pose, and of a strip
  /// that slipped that of its longest part.
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  /// Share of the moving map's cells that the guess lays on what the fixed map sees; 1 without one.
  double guessed_overlap = 1.0;
  std::vector<double> rivals;  ///< significances of the other distinct placements
  double slip_rms = 0.0;       ///< part of the expected error: where slips lie, and overlaps [m]
};

/// What the probability of a finding rests on.
VerdictFacts factsOf(const Finding& finding);

Verdict judge(const Finding& finding, const SearchSpace& space, const VerdictOptions& options);

/// The status, and with it that heights are limited where the place is accepted: the first line of
/// what is told of a registration.
std::string headline(const Verdict& verdict);

/// Rejects what is accepted in the plane with limited heights.
void requireHeights(Verdict& verdict);

/// The verdict on a pair for which a stage found no answer at all.
Verdict rejectBecause(std::string reason);

}  // namespace agricolmap::verdict
