#include "runner/datasets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "agricolmap/core/error.hpp"

namespace agricolmap::experiments {
namespace {

/// The case of the campaign's paper suite that a data set is made of.
struct Origin {
  const char* name;
  const char* case_name;
  DataKind kind;
};
constexpr Origin kOrigins[] = {
    {"soybean", "soybean-easy", DataKind::kSimulated},
    {"sugar-beet-10m", "sugar-beet-10m-easy", DataKind::kSimulated},
    {"sugar-beet-20m", "sugar-beet-20m-easy", DataKind::kSimulated},
    {"winter-wheat", "winter-wheat-easy", DataKind::kSimulated},
    {"semireal-sugarbeet", "semireal-sugarbeet", DataKind::kSemiReal},
    {"real-soybean", "real-soybean", DataKind::kSemiReal},
};

/// The comparison disturbs the exact guess itself, for all methods alike.
void makeGuessExact(simulate::GeotagOptions& geotag) {
  geotag.translation = geotag.heading_deg = geotag.scale = 0.0;
  geotag.z = geotag.tilt_deg = geotag.across_rows = 0.0;
  geotag.unknown_scale = 1.0;
}

}  // namespace

std::string toString(DataKind kind) {
  if (kind == DataKind::kReal) return "real";
  return kind == DataKind::kSimulated ? "simulated" : "semi-real";
}

std::vector<DataSet> allDataSets(Views views, bool quick) {
  const std::vector<Case> cases = campaign::suiteCases("paper", false);
  std::vector<DataSet> sets;
  for (const Origin& origin : kOrigins) {
    const auto found = std::find_if(
        cases.begin(), cases.end(),
        [&](const Case& one) { return one.name == origin.case_name; });
    if (found == cases.end()) continue;
    DataSet set{origin.name, origin.kind, *found};
    set.pairs.max_pairs = 0;
    set.pairs.ranges = viewRanges(views, set.pairs.source);
    makeGuessExact(set.pairs.options.geotag);
    if (quick && set.pairs.source == PairSource::kSimulated) {
      set.pairs.options.field.width = set.pairs.options.field.height = 14.0;
    }
    if (quick) {
      set.pairs.options.ugv.length = 6.0;
      std::erase_if(set.pairs.ranges, [](const auto& one) { return one.path == "ugv.length"; });
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

std::vector<std::string> dataSetNames() {
  std::vector<std::string> names;
  for (const Origin& origin : kOrigins) names.emplace_back(origin.name);
  return names;
}

std::vector<DataSet> chooseDataSets(const std::vector<std::string>& names, Views views,
                                    bool quick) {
  const std::vector<DataSet> all = allDataSets(views, quick);
  std::vector<DataSet> chosen;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const DataSet& one) { return one.name == name; });
    if (found == all.end()) {
      throw UsageError(fmt::format("unknown data set '{}'; there are: {}", name,
                                   fmt::join(dataSetNames(), ", ")));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace agricolmap::experiments
