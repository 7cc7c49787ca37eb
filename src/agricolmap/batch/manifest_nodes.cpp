#include "agricolmap/batch/manifest_nodes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "agricolmap/config/text.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap::batch {
namespace {

constexpr std::array kAligned{"auto", "ply", "pcd", "las", "laz", "copc"};

}  // namespace

void Problems::throwIfAny(const std::string& file) const {
  constexpr std::size_t kMost = 100;
  if (found_.empty()) return;
  std::string text;
  std::size_t said = 0;
  for (const auto& [line, what] : found_) {
    if (said++ == kMost) break;
    text += fmt::format("{}{}:{}: {}", text.empty() ? "" : "\n", file, line, what);
  }
  if (found_.size() > kMost) text += fmt::format("\n... and {} more", found_.size() - kMost);
  throw UsageError(text);
}

Fields::Fields(const YAML::Node& node, const std::string& what,
               const std::vector<std::string>& known, Problems& problems)
    : line_(config::lineOf(node)), problems_(problems) {
  if (!node.IsMap()) {
    problems.add(line_,
                 fmt::format("{} must be a map with some of {}", what, fmt::join(known, ", ")));
    return;
  }
  for (const auto& entry : node) {
    const int line = config::lineOf(entry.first);
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      problems.add(line, fmt::format("{} has no field '{}'{}; it may have {}", what, name,
                                     config::suggestion(known, name), fmt::join(known, ", ")));
    } else if (!fields_.try_emplace(name, entry.second).second) {
      problems.add(line, fmt::format("{} was given in line {} already", name,
                                     config::lineOf(fields_.at(name))));
    }
  }
}

const YAML::Node* Fields::find(const std::string& name) const {
  const auto found = fields_.find(name);
  return found == fields_.end() || found->second.IsNull() ? nullptr : &found->second;
}

std::optional<Text> Fields::text(const std::string& name) const {
  const YAML::Node* const node = find(name);
  if (node == nullptr) return std::nullopt;
  const int line = config::lineOf(*node);
  if (node->IsScalar() && !node->Scalar().empty()) return Text{node->Scalar(), line};
  problems_.add(line, fmt::format("{} must be plain text", name));
  return std::nullopt;
}

std::optional<bool> Fields::flag(const std::string& name) const {
  const std::optional<Text> given = text(name);
  if (!given) return std::nullopt;
  if (given->value == "true" || given->value == "false") return given->value == "true";
  problems_.add(given->line, fmt::format("{} must be true or false", name));
  return std::nullopt;
}

SettingsPatch Fields::settings() const {
  SettingsPatch patch;
  if (const auto preset = text("preset")) {
    const std::vector<std::string> known = pipeline::presetNames();
    if (std::find(known.begin(), known.end(), preset->value) == known.end()) {
      problems_.add(preset->line,
                    fmt::format("there is no preset '{}'{}; there are {}", preset->value,
                                config::suggestion(known, preset->value), fmt::join(known, ", ")));
    } else {
      patch.preset = preset->value;
    }
  }
  if (const YAML::Node* const node = find("options")) {
    pipeline::RegistrationOptions options;
    patch.options =
        config::readOptions(*node, optionTable(options),
                            [&](int line, const std::string& what) { problems_.add(line, what); });
  }
  if (const auto aligned = text("aligned_format")) {
    if (std::find(kAligned.begin(), kAligned.end(), aligned->value) == kAligned.end()) {
      problems_.add(aligned->line,
                    fmt::format("aligned_format must be one of {}", fmt::join(kAligned, ", ")));
    }
    patch.aligned = aligned->value;
  }
  patch.keep_rejected = flag("keep_rejected");
  patch.pictures = flag("pictures");
  return patch;
}

const std::vector<std::string>& settingNames() {
  static const std::vector<std::string> names = {"preset", "options", "aligned_format",
                                                 "keep_rejected", "pictures"};
  return names;
}

}  // namespace agricolmap::batch
