#include "agricolmap/stages.hpp"

#include <algorithm>
#include <utility>

#include "agricolmap/api/checks.hpp"
#include "agricolmap/api/compared.hpp"
#include "agricolmap/api/finished.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/pipeline/compose.hpp"
#include "agricolmap/pipeline/place.hpp"
#include "agricolmap/pipeline/usable.hpp"
#include "agricolmap/refine/multi_start.hpp"
#include "agricolmap/verdict/verdict.hpp"

namespace agricolmap {
namespace {

std::shared_ptr<const Cloud> whole(std::shared_ptr<const Cloud> cloud) {
  if (!cloud) throw UsageError("a pair needs two clouds");
  requireWhole(*cloud);
  return cloud;
}

pipeline::PairMaps mapsOf(const Cloud& fixed, const Cloud& moving, const Asked& asked,
                          Monitor& monitor) {
  if (asked.options.prior.scale_unknown) {
    throw UsageError("stages one by one need a moving cloud whose scale is known to the prior");
  }
  const CloudStream stream(fixed);
  pipeline::requireUsable(stream.facts(), factsOf(moving), asked.options, false);
  return pipeline::mapPair(pipeline::FixedCloud(stream), moving, Eigen::Affine3d(asked.guess),
                           asked.options, monitor);
}

}  // namespace

struct Pair::Inside {
  Inside(std::shared_ptr<const Cloud> fixed_cloud, std::shared_ptr<const Cloud> moving_cloud,
         Asked how, Monitor& monitor)
      : fixed(std::move(fixed_cloud)),
        moving(std::move(moving_cloud)),
        asked(std::move(how)),
        maps(mapsOf(*fixed, *moving, asked, monitor)),
        fixed_signals(maps.fixed, asked.options.signal),
        moving_signals(maps.moving, asked.options.signal),
        signals(fixed_signals, moving_signals, asked.options.hidden, asked.options.filter),
        waves(locate::rowWaves(fixed_signals, moving_signals)) {}

  pipeline::FrameChange change() const { return {fixed->origin, moving->origin, maps.frames}; }

  Transform inFiles(const Eigen::Affine2d& pose) const {
    const refine::VerticalResult vertical =
        refine::fitVertical(maps.fixed, maps.moving, pose, asked.options.vertical);
    return change().inFiles(change().local(refine::liftPose(pose, vertical)));
  }
  Eigen::Affine2d poseOf(const Place& place) const {
    const Eigen::Affine3d levelled = change().levelled(Eigen::Affine3d(place.fixed_from_moving));
    Eigen::Affine2d pose;
    pose.linear() = levelled.linear().topLeftCorner<2, 2>();
    pose.translation() = levelled.translation().head<2>();
    return pose;
  }

  std::shared_ptr<const Cloud> fixed;
  std::shared_ptr<const Cloud> moving;
  Asked asked;
  pipeline::PairMaps maps;
  correlation::MapSignals fixed_signals;
  correlation::MapSignals moving_signals;
  refine::PairSignals signals;
  locate::RowWaves waves;
};

Pair::Pair(std::shared_ptr<const Cloud> fixed, std::shared_ptr<const Cloud> moving,
           const Transform& guess, const Options& options, const Control& control) {
  requireProcessor();
  auto fixed_cloud = whole(std::move(fixed));
  auto moving_cloud = whole(std::move(moving));
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  Monitor monitor = monitorFor(control);
  inside_ = std::make_unique<const Inside>(
      std::move(fixed_cloud), std::move(moving_cloud),
      Asked{guess, optionsInForce(options), options.preset(), control.threads}, monitor);
}
Pair::Pair(Pair&& other) noexcept = default;
Pair& Pair::operator=(Pair&& other) noexcept = default;
Pair::~Pair() = default;

ComparedMaps Pair::maps() const {
  return comparedMaps(inside_->maps, {}, inside_->fixed->origin,
                      {inside_->fixed->hasColour(), inside_->moving->hasColour()});
}

std::vector<Place> Pair::locate(const Control& control) const {
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  Monitor monitor = monitorFor(control);
  const pipeline::RegistrationOptions& options = inside_->asked.options;
  const pipeline::Located located = pipeline::locate(
      inside_->maps, inside_->signals, inside_->waves, options.search, options, {}, monitor);
  std::vector<Place> places;
  for (const Placement& placement : located.placements) {
    places.push_back({inside_->inFiles(placement.pose), placement.score});
  }
  return places;
}

std::vector<Place> Pair::refine(const std::vector<Place>& places, const Control& control) const {
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  Monitor monitor = monitorFor(control);
  const pipeline::RegistrationOptions& options = inside_->asked.options;
  const refine::DenseRefineOptions dense = pipeline::denseInForce(options);
  return monitor.run(Stage::kRefine, [&] {
    std::vector<Eigen::Affine2d> starts;
    for (const Place& place : places) starts.push_back(inside_->poseOf(place));
    std::vector<Place> refined;
    for (const refine::RefinedPose& pose :
         refine::refineStarts(inside_->signals, starts, options.evidence.exclusion, dense)
             .distinct) {
      const refine::RefinedPose fine = refine::refineFinely(inside_->signals, pose, dense);
      refined.push_back({inside_->inFiles(fine.pose), pose.significance});
    }
    return refined;
  });
}

Registration Pair::judge(const std::vector<Place>& places, const Control& control) const {
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  Monitor monitor = monitorFor(control);
  const pipeline::RegistrationOptions& options = inside_->asked.options;
  pipeline::Located given;
  for (const Place& place : places)
    given.placements.push_back({inside_->poseOf(place), place.score, {}});
  const pipeline::Locator locator = [&](const map::GridMap&, const map::GridMap&,
                                        const SearchSpace&, Monitor&) { return given; };
  pipeline::Located located = pipeline::locate(inside_->maps, inside_->signals, inside_->waves,
                                               options.search, options, locator, monitor);
  pipeline::Outcome outcome =
      pipeline::settle(inside_->maps, inside_->signals, std::move(located), {}, options, monitor);
  pipeline::warnOfFlat(inside_->maps.fixed, inside_->maps.moving, options.signal, monitor);
  if (options.require_heights) verdict::requireHeights(outcome.verdict);
  pipeline::Registration found = monitor.run(Stage::kCompose, [&] {
    return pipeline::compose(factsOf(*inside_->fixed), *inside_->moving, inside_->maps,
                             std::move(outcome), 1.0, options);
  });
  return finished(*inside_->fixed, *inside_->moving, std::move(found), inside_->asked, monitor);
}

}  // namespace agricolmap
