// How a registration is done: the initial guess's limits and what can be tuned.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/export.hpp"

namespace agricolmap {

/// How wrong the initial guess may be. Limits, not deviations; tighter ones are searched faster and
/// are less easily fooled.
struct Prior {
  double translation_m = 5.0;  ///< horizontally, at the moving cloud's middle
  double heading_deg = 11.5;
  double scale = 0.3;          ///< of each horizontal axis, relative (0.3: 0.7 to 1.3)
  bool anywhere = false;       ///< no guess: any place and heading; the two above do not count
  bool scale_unknown = false;  ///< the moving cloud is in units of its own: a factor of 0.1 to 10
};

/// One option, for those who list them.
struct OptionInfo {
  enum class Kind {
    kNumber,
    kInteger,
    kFlag,    ///< "true" or "false"
    kChoice,  ///< one of `choices`
  };

  std::string name;           ///< e.g. "grid.cell"
  std::string unit;           ///< empty: none
  std::string limits;         ///< what is allowed, e.g. "0.005 to 1 m"
  std::string default_value;  ///< of the default preset
  std::string help;
  bool basic = false;  ///< for users; the others are for those who change how a stage works
  Kind kind = Kind::kNumber;
  double low = 0.0;  ///< least and greatest number that is allowed
  double high = 0.0;
  std::vector<std::string> choices;
};

/// All options of a registration, by name; a value that is copied. The names are those of the
/// command line and of its configuration files.
class AGRICOLMAP_EXPORT Options {
 public:
  /// The default preset: what measures best.
  Options();
  /// One of `presets()`. Throws UsageError.
  explicit Options(std::string_view preset);
  static std::vector<std::string> presets();

  Options(const Options& other);
  Options(Options&& other) noexcept;
  Options& operator=(const Options& other);
  Options& operator=(Options&& other) noexcept;
  ~Options();

  /// Sets one option; throws UsageError, and changes nothing, when there is none of the name or the
  /// value is outside its limits. Flags are "true" or "false".
  void set(std::string_view name, std::string_view value);
  void set(std::string_view name, double value);
  /// The value as `set` takes it. Throws UsageError when there is none of the name.
  std::string get(std::string_view name) const;
  std::vector<OptionInfo> list() const;
  /// Of the preset that it was made from.
  std::string preset() const;

  Prior prior() const;
  /// Throws UsageError for limits that are outside theirs.
  void setPrior(const Prior& prior);

  /// Sets what the YAML file names; what it does not name stays. Throws InputError when it cannot
  /// be read and UsageError, naming file and line, for keys and values that make no sense.
  void load(const std::filesystem::path& yaml);
  /// Writes all options with their meaning, as `load` reads them. Throws OutputError.
  void save(const std::filesystem::path& yaml) const;

  /// What the library keeps them in.
  struct Values;
  const Values& values() const { return *values_; }

 private:
  std::unique_ptr<Values> values_;
};

}  // namespace agricolmap
