// The options of `agricolmap register`: from preset, file and flags.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "agricolmap/pipeline/options.hpp"
#include "common.hpp"
#include "option_flags.hpp"

namespace agricolmap {

class RegisterOptions {
 public:
  void addTo(CLI::App& command);
  /// Defaults, then the preset, then the configuration file, then flags, as they are in force.
  /// Throws UsageError for what makes no sense, and for what was given and would do nothing.
  pipeline::RegistrationOptions chosen(const Globals& globals) const;
  const std::string& preset() const { return preset_; }

 private:
  std::string preset_ = "default";
  std::string config_;
  std::string prior_sigma_;
  bool scale_unknown_ = false;
  OptionFlags flags_;
};

}  // namespace agricolmap
