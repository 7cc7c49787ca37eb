// What a registration of a batch is told beside its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "agricolmap/config/yaml_options.hpp"
#include "agricolmap/pipeline/options.hpp"

namespace agricolmap::batch {

struct Settings {
  std::string preset = "default";
  config::OptionTexts options;   ///< over those of the preset
  std::string aligned = "auto";  ///< format of the aligned cloud
  bool keep_rejected = false;
  bool pictures = true;
};

/// What one level of a manifest says of them; nothing: as the level above.
struct SettingsPatch {
  std::optional<std::string> preset;
  config::OptionTexts options;
  std::optional<std::string> aligned;
  std::optional<bool> keep_rejected;
  std::optional<bool> pictures;

  void applyTo(Settings& settings) const;
};

/// The options in force. Throws UsageError for what makes no sense, and for an option that was
/// given and would do nothing.
pipeline::RegistrationOptions optionsOf(const Settings& settings);

/// The first of `paths` that differs from its default under `chosen` and has no effect: "grid.cell
/// = 0.02 would do nothing: it needs ...". Empty where there is none. A file with all options, as
/// --dump-config writes it, is no request for each of them.
std::string idleOption(const pipeline::RegistrationOptions& chosen,
                       const std::vector<std::string>& paths);

}  // namespace agricolmap::batch
