#include "agricolmap/correlation/map_signals.hpp"

namespace agricolmap::correlation {

const map::SignalMap& MapSignals::at(int factor) const {
  std::unique_ptr<const map::SignalMap>& signal = signals_[factor];
  if (!signal) {
    signal = std::make_unique<map::SignalMap>(map::makeSignalMap(grid_, factor, options_));
  }
  return *signal;
}

const MatchedFilter& MapSignals::filter(int factor, const MatchedFilterOptions& options,
                                        int rim) const {
  const map::SignalMap& signal = at(factor);
  std::unique_ptr<const MatchedFilter>& filter =
      filters_[{factor, rim, options.floor, options.height_weight, options.luminance_weight}];
  if (!filter) filter = std::make_unique<MatchedFilter>(signal, options, rim);
  return *filter;
}

}  // namespace agricolmap::correlation
