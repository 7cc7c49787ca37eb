// Runs what is left of a campaign.
#pragma once

#include "experiments/pairs/pair_maker.hpp"
#include "experiments/runner/plan.hpp"
#include "experiments/runner/row_table.hpp"

namespace agricolmap::experiments {

/// True when nothing is left; false when it began no further pair after `stop_after` [s] (0: no
/// end). Throws Interrupted; what is done by then is in the table.
bool runCampaign(const CampaignScope& scope, double stop_after, PairMaker& maker, RowTable& table);

}  // namespace agricolmap::experiments
