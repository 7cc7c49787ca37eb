#include "agricolmap/batch/settings.hpp"

#include <fmt/format.h>

#include "agricolmap/config/text.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap::batch {

void SettingsPatch::applyTo(Settings& settings) const {
  if (preset) settings.preset = *preset;
  for (const auto& [path, text] : options) settings.options[path] = text;
  if (aligned) settings.aligned = *aligned;
  if (keep_rejected) settings.keep_rejected = *keep_rejected;
  if (pictures) settings.pictures = *pictures;
}

pipeline::RegistrationOptions optionsOf(const Settings& settings) {
  pipeline::RegistrationOptions options = pipeline::preset(settings.preset);
  config::applyOptions(settings.options, optionTable(options));
  std::vector<std::string> paths;
  for (const auto& [path, text] : settings.options) paths.push_back(path);
  const std::string idle = idleOption(options, paths);
  if (!idle.empty()) throw UsageError("option " + idle);
  return pipeline::resolved(options);
}

std::string idleOption(const pipeline::RegistrationOptions& chosen,
                       const std::vector<std::string>& paths) {
  pipeline::RegistrationOptions options = chosen;
  pipeline::RegistrationOptions defaults;
  defaults.geometry_only = chosen.geometry_only;
  defaults = pipeline::resolved(defaults);
  const OptionTable table = optionTable(options);
  const OptionTable usual = optionTable(defaults);
  for (const std::string& path : paths) {
    const std::string missing = pipeline::missingFor(chosen, path);
    const std::string value = config::optionText(*table.find(path));
    if (!missing.empty() && value != config::optionText(*usual.find(path))) {
      return fmt::format("{} = {} would do nothing: it needs {}", path, value, missing);
    }
  }
  return {};
}

}  // namespace agricolmap::batch
