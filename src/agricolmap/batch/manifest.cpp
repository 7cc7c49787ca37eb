#include "agricolmap/batch/manifest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "agricolmap/batch/file_pattern.hpp"
#include "agricolmap/batch/manifest_nodes.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/core/day.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap::batch {
namespace fs = std::filesystem;
namespace {

/// The file of a map or strip.
struct FileText {
  Text name;
  std::string model;  ///< surface model of an orthomosaic; both stand as they are to be opened

  std::string joined() const { return name.value + "," + model; }
};

/// What of a strip other strips may take over, and the maps' entries have in part.
struct StripEntry {
  int line = 0;
  std::optional<Text> id, map, crs, prior, path, date, like;
  std::optional<FileText> file;
  SettingsPatch settings;
};

std::vector<std::string> withSettings(std::vector<std::string> names) {
  names.insert(names.end(), settingNames().begin(), settingNames().end());
  return names;
}

/// Whether `id` can be the name of a folder beside the summary, and a word of a shell.
bool isGoodId(const std::string& id) {
  return !id.empty() && id.front() != '.' && id.front() != '-' && id.size() <= 200 &&
         !id.starts_with("summary.") && std::all_of(id.begin(), id.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c >= 0x80 || c == '.' || c == '_' || c == '-' || c == '+';
         });
}

class Reader {
 public:
  Reader(Manifest& manifest, Problems& problems)
      : manifest_(manifest), folder_(manifest.file.parent_path()), problems_(problems) {}

  void read(const YAML::Node& root) {
    const Fields fields(root, "the manifest", withSettings({"maps", "strips"}), problems_);
    if (!root.IsMap()) return;
    common_ = fields.settings();
    each(fields, "maps", [&](const YAML::Node& node) { readMap(node); });
    each(fields, "strips", [&](const YAML::Node& node) { readEntry(node); });
    for (std::size_t i = 0; i < entries_.size(); ++i) makeStrips(i);
  }

 private:
  template <typename Read>
  void each(const Fields& fields, const std::string& name, const Read& read) {
    const YAML::Node* const list = fields.find(name);
    if (list != nullptr && list->IsSequence() && list->size() > 0) {
      for (const YAML::Node& node : *list) read(node);
    } else {
      problems_.add(list == nullptr ? fields.line() : config::lineOf(*list),
                    fmt::format("the manifest needs '{}', a list with at least one entry", name));
    }
  }

  void readMap(const YAML::Node& node);
  void readEntry(const YAML::Node& node);
  std::optional<FileText> readFile(const Fields& fields, const std::string& what);
  void checkId(const Text& id, std::map<std::string, int>& seen, const char* what);
  std::string placed(const std::string& name) const {
    return (folder_ / name).lexically_normal().string();
  }
  /// A file that must be there.
  std::string existing(const Text& name, const std::string& what);
  /// The same of a strip, by whose file the name is filled in; empty where none is named.
  std::string filled(const std::optional<Text>& name, const FoundFile& strip,
                     const std::string& what);
  bool inherit(std::size_t entry, std::vector<std::size_t>& chain);
  StripEntry merged(const std::vector<std::size_t>& chain) const;
  void makeStrips(std::size_t index);
  void addStrip(const StripEntry& entry, const FoundFile& file, Strip strip);
  std::optional<std::size_t> mapOf(const StripEntry& entry);

  Manifest& manifest_;
  fs::path folder_;
  Problems& problems_;
  SettingsPatch common_;
  std::vector<SettingsPatch> map_settings_;
  std::vector<StripEntry> entries_;
  std::map<std::string, int> map_ids_;  ///< with their lines
  std::map<std::string, int> strip_ids_;
};

void Reader::checkId(const Text& id, std::map<std::string, int>& seen, const char* what) {
  if (!isGoodId(id.value)) {
    problems_.add(id.line,
                  fmt::format("'{}' is no id: letters, digits and . _ - + make one, and it "
                              "begins with neither . nor -, nor with 'summary.'",
                              id.value));
  }
  const auto [first, is_new] = seen.try_emplace(id.value, id.line);
  if (!is_new) {
    problems_.add(id.line, fmt::format("{} '{}' is there already, in line {}", what, id.value,
                                       first->second));
  }
}

