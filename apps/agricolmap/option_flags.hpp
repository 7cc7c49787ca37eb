// Command-line flags from an option table: `--grid.cell 0.02`, `--prior.heading-deg 3`.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"

namespace agricolmap {

/// The flag of an option or argument: `--prior.heading-deg` for `prior.heading_deg`.
std::string flagOf(std::string_view path);
/// What stands for a flag spelled with `_`, as options are in files, becomes one with `-`.
std::string spelledWithDashes(std::string_view argument);

/// The texts given for options on the command line, kept until the preset and the configuration
/// file have been read: flags win over both.
class OptionFlags {
 public:
  /// Adds a flag per field of `table` but those in `left_out`, with unit, limits and default in its
  /// help, under the title of its group or, without one, under `heading`. Where a table has options
  /// of both levels, `--help` shows the basic ones and `--help-all`, added too, shows all.
  void addTo(CLI::App& app, const OptionTable& table, const std::string& heading,
             const std::vector<std::string>& left_out = {});
  /// Writes what was given into `table`; throws UsageError for values that do not parse or lie
  /// outside their limits.
  void apply(const OptionTable& table) const;
  /// Whether the command line has the flag of this option.
  bool given(const std::string& path) const;
  /// The options that the command line has flags of.
  std::vector<std::string> given() const;

 private:
  std::map<std::string, std::shared_ptr<std::string>> texts_;
};

}  // namespace agricolmap
