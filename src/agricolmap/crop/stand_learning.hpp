// What a field itself says is usual on it, and how far its count may be trusted.
#pragma once

#include <vector>

#include "agricolmap/crop/plant_chain.hpp"

namespace agricolmap::crop {

/// The model as the likeliest explanations of all rows have it.
StandModel relearnt(const std::vector<Chain>& rows, const std::vector<std::vector<Piece>>& pieces,
                    const StandModel& before);

/// Deviation of the number of plants, as a share of it, by what the explanations have in common
/// and may have wrong: 1 in a hundred where plants stand apart in a clear rhythm, more where
/// explanations compete, where the rhythm is not kept, and where the map's cells are coarse.
double modelError(const std::vector<Chain>& rows, const StandModel& model, double cell);

}  // namespace agricolmap::crop