std::optional<FileText> Reader::readFile(const Fields& fields, const std::string& what) {
  const YAML::Node* const node = fields.find("file");
  if (node == nullptr) {
    problems_.add(fields.line(), what + " needs a file");
    return std::nullopt;
  }
  if (!node->IsSequence()) {
    const std::optional<Text> name = fields.text("file");
    return name ? std::optional(FileText{*name, ""}) : std::nullopt;
  }
  const int line = config::lineOf(*node);
  if (node->size() != 2 || !(*node)[0].IsScalar() || !(*node)[1].IsScalar()) {
    problems_.add(line, fmt::format("the file of {} is one name, or a list of two: an orthomosaic "
                                    "and its surface model",
                                    what));
    return std::nullopt;
  }
  const std::string ortho = existing({(*node)[0].Scalar(), line}, "the orthomosaic");
  const std::string model = existing({(*node)[1].Scalar(), line}, "the surface model");
  if (ortho.empty() || model.empty()) return std::nullopt;
  return FileText{{ortho, line}, model};
}

void Reader::readMap(const YAML::Node& node) {
  const Fields fields(node, "a map", withSettings({"id", "file", "crs"}), problems_);
  map_settings_.push_back(fields.settings());
  MapEntry map;
  const auto id = fields.text("id");
  const auto file = readFile(fields, "a map");
  if (id) checkId(*id, map_ids_, "a map");
  if (!id) problems_.add(fields.line(), "a map needs an id");
  map.id = id ? id->value : "";
  if (const auto crs = fields.text("crs")) {
    const std::string named = placed(crs->value);
    map.crs = fs::is_regular_file(named) ? named : crs->value;
  }
  if (file)
    map.file = file->model.empty() ? existing(file->name, "the map's file") : file->joined();
  manifest_.maps.push_back(std::move(map));
}

void Reader::readEntry(const YAML::Node& node) {
  const Fields fields(node, "a strip",
                      withSettings({"id", "map", "file", "crs", "prior", "path", "date", "like"}),
                      problems_);
  StripEntry entry;
  entry.line = fields.line();
  entry.id = fields.text("id");
  entry.map = fields.text("map");
  entry.file = readFile(fields, "a strip");
  entry.crs = fields.text("crs");
  entry.prior = fields.text("prior");
  entry.path = fields.text("path");
  entry.date = fields.text("date");
  entry.like = fields.text("like");
  entry.settings = fields.settings();
  if (entry.date && dayOf(entry.date->value) == 0) {
    problems_.add(entry.date->line,
                  fmt::format("'{}' is no day; write it as 2026-05-31", entry.date->value));
  }
  entries_.push_back(std::move(entry));
}

std::string Reader::existing(const Text& name, const std::string& what) {
  std::string file = placed(name.value);
  if (fs::is_regular_file(file)) return file;
  problems_.add(name.line, fmt::format("{}: there is no such file ({})", file, what));
  return {};
}

std::string Reader::filled(const std::optional<Text>& name, const FoundFile& strip,
                           const std::string& what) {
  if (!name) return {};
  try {
    return existing({filledIn(name->value, strip), name->line}, what);
  } catch (const UsageError& error) {
    problems_.add(name->line, error.what());
    return {};
  }
}

/// The entry and those that it is like, one after the other; false where that goes in a circle or
/// one of them is not there.
bool Reader::inherit(std::size_t entry, std::vector<std::size_t>& chain) {
  for (chain = {entry}; entries_[chain.back()].like;) {
    const Text& like = *entries_[chain.back()].like;
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const StripEntry& one) {
      return one.id && one.id->value == like.value;
    });
    // Each fault is told where it stands, once.
    const bool own = chain.size() == 1;
    if (found == entries_.end()) {
      std::vector<std::string> ids;
      for (const StripEntry& one : entries_) {
        if (one.id) ids.push_back(one.id->value);
      }
      if (own) {
        problems_.add(like.line, fmt::format("there is no strip '{}' to be like{}", like.value,
                                             config::suggestion(ids, like.value)));
      }
      return false;
    }
    const auto next = static_cast<std::size_t>(found - entries_.begin());
    if (std::find(chain.begin(), chain.end(), next) != chain.end()) {
      std::vector<std::string> names;
      for (const std::size_t one : chain) {
        names.push_back(entries_[one].id ? entries_[one].id->value : "?");
      }
      if (next == entry && entry == *std::min_element(chain.begin(), chain.end())) {
        problems_.add(entries_[entry].like->line,
                      fmt::format("strips are like one another in a circle: {} -> {}",
                                  fmt::join(names, " -> "), like.value));
      }
      return false;
    }
    chain.push_back(next);
  }
  return true;
}

