#include "agricolmap/options.hpp"

#include <fmt/format.h>

#include "agricolmap/api/values.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap {
namespace {

constexpr const char* kDefaultPreset = "default";

const OptionField& fieldOf(const OptionTable& table, std::string_view name) {
  const OptionField* const field = table.find(name);
  if (field == nullptr) {
    throw UsageError(
        fmt::format("there is no option '{}'{}", name, config::suggestion(table, name)));
  }
  return *field;
}

/// The number as the text of such an option.
std::string textFor(const OptionField& field, double value) {
  if (std::holds_alternative<bool*>(field.value) && (value == 0.0 || value == 1.0)) {
    return value == 1.0 ? "true" : "false";
  }
  return fmt::format("{}", value);
}

OptionInfo infoOf(const OptionField& field) {
  OptionInfo info;
  info.name = field.path;
  info.unit = field.unit;
  info.limits = config::limitsText(field);
  info.default_value = config::optionText(field);
  info.help = field.help;
  info.basic = field.level == OptionLevel::kBasic;
  if (std::holds_alternative<bool*>(field.value)) {
    info.kind = OptionInfo::Kind::kFlag;
  } else if (const auto* choice = std::get_if<ChoiceRef>(&field.value)) {
    info.kind = OptionInfo::Kind::kChoice;
    info.choices = choice->names;
  } else {
    const bool whole = std::holds_alternative<int*>(field.value);
    info.kind = whole ? OptionInfo::Kind::kInteger : OptionInfo::Kind::kNumber;
    info.low = field.low;
    info.high = field.high;
  }
  return info;
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
  config::parseOption(fieldOf(table, name), value)();
}

void Options::set(std::string_view name, double value) {
  const OptionTable table = optionTable(values_->options);
  const OptionField& field = fieldOf(table, name);
  config::parseOption(field, textFor(field, value))();
}

std::string Options::get(std::string_view name) const {
  return config::optionText(fieldOf(optionTable(values_->options), name));
}

std::vector<OptionInfo> Options::list() const {
  pipeline::RegistrationOptions defaults = pipeline::preset(kDefaultPreset);
  std::vector<OptionInfo> infos;
  const OptionTable table = optionTable(defaults);
  for (const OptionField& field : table.fields()) infos.push_back(infoOf(field));
  return infos;
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
