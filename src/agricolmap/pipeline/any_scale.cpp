#include "agricolmap/pipeline/any_scale.hpp"

#include <optional>

#include "agricolmap/pipeline/attempts.hpp"
#include "agricolmap/pipeline/place.hpp"
#include "agricolmap/pipeline/unknown_scale.hpp"
#include "agricolmap/pipeline/usable.hpp"

namespace agricolmap::pipeline {

std::pair<Outcome, double> placeAtAnyScale(const FixedCloud& fixed, const Cloud& moving,
                                           const Eigen::Affine3d& guess,
                                           const RegistrationOptions& options,
                                           const Locator& locator, Monitor& monitor,
                                           PairMaps& maps) {
  const correlation::MapSignals fixed_signals(maps.fixed, options.signal);
  const Eigen::Affine3d centred = centredGuess(fixed, moving, guess, options.prior);
  const Eigen::Vector3d middle = meanOf(moving);
  const auto mapAt = [&](double factor) {
    mapMoving(fixed.facts(), moving, scaledGuess(middle, centred, factor), options, monitor, maps);
  };
  std::optional<ScaleTrial> best;
  for (const double factor : scaleFactors(maps.moving_box, maps.fixed_box, options.prior)) {
    mapAt(factor);
    Outcome next = place(maps, fixed_signals, 1, options, locator, monitor);
    if (best && !better(next, best->outcome)) continue;
    best = ScaleTrial{factor, maps.frames, std::move(next)};
    if (best->outcome.verdict.status == verdict::Status::kAccepted) break;
  }
  if (!best) throw fitsAtNoScale(fixed.facts(), moving);
  if (!best->outcome.placed) return {std::move(best->outcome), 1.0};
  const double scale = scaleOf(*best, maps.space.scale_axes);
  mapAt(scale);
  ScaleTrial found = carriedOver(*std::move(best), maps.frames);
  const correlation::MapSignals moving_signals(maps.moving, options.signal);
  const refine::PairSignals signals = signalsOf(fixed_signals, moving_signals, options, monitor);
  return {settle(maps, signals, std::move(found.outcome.trace.located),
                 std::move(found.outcome.rivals), options, monitor),
          scale};
}

}  // namespace agricolmap::pipeline
