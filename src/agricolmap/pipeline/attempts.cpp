#include "agricolmap/pipeline/attempts.hpp"

#include <algorithm>

namespace agricolmap::pipeline {
namespace {

int rankOf(verdict::Status status) {
  return status == verdict::Status::kAccepted ? 2 : status == verdict::Status::kAmbiguous ? 1 : 0;
}

double significanceOf(const Outcome& outcome) {
  return outcome.placed ? outcome.placed->evidence.significance : 0.0;
}

}  // namespace

bool better(const Outcome& a, const Outcome& b) {
  if (a.placed.has_value() != b.placed.has_value()) return a.placed.has_value();
  if (rankOf(a.verdict.status) != rankOf(b.verdict.status)) {
    return rankOf(a.verdict.status) > rankOf(b.verdict.status);
  }
  if (a.verdict.plane_probability != b.verdict.plane_probability) {
    return a.verdict.plane_probability > b.verdict.plane_probability;
  }
  return significanceOf(a) > significanceOf(b);
}

bool supersedes(const Outcome& later, const Outcome& earlier, double rival) {
  if (earlier.verdict.status != verdict::Status::kAmbiguous) return better(later, earlier);
  double highest = significanceOf(earlier);
  for (const refine::RefinedPose& other : earlier.rivals) {
    highest = std::max(highest, other.significance);
  }
  return later.verdict.status != verdict::Status::kRejected &&
         highest < rival * significanceOf(later);
}

}  // namespace agricolmap::pipeline
