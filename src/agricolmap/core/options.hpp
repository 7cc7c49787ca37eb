// Options defined once: a struct with defaults and a `describe` that lists its fields with name,
// unit, limits and help. Command line, YAML, JSON, checks and docs all read that list.
#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace agricolmap {

/// An enum option, seen as its names.
struct ChoiceRef {
  std::function<int()> get;
  std::function<void(int)> set;
  std::vector<std::string> names;
};

/// Who an option is for.
enum class OptionLevel {
  kAdvanced,  ///< those who change how a stage works: in `--help-all`, files and documents
  kBasic,     ///< users: in `--help`, too
};

/// One option: its path (`grid.cell`), a reference to its value, and what users need to know.
struct OptionField {
  std::string path;
  std::variant<double*, int*, bool*, ChoiceRef> value;
  double low = 0.0;
  double high = 0.0;
  std::string unit;
  std::string help;
  OptionLevel level = OptionLevel::kAdvanced;

  /// Said where the option is listed: `table.number("cell", ...).basic();`
  void basic() { level = OptionLevel::kBasic; }
  /// Name of its outermost group; empty for an option outside all groups.
  std::string_view group() const {
    const std::size_t dot = path.find('.');
    return dot == std::string::npos ? std::string_view() : std::string_view(path).substr(0, dot);
  }
};

/// The fields of an options struct and of the structs inside it, in order of declaration.
/// References stay valid as long as the described struct does.
class OptionTable {
 public:
  OptionField& number(std::string_view name, double& value, double low, double high,
                      std::string_view unit, std::string_view help);
  OptionField& integer(std::string_view name, int& value, int low, int high, std::string_view unit,
                       std::string_view help);
  OptionField& flag(std::string_view name, bool& value, std::string_view help);
  template <typename Enum>
  requires std::is_enum_v<Enum> OptionField& choice(std::string_view name, Enum& value,
                                                    std::vector<std::string> names,
                                                    std::string_view help) {
    return addChoice(name,
                     {[&value] { return static_cast<int>(value); },
                      [&value](int v) { value = static_cast<Enum>(v); }, std::move(names)},
                     help);
  }
  /// Puts the fields of `options` under `name.`. `title`: what the group is about, as a heading.
  template <typename Options>
  void group(std::string_view name, Options& options, std::string_view title = "") {
    const std::string outer = prefix_;
    titles_.emplace(prefix_ + std::string(name), title);
    prefix_ += std::string(name) + ".";
    listOptions(*this, options);
    prefix_ = outer;
  }

  const std::vector<OptionField>& fields() const& { return fields_; }
  /// Not of a temporary, in whose loop the fields would be gone.
  const std::vector<OptionField>& fields() const&& = delete;
  /// Throws UsageError with the path, the value and the limits of the first field outside them.
  void check() const;
  /// The field at `path`; nullptr if there is none.
  const OptionField* find(std::string_view path) const;
  /// What the group `path` is about; empty if it was not said.
  std::string titleOf(std::string_view path) const;

 private:
  OptionField& add(OptionField field);
  OptionField& addChoice(std::string_view name, ChoiceRef ref, std::string_view help);
  std::vector<OptionField> fields_;
  std::map<std::string, std::string, std::less<>> titles_;
  std::string prefix_;
};

/// The fields of `options`; needs `void listOptions(OptionTable&, Options&)` beside the struct.
template <typename Options>
OptionTable optionTable(Options& options) {
  OptionTable table;
  listOptions(table, options);
  return table;
}

/// Throws UsageError when a field of `options` is outside its limits.
template <typename Options>
void checkOptions(const Options& options) {
  Options copy = options;
  optionTable(copy).check();
}

}  // namespace agricolmap
