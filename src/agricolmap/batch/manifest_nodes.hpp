// Pieces of a manifest as text: fields of YAML maps, and what is wrong with them.
#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/batch/settings.hpp"

namespace agricolmap::batch {

/// What is wrong in a file, collected so that all of it can be told at once.
class Problems {
 public:
  void add(int line, std::string what) { found_.emplace(line, std::move(what)); }
  bool empty() const { return found_.empty(); }
  /// Throws UsageError with a line for each, in their order; of very many, the first.
  void throwIfAny(const std::string& file) const;

 private:
  std::multimap<int, std::string> found_;
};

/// A text and where it stands.
struct Text {
  std::string value;
  int line = 0;
};

/// The fields of a map of the file; those that are unknown or given twice are problems.
class Fields {
 public:
  /// `what`: what the map is, in words: "a strip".
  Fields(const YAML::Node& node, const std::string& what, const std::vector<std::string>& known,
         Problems& problems);
  int line() const { return line_; }
  const YAML::Node* find(const std::string& name) const;
  /// Nothing where the field is missing or no plain text; the latter is a problem.
  std::optional<Text> text(const std::string& name) const;
  /// The preset, options, ... of this level.
  SettingsPatch settings() const;

 private:
  std::optional<bool> flag(const std::string& name) const;
  std::map<std::string, YAML::Node> fields_;
  int line_ = 0;
  Problems& problems_;
};

/// Names of the fields that Fields::settings reads.
const std::vector<std::string>& settingNames();

}  // namespace agricolmap::batch
