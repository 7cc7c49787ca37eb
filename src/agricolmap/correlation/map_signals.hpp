// The signal maps of one grid map, and their whitening, each made once however often it is asked
// for.
#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "agricolmap/correlation/matched_filter.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::correlation {

class MapSignals {
 public:
  /// `grid` must outlive this.
  MapSignals(const map::GridMap& grid, const map::SignalOptions& options)
      : grid_(grid), options_(options) {}

  const map::GridMap& grid() const { return grid_; }
  const map::SignalOptions& options() const { return options_; }

  /// At `factor` grid cells a cell. Not from several threads at once: what is made is made on all
  /// cores.
  const map::SignalMap& at(int factor) const;
  /// The same map whitened; `rim` as of MatchedFilter [cells].
  const MatchedFilter& filter(int factor, const MatchedFilterOptions& options, int rim = 0) const;

 private:
  using FilterKey = std::tuple<int, int, double, double, double>;  // factor, rim, options

  const map::GridMap& grid_;
  map::SignalOptions options_;
  mutable std::map<int, std::unique_ptr<const map::SignalMap>> signals_;
  mutable std::map<FilterKey, std::unique_ptr<const MatchedFilter>> filters_;
};

}  // namespace agricolmap::correlation
