// What a method found, as the JSON file that a child hands to whoever started it.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// An outcome with what it cost.
struct Answer {
  MethodOutcome outcome;
  double run_s = 0.0;     ///< the registration alone [s]
  double read_s = 0.0;    ///< reading the clouds [s]
  double idle_mib = 0.0;  ///< memory before anything was read [MiB]
  double peak_mib = 0.0;  ///< most memory [MiB]
};

/// "accepted", "ambiguous", "rejected", or "failed" without a transform.
std::string statusOf(const MethodOutcome& outcome);

/// Matrices column by column.
std::string toJson(const Answer& answer, const std::string& method);
/// Throws InputError for a file that `toJson` did not write.
Answer readAnswer(const std::filesystem::path& path);

}  // namespace agricolmap::experiments
