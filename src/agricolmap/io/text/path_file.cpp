#include "agricolmap/io/text/path_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/text/commas.hpp"
#include "agricolmap/io/text/foreign_file.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/number_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr const char* kKinds = "'x y', 'x y z', 't x y z' or 't x y z qx qy qz qw'";
/// Nearer places are one: dead reckoning at a standstill [m].
constexpr double kLeastWay = 0.05;

/// Which columns hold x, y and z; z may be none.
struct Columns {
  std::size_t count = 0;
  std::array<std::optional<std::size_t>, 3> axis;
};

class PathReader {
 public:
  explicit PathReader(const std::filesystem::path& path) : path_(path.string()) {}

  void add(std::string_view line, std::size_t number) {
    const NumberWords numbers(line.substr(0, line.find('#')));
    const std::vector<std::string_view> words = numbers.words();
    if (words.empty()) return;
    // A line of one decimal would be no place: "3,5" is x and y.
    const bool pair = words.size() == 2 && line.find_first_of(" \t") == std::string_view::npos;
    if (numbers.ambiguous() && !pair) fail(number, std::string(kAmbiguousCommas));
    if (!columns_) {
      const bool names = !numbers.parse(words.front());
      columns_ = names ? named(words, number) : usual(words, number);
      if (names) return;
    }
    if (words.size() != columns_->count) {
      fail(number, fmt::format("{} values where lines before have {}; a path has as many in all",
                               words.size(), columns_->count));
    }
    places_.push_back(placeOf(numbers, words, number));
  }

  std::vector<Eigen::Vector3d> places() && {
    const bool moves = std::any_of(places_.begin(), places_.end(), [&](const Eigen::Vector3d& p) {
      return (p - places_.front()).head<2>().norm() > kLeastWay;
    });
    if (!moves) {
      throw InputError(fmt::format(
          "{}: {} places, none of them {} m from the first: this is no path; a line for each place "
          "of the robot is needed, {}",
          path_, places_.size(), kLeastWay, kKinds));
    }
    return std::move(places_);
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", path_, line, what));
  }

  Columns named(const std::vector<std::string_view>& words, std::size_t line) const {
    Columns columns{words.size(), {}};
    constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
    for (std::size_t i = 0; i < words.size(); ++i) {
      for (std::size_t axis = 0; axis < kNames.size(); ++axis) {
        if (lowerCase(words[i]) == kNames[axis]) columns.axis[axis] = i;
      }
    }
    if (!columns.axis[0] || !columns.axis[1]) {
      fail(line, fmt::format("'{}' is no number, and no line of names with x and y; a path has "
                             "lines of {}",
                             words.front(), kKinds));
    }
    return columns;
  }

  Columns usual(const std::vector<std::string_view>& words, std::size_t line) const {
    switch (words.size()) {
      case 2:
        return {2, {0, 1, std::nullopt}};
      case 3:
        return {3, {0, 1, 2}};
      case 4:
      case 8:
        return {words.size(), {1, 2, 3}};
      default:
        fail(line, fmt::format("{} values; a path has lines of {}, or a first line that names the "
                               "columns x and y",
                               words.size(), kKinds));
    }
  }

  Eigen::Vector3d placeOf(const NumberWords& numbers, const std::vector<std::string_view>& words,
                          std::size_t line) const {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const std::optional<std::size_t> column = columns_->axis[static_cast<std::size_t>(axis)];
      if (!column) continue;
      const std::string_view word = words[*column];
      const auto value = numbers.parse(word);
      if (!value) fail(line, fmt::format("'{}' is no number", word));
      if (!std::isfinite(*value)) {
        fail(line, fmt::format("'{}' is not finite; leave such places out", word));
      }
      place[axis] = *value;
    }
    return place;
  }

  std::string path_;
  std::optional<Columns> columns_;
  std::vector<Eigen::Vector3d> places_;
};

}  // namespace

std::vector<Eigen::Vector3d> readPath(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string foreign = describeForeign(file.text());
  if (!foreign.empty()) throw InputError(fmt::format("{}: {}", path.string(), foreign));
  std::string_view rest = withoutMark(file.text());
  const char line_end = lineEndOf(rest);
  PathReader reader(path);
  for (std::size_t line = 1; !rest.empty(); ++line) reader.add(takeLine(rest, line_end), line);
  return std::move(reader).places();
}

void writePath(const OutputPath& path, const std::vector<Eigen::Vector3d>& places,
               const std::string& comment) {
  std::string text;
  std::string_view rest = comment;
  while (!rest.empty()) text += fmt::format("# {}\n", takeLine(rest));
  for (const Eigen::Vector3d& p : places) {
    text += fmt::format("{} {} {}\n", exactText(p.x()), exactText(p.y()), exactText(p.z()));
  }
  writeText(path, text);
}

}  // namespace agricolmap::io
