#include "agricolmap/pipeline/compose.hpp"

namespace agricolmap::pipeline {
namespace {

Transform transformOf(const CloudFacts& fixed, const PairMaps& maps, const FrameChange& change,
                      const Placed& placed, double scale) {
  const Eigen::Affine3d levelled = refine::liftPose(placed.pose, placed.heights);
  Transform transform;
  transform.local_fixed_from_moving = change.local(levelled);
  transform.fixed_from_moving = change.inFiles(transform.local_fixed_from_moving);
  const Eigen::Matrix2d& axes = maps.space.scale_axes;
  transform.parts = splitHorizontal(axes.transpose() * placed.pose.linear() * axes);
  transform.parts.scale_x *= scale;
  transform.parts.scale_y *= scale;
  transform.vertical_scale = scale * placed.heights.scale;
  const Eigen::Rotation2Dd back(-maps.frames.turn);
  transform.tilt = (back * placed.heights.slope).array().atan().matrix();
  const Eigen::Vector3d middle(maps.space.centre.x(), maps.space.centre.y(), 0.0);
  transform.shift = levelled * middle - middle;
  transform.shift.head<2>() = back * transform.shift.head<2>();
  transform.centre = fixed.origin + maps.frames.levelled_from_fixed.inverse() * (levelled * middle);
  return transform;
}

/// Other places that rival an ambiguous one's significance.
std::vector<Alternative> alternativesTo(const Outcome& outcome, const PairMaps& maps,
                                        const FrameChange& change,
                                        const RegistrationOptions& options) {
  std::vector<Alternative> alternatives;
  if (outcome.verdict.status != verdict::Status::kAmbiguous) return alternatives;
  for (const refine::RefinedPose& rival : outcome.rivals) {
    if (rival.significance < options.verdict.rival * outcome.placed->evidence.significance) break;
    const refine::VerticalResult vertical =
        refine::fitVertical(maps.fixed, maps.moving, rival.pose, options.vertical);
    alternatives.push_back(
        {.fixed_from_moving = change.inFiles(change.local(refine::liftPose(rival.pose, vertical))),
         .significance = rival.significance});
  }
  return alternatives;
}

}  // namespace

Registration compose(const CloudFacts& fixed, const Cloud& moving, PairMaps maps, Outcome outcome,
                     double scale, const RegistrationOptions& options) {
  Registration result;
  if (outcome.placed) {
    const FrameChange change(fixed.origin, moving.origin, maps.frames);
    result.transform = transformOf(fixed, maps, change, *outcome.placed, scale);
    result.alternatives = alternativesTo(outcome, maps, change, options);
  }
  result.verdict = std::move(outcome.verdict);
  result.placed = std::move(outcome.placed);
  result.trace = std::move(outcome.trace);
  result.maps = std::move(maps);
  return result;
}

}  // namespace agricolmap::pipeline
