#include "agricolmap/pipeline/located.hpp"

#include "agricolmap/pipeline/usable.hpp"

namespace agricolmap::pipeline {

Located locate(const PairMaps& maps, const refine::PairSignals& signals,
               const locate::CorrelationOptions& search, const RegistrationOptions& options,
               const Locator& locator, Monitor& monitor) {
  return monitor.run(Stage::kLocate, [&]() -> Located {
    if (locator) return locator(maps.fixed, maps.moving, maps.space, monitor);
    if (options.association == AssociationKind::kFlow) {
      paper::FlowResult found =
          paper::associateByFlow(maps.fixed, maps.moving, maps.space, options.flow, monitor);
      return {std::move(found.placements),
              std::move(found.matches),
              std::move(found.rematches),
              {},
              found.report};
    }
    locate::SearchResult found =
        locate::searchByCorrelation(signals.fixed(), signals.moving(), maps.space, search);
    if (found.report.too_much_work) monitor.warn(workExceeded(found.report, search));
    return {std::move(found.placements), {}, {}, found.report, {}};
  });
}

}  // namespace agricolmap::pipeline
