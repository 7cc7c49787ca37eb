// Command-line flags from an option table: `--grid.cell 0.02`.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agricolmap/core/options.hpp"

namespace agricolmap {

/// The texts given for options on the command line, kept until the preset and the configuration
/// file have been read: flags win over both.
class OptionFlags {
 public:
  /// Adds a flag per field of `table` but those in `left_out`, with unit, limits and default in its
  /// help.
  void addTo(CLI::App& app, const OptionTable& table, const std::string& group,
             const std::vector<std::string>& left_out = {});
  /// Writes what was given into `table`; throws UsageError for values that do not parse or lie
  /// outside their limits.
  void apply(const OptionTable& table) const;
  /// Whether the command line has the flag of this option, or any.
  bool given(const std::string& path) const;
  bool anyGiven() const;

 private:
  std::map<std::string, std::shared_ptr<std::string>> texts_;
};

}  // namespace agricolmap
