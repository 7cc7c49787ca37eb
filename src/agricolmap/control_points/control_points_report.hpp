// A transformation from hand-picked pairs, as a report for programs, spreadsheets and people.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "agricolmap/control_points/control_points.hpp"

namespace agricolmap::control_points {

/// Everything in the estimate; keys: docs/control-points.md. `source` is the table's path. Dump it
/// with `error_handler_t::replace`: names are whatever bytes the table has.
nlohmann::ordered_json controlPointsJson(std::span<const ControlPair> pairs,
                                         const ControlEstimate& estimate,
                                         const std::string& source);

/// One line per pair: name, use, outlier, weight, residuals, residuals when left out [m].
std::string residualsCsv(std::span<const ControlPair> pairs, const ControlEstimate& estimate);

/// The same to be read on a terminal, with what was found above and the errors per axis below.
std::string residualsTable(std::span<const ControlPair> pairs, const ControlEstimate& estimate);

}  // namespace agricolmap::control_points
