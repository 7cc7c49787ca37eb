// Affine coherent point drift on the vegetation points.
#include <fmt/format.h>

#include "agricolmap/paper/cpd/cpd.hpp"
#include "experiments/methods/peer_maps.hpp"
#include "experiments/methods/peers.hpp"

namespace agricolmap::experiments {

void cpdAffine(const MethodInput& input, MethodOutcome& outcome) {
  paper::CpdOptions options;
  options.start_weight = 0.0;  // the article knows no pull towards the start
  options.max_motion = 20.0;   // nor a limit to the motion
  const PeerMaps maps = makePeerMaps(input, outcome.times);
  const auto most = static_cast<std::size_t>(options.max_points);
  const PeerPoints points =
      makePeerPoints(maps, maps.space.uncertainty.translation + 1.0, 4 * most, most, outcome.times);
  const paper::CpdResult result = outcome.times.run(
      "cpd", [&] { return paper::refineByCpd(points.fixed, points.moving, {}, options); });
  if (!result.usable()) {
    outcome.why = fmt::format("no registration: {}", toString(result.status));
    return;
  }
  outcome.accepted = result.status == paper::CpdStatus::kConverged;
  if (!outcome.accepted) outcome.why = toString(result.status);
  setPlanePose(maps, input, result.pose.plane, outcome);
}

}  // namespace agricolmap::experiments
