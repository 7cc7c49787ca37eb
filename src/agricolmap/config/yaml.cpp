#include "agricolmap/config/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml_options.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap::config {
namespace {

/// Where documents begin.
class DocumentStarts : public YAML::EventHandler {
 public:
  std::vector<YAML::Mark> marks;

  void OnDocumentStart(const YAML::Mark& mark) override { marks.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}
};

/// YAML::LoadAll would go on for ever, and fill the memory, where a document begins with ',': the
/// parser finds an empty one there again and again.
void requireOneDocument(const std::string& text, const std::string& name, const std::string& what) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  if (!parser.HandleNextDocument(starts) || !parser.HandleNextDocument(starts)) return;
  if (starts.marks.size() < 2) return;
  const YAML::Mark& second = starts.marks[1];
  if (second.pos == starts.marks[0].pos) {
    throw UsageError(
        fmt::format("{}:{}: not valid YAML: no entry begins so", name, second.line + 1));
  }
  throw UsageError(
      fmt::format("{}:{}: a second document ('---') in {}", name, second.line + 1, what));
}

/// Looks at a document of options from the outside in.
class OptionsReader {
 public:
  OptionsReader(const OptionTable& table, const OnProblem& on_problem)
      : table_(table), on_problem_(on_problem) {}

  OptionTexts read(const YAML::Node& root) && {
    if (root.IsNull()) return {};
    if (root.IsMap()) {
      readMap(root, "");
    } else {
      on_problem_(lineOf(root), "expected a map of options, such as 'grid: {cell: 0.02}'");
    }
    return std::move(texts_);
  }

 private:
  // The depth is that of the table, since a map must be a group of it: aliases cannot loop.
  void readMap(const YAML::Node& map, const std::string& prefix) {  // NOLINT(misc-no-recursion)
    for (const auto& entry : map) {
      const int line = lineOf(entry.first);
      if (!entry.first.IsScalar()) {
        on_problem_(line, "the name of an option must be plain text");
        continue;
      }
      const std::string path = prefix + entry.first.Scalar();
      if (const OptionField* field = table_.find(path)) {
        readValue(*field, entry.second, line);
      } else if (!isGroup(path)) {
        on_problem_(line, fmt::format("unknown option '{}'{}", path, suggestion(table_, path)));
      } else if (entry.second.IsMap()) {
        readMap(entry.second, path + ".");
      } else if (!entry.second.IsNull()) {
        on_problem_(line,
                    fmt::format("'{}' is a group of options and needs a map, not a value", path));
      }
    }
  }

  void readValue(const OptionField& field, const YAML::Node& value, int line) {
    const auto [first, is_new] = lines_.try_emplace(field.path, line);
    if (!is_new) {
      on_problem_(line,
                  fmt::format("option {} was given in line {} already", field.path, first->second));
    } else if (!value.IsScalar()) {
      on_problem_(line,
                  fmt::format("option {} needs one value: {}", field.path, limitsText(field)));
    } else {
      try {
        parseOption(field, value.Scalar());
        texts_[field.path] = value.Scalar();
      } catch (const UsageError& error) {
        on_problem_(line, error.what());
      }
    }
  }

  bool isGroup(const std::string& path) const {
    return std::any_of(
        table_.fields().begin(), table_.fields().end(),
        [&](const OptionField& field) { return field.path.starts_with(path + "."); });
  }

  const OptionTable& table_;
  const OnProblem& on_problem_;
  OptionTexts texts_;
  std::map<std::string, int> lines_;
};

std::vector<std::string> partsOf(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

/// One line, as a comment may not continue by itself.
std::string oneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::vector<std::string> loadYaml(const std::filesystem::path& file, OptionTable& table) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw InputError(fmt::format("{}: there is no such file", file.string()));
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  // A folder opens like a file and only fails on reading; of an empty file nothing can be read.
  if (!stream || std::filesystem::is_directory(file) ||
      (stream.peek() != std::ifstream::traits_type::eof() && !(text << stream.rdbuf()))) {
    throw InputError(fmt::format("{}: cannot read this options file", file.string()));
  }
  return loadYamlText(text.str(), file.string(), table);
}

int lineOf(const YAML::Node& node) { return std::max(1, node.Mark().line + 1); }

YAML::Node parseYaml(const std::string& text, const std::string& name, const std::string& what) {
  try {
    requireOneDocument(text, name, what);
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw UsageError(
        fmt::format("{}:{}: not valid YAML: {}", name, error.mark.line + 1, error.msg));
  }
}

OptionTexts readOptions(const YAML::Node& map, const OptionTable& table,
                        const OnProblem& on_problem) {
  return OptionsReader(table, on_problem).read(map);
}

void applyOptions(const OptionTexts& texts, const OptionTable& table) {
  std::vector<std::function<void()>> setters;
  for (const auto& [path, text] : texts) {
    const OptionField* const field = table.find(path);
    if (field == nullptr) throw UsageError(fmt::format("unknown option '{}'", path));
    setters.push_back(parseOption(*field, text));
  }
  for (const std::function<void()>& set : setters) set();
}

std::vector<std::string> loadYamlText(const std::string& text, const std::string& name,
                                      OptionTable& table) {
  const YAML::Node root = parseYaml(text, name, "an options file; put all options into one");
  const OptionTexts texts = readOptions(root, table, [&](int line, const std::string& problem) {
    throw UsageError(fmt::format("{}:{}: {}", name, line, problem));
  });
  applyOptions(texts, table);
  std::vector<std::string> paths;
  for (const auto& [path, value] : texts) paths.push_back(path);
  return paths;
}

std::string dumpYaml(const OptionTable& table) {
  std::string out;
  std::vector<std::string> open;  // groups the last line was in
  const bool levels = hasLevels(table);
  for (const OptionField& field : table.fields()) {
    std::vector<std::string> groups = partsOf(field.path);
    const std::string name = groups.back();
    groups.pop_back();
    const auto same = std::mismatch(open.begin(), open.end(), groups.begin(), groups.end()).first;
    for (auto i = static_cast<std::size_t>(same - open.begin()); i < groups.size(); ++i) {
      out += fmt::format("{:{}}{}:\n", "", 2 * i, groups[i]);
    }
    open = groups;
    const std::size_t indent = 2 * groups.size();
    const bool mark = levels && field.level == OptionLevel::kAdvanced;
    out += fmt::format("{:{}}# {}{}; {}\n{:{}}{}: {}\n", "", indent, mark ? "advanced; " : "",
                       limitsText(field), oneLine(field.help), "", indent, name, optionText(field));
  }
  return out;
}

}  // namespace agricolmap::config