StripEntry Reader::merged(const std::vector<std::size_t>& chain) const {
  StripEntry entry = entries_[chain.front()];
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const StripEntry& other = entries_[chain[i]];
    const auto take = [](std::optional<Text>& mine, const std::optional<Text>& others) {
      if (!mine) mine = others;
    };
    take(entry.map, other.map);
    take(entry.crs, other.crs);
    take(entry.prior, other.prior);
    take(entry.path, other.path);
    take(entry.date, other.date);
  }
  return entry;
}

std::optional<std::size_t> Reader::mapOf(const StripEntry& entry) {
  const std::vector<MapEntry>& maps = manifest_.maps;
  if (!entry.map) {
    if (maps.size() == 1) return 0;
    if (!maps.empty()) {
      problems_.add(entry.line, "a strip needs a map where there are several: map: ID");
    }
    return std::nullopt;
  }
  const auto found = std::find_if(maps.begin(), maps.end(),
                                  [&](const MapEntry& map) { return map.id == entry.map->value; });
  if (found != maps.end()) return static_cast<std::size_t>(found - maps.begin());
  std::vector<std::string> ids;
  for (const MapEntry& map : maps) ids.push_back(map.id);
  problems_.add(entry.map->line, fmt::format("there is no map '{}'{}", entry.map->value,
                                             config::suggestion(ids, entry.map->value)));
  return std::nullopt;
}

/// The strips of one entry: several where its file is a pattern.
void Reader::makeStrips(std::size_t index) {
  std::vector<std::size_t> chain;
  if (!inherit(index, chain)) return;
  const StripEntry entry = merged(chain);
  const std::optional<std::size_t> map = mapOf(entry);
  if (!entry.file || !map) return;
  Strip strip;
  strip.line = entry.line;
  strip.map = *map;
  common_.applyTo(strip.settings);
  map_settings_[*map].applyTo(strip.settings);
  for (auto one = chain.rbegin(); one != chain.rend(); ++one) {
    entries_[*one].settings.applyTo(strip.settings);
  }
  try {
    strip.options = optionsOf(strip.settings);
  } catch (const UsageError& error) {
    problems_.add(entry.line, error.what());
  }
  strip.date = entry.date ? dayOf(entry.date->value) : 0;
  const Text& name = entry.file->name;
  if (!entry.file->model.empty()) {
    strip.file = entry.file->joined();
    addStrip(entry, {name.value, {}}, std::move(strip));
  } else if (!hasWildcards(name.value) || fs::exists(placed(name.value))) {
    strip.file = existing(name, "the strip's file");
    addStrip(entry, {placed(name.value), {}}, std::move(strip));
  } else {
    const std::vector<FoundFile> files = filesLike(folder_, name.value);
    if (files.empty()) {
      problems_.add(name.line, fmt::format("no file is like {}", placed(name.value)));
    }
    for (const FoundFile& file : files) {
      strip.file = file.file.lexically_normal().string();
      addStrip(entry, file, strip);
    }
  }
}

void Reader::addStrip(const StripEntry& entry, const FoundFile& file, Strip strip) {
  const Text pattern = entry.id.value_or(Text{"{name}", entry.line});
  try {
    strip.id = filledIn(pattern.value, file);
    checkId({strip.id, pattern.line}, strip_ids_, "a strip");
  } catch (const UsageError& error) {
    problems_.add(pattern.line, error.what());
  }
  strip.prior = filled(entry.prior, file, "the initial guess");
  strip.path = filled(entry.path, file, "the robot's path");
  if (entry.crs) {
    // A file with it, or what it is called.
    const std::string crs = placed(entry.crs->value);
    strip.crs = fs::is_regular_file(crs) ? crs : entry.crs->value;
  }
  manifest_.strips.push_back(std::move(strip));
}

}  // namespace

Manifest readManifest(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  // Of an empty file nothing can be read.
  const bool empty = stream && stream.peek() == std::ifstream::traits_type::eof();
  if (!stream || fs::is_directory(file) || (!empty && !(text << stream.rdbuf()))) {
    const char* const why = !fs::exists(file)        ? "there is no such file"
                            : fs::is_directory(file) ? "is a folder"
                                                     : "cannot be read";
    throw InputError(fmt::format("{}: {}; name a manifest, a YAML file that lists maps and strips",
                                 file.string(), why));
  }
  return manifestOf(text.str(), file);
}

Manifest manifestOf(const std::string& text, const fs::path& file) {
  const YAML::Node root =
      config::parseYaml(text, file.string(), "a manifest; put all strips into one");
  Manifest manifest;
  manifest.file = file;
  Problems problems;
  Reader(manifest, problems).read(root);
  problems.throwIfAny(file.string());
  return manifest;
}

}  // namespace agricolmap::batch
