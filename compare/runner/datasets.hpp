// What the comparison registers: the paper's four fields, simulated, strips of real imagery, and
// pairs of real clouds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign_cases.hpp"
#include "data/published.hpp"
#include "runner/views.hpp"

namespace agricolmap::compare {

enum class DataKind {
  kSimulated,
  kSemiReal,  ///< strips of real imagery; the second sensor is simulated
  kReal,      ///< two real clouds
};
std::string toString(DataKind kind);

struct DataSet {
  std::string name;
  DataKind kind;
  campaign::CampaignCase pairs = {};            ///< with an exact guess; not of a real one
  std::optional<PublishedPair> published = {};  ///< of a real one: its only pair
};

/// `quick`: small fields and short strips.
std::vector<DataSet> allDataSets(Views views, bool quick);
std::vector<std::string> dataSetNames();
/// Throws UsageError, listing the known names, for an unknown one.
std::vector<DataSet> chooseDataSets(const std::vector<std::string>& names, Views views, bool quick);

}  // namespace agricolmap::compare
