#include "agricolmap/options.hpp"

#include <fmt/format.h>

#include "agricolmap/api/settings.hpp"
#include "agricolmap/api/values.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap {
namespace {

constexpr const char* kDefaultPreset = "default";

/// The number as the text of such an option.
std::string textFor(const OptionField& field, double value) {
  if (std::holds_alternative<bool*>(field.value) && (value == 0.0 || value == 1.0)) {
    return value == 1.0 ? "true" : "false";
  }
  return fmt::format("{}", value);
}

}  // namespace

Options::Options() : Options(kDefaultPreset) {}

Options::Options(std::string_view preset)
    : values_(new Values{pipeline::preset(std::string(preset)), std::string(preset)}) {}

std::vector<std::string> Options::presets() { return pipeline::presetNames(); }

Options::Options(const Options& other) : values_(new Values(*other.values_)) {}
Options::Options(Options&& other) noexcept = default;
Options& Options::operator=(const Options& other) {
  *this = Options(other);
  return *this;
}
Options& Options::operator=(Options&& other) noexcept = default;
Options::~Options() = default;

void Options::set(std::string_view name, std::string_view value) {
  const OptionTable table = optionTable(values_->options);
  setOption(fieldOf(table, name), value);
}

void Options::set(std::string_view name, double value) {
  const OptionTable table = optionTable(values_->options);
  const OptionField& field = fieldOf(table, name);
  setOption(field, textFor(field, value));
}

std::string Options::get(std::string_view name) const {
  return config::optionText(fieldOf(optionTable(values_->options), name));
}

std::vector<OptionInfo> Options::list() const {
  pipeline::RegistrationOptions defaults = pipeline::preset(kDefaultPreset);
  return infosOf(optionTable(defaults));
}

std::string Options::preset() const { return values_->preset; }

Prior Options::prior() const {
  const PriorUncertainty& inside = values_->options.prior;
  return {.translation_m = inside.translation,
          .heading_deg = inside.heading_deg,
          .scale = inside.scale,
          .anywhere = inside.anywhere(),
          .scale_unknown = inside.scale_unknown};
}

void Options::setPrior(const Prior& prior) {
  PriorUncertainty inside = PriorUncertainty::none();
  if (!prior.anywhere) {
    inside.translation = prior.translation_m;
    inside.heading_deg = prior.heading_deg;
  }
  inside.scale = prior.scale;
  inside.scale_unknown = prior.scale_unknown;
  checkOptions(inside);
  values_->options.prior = inside;
}

void Options::load(const std::filesystem::path& yaml) {
  OptionTable table = optionTable(values_->options);
  config::loadYaml(yaml, table);
}

void Options::save(const std::filesystem::path& yaml) const {
  io::writeText(yaml, config::dumpYaml(optionTable(values_->options)));
}

}  // namespace agricolmap
