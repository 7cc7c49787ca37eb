// Stage 8: accept or reject, from evidence, with the reasons in plain words.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/4_associate/association.hpp"
#include "agricolmap/7_verdict/evidence.hpp"
#include "agricolmap/core/options.hpp"

namespace agricolmap {

enum class Status { kAccepted, kRejected };
const char* toString(Status status);

struct VerdictOptions {
  double min_uniqueness = 1.8;
  double min_agreement = 0.55;
  double min_overlap = 0.4;
  double scale_margin = 0.05;
  double heading_margin_deg = 2.0;
};
void describe(OptionTable& table, VerdictOptions& options);

struct Verdict {
  Status status = Status::kRejected;
  std::vector<std::string> reasons;  ///< why, in plain words; never empty
};

/// Judges a pose in the levelled frames. `overlap` is the share of the moving map's cells that the
/// fixed map sees.
Verdict judge(const Evidence& evidence, double overlap, const Eigen::Affine2d& pose,
              const SearchSpace& space, const VerdictOptions& options);

/// The verdict on a pair for which a stage found no answer at all.
Verdict rejectBecause(std::string reason);

}  // namespace agricolmap
