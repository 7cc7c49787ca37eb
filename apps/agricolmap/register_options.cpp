#include "register_options.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <vector>

#include "agricolmap/batch/settings.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap {
namespace {

/// The parts between commas, without blanks around them; empty for a part with blanks inside.
std::vector<std::string_view> partsOf(std::string_view text) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = text.find(',');
    std::string_view part = text.substr(0, comma);
    const std::string_view word = io::takeWord(part);
    parts.push_back(io::takeWord(part).empty() ? word : std::string_view());
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

/// `T_M,HEADING_DEG,SCALE_PERCENT` or `none`, each value within its option's limits.
void applyPriorSigma(const std::string& text, PriorUncertainty& prior, const OptionTable& table) {
  if (text == "none") {
    const bool scale_unknown = prior.scale_unknown;
    prior = PriorUncertainty::none();
    prior.scale_unknown = scale_unknown;
    return;
  }
  const std::vector<std::string_view> parts = partsOf(text);
  const std::optional<double> scale =
      parts.size() == 3 ? io::parseNumber(parts[2]) : std::optional<double>();
  if (!scale) {
    throw UsageError(fmt::format(
        "--prior-sigma {}: is neither T_M,HEADING_DEG,SCALE_PERCENT (such as 5,11.5,30) nor 'none'",
        text));
  }
  const auto set = [&](const char* key, std::string_view value) {
    try {
      config::parseOption(*table.find(key), value)();
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("--prior-sigma {}: {}", text, error.what()));
    }
  };
  set("prior.translation", parts[0]);
  set("prior.heading_deg", parts[1]);
  set("prior.scale", fmt::format("{:.17g}", *scale / 100.0));
}

/// Refuses flags that would do nothing, and what of a file would.
void refuseIdle(const pipeline::RegistrationOptions& chosen, const std::vector<std::string>& flags,
                const std::vector<std::string>& in_file) {
  for (const std::string& path : flags) {
    const std::string missing = pipeline::missingFor(chosen, path);
    if (!missing.empty()) {
      throw UsageError(fmt::format("{} would do nothing: it needs {}", flagOf(path), missing));
    }
  }
  const std::string idle = batch::idleOption(chosen, in_file);
  if (!idle.empty()) {
    throw UsageError(fmt::format("option {} (of the options file)", idle));
  }
}

}  // namespace

void RegisterOptions::addTo(CLI::App& command) {
  command.add_option("--prior-sigma", prior_sigma_,
                     "How wrong the initial guess may be: T_M,HEADING_DEG,SCALE_PERCENT, or 'none' "
                     "for no guess: any place and heading [5,11.5,30]");
  command.add_flag("--scale-unknown", scale_unknown_,
                   "MOVING is in unknown units: find its overall scale, too, a factor from 0.1 to "
                   "10");
  command.add_option("--preset", preset_, "default, paper or paper-literal [default]");
  command.add_option("--config", config_, "YAML file with options");
  pipeline::RegistrationOptions defaults;
  flags_.addTo(command, optionTable(defaults), "Options of the pipeline", {"seed"});
}

pipeline::RegistrationOptions RegisterOptions::chosen(const Globals& globals) const {
  pipeline::RegistrationOptions options = pipeline::preset(preset_);
  OptionTable table = optionTable(options);
  std::vector<std::string> in_file;
  if (!config_.empty()) in_file = config::loadYaml(config_, table);
  if (globals.seed_given) options.seed = globals.seed;
  if (!prior_sigma_.empty()) applyPriorSigma(prior_sigma_, options.prior, table);
  if (scale_unknown_) options.prior.scale_unknown = true;
  flags_.apply(table);
  refuseIdle(options, flags_.given(), in_file);
  return pipeline::resolved(options);
}

}  // namespace agricolmap
