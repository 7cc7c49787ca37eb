// Options defined once: a struct with defaults and a `listOptions` that lists its fields with name,
// unit, limits and help. Command line, YAML, JSON, checks and docs all read that list.
#pragma once

#include <concepts>
#include <functional>
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

/// One option: its path (`grid.cell`), a reference to its value, and what users need to know.
struct OptionField {
  std::string path;
  std::variant<double*, int*, bool*, ChoiceRef> value;
  double low = 0.0;
  double high = 0.0;
  std::string unit;
  std::string help;
};

/// The fields of an options struct and of the structs inside it, in order of declaration.
/// References stay valid as long as the described struct does.
class OptionTable {
 public:
  void number(std::string_view name, double& value, double low, double high, std::string_view unit,
              std::string_view help);
  void integer(std::string_view name, int& value, int low, int high, std::string_view unit,
               std::string_view help);
  void flag(std::string_view name, bool& value, std::string_view help);
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void choice(std::string_view name, Enum& value, std::vector<std::string> names,
              std::string_view help) {
    addChoice(name,
              {[&value] { return static_cast<int>(value); },
               [&value](int v) { value = static_cast<Enum>(v); }, std::move(names)},
              help);
  }
  /// Puts the fields of `options` under `name.`.
  template <typename Options>
  void group(std::string_view name, Options& options) {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + ".";
    listOptions(*this, options);
    prefix_ = outer;
  }

  const std::vector<OptionField>& fields() const { return fields_; }
  /// Throws UsageError with the path, the value and the limits of the first field outside them.
  void check() const;
  /// The field at `path`; nullptr if there is none.
  const OptionField* find(std::string_view path) const;

 private:
  void addChoice(std::string_view name, ChoiceRef ref, std::string_view help);
  std::vector<OptionField> fields_;
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
