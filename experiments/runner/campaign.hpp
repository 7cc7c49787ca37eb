// Runs what is left of a campaign.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/pairs/pair_maker.hpp"
#include "experiments/runner/plan.hpp"
#include "experiments/runner/row_table.hpp"
#include "experiments/runner/run_pair.hpp"

namespace agricolmap::experiments {

struct CampaignOptions {
  RunOptions runs;
  int jobs = 1;                   ///< children at a time; in process 1
  double stop_after = 0.0;        ///< no pair is begun after this [s]; 0: no end
  std::filesystem::path scratch;  ///< folder for children's files, removed afterwards
};

/// True when nothing is left, false when it stopped early. Throws Interrupted; what is done by then
/// is in the table.
bool runCampaign(const CampaignScope& scope, const CampaignOptions& options, PairMaker& maker,
                 RowTable& table);

}  // namespace agricolmap::experiments
