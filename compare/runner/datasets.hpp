// What the comparison registers: the paper's four fields, simulated, and strips of real imagery.
#pragma once

#include <string>
#include <vector>

#include "campaign_cases.hpp"

namespace agricolmap::compare {

enum class DataKind { kSimulated, kSemiReal };
std::string toString(DataKind kind);

struct DataSet {
  std::string name;
  DataKind kind;
  campaign::CampaignCase pairs;  ///< with an exact guess
};

/// `quick`: small fields and short strips.
std::vector<DataSet> allDataSets(bool quick);
std::vector<std::string> dataSetNames();
/// Throws UsageError, listing the known names, for an unknown one.
std::vector<DataSet> chooseDataSets(const std::vector<std::string>& names, bool quick);

}  // namespace agricolmap::compare
