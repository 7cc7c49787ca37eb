#include "runner/published_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <system_error>

#include "agricolmap/core/error.hpp"

namespace agricolmap::experiments {
namespace {

namespace fs = std::filesystem;

/// With a slash, so that it is no other data set's name.
std::string nameOf(const PublishedPair& pair) {
  std::string name = fmt::format("{}/{}", pair.crop, pair.row);
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::string_view(",;|\"\n\r").find(c) != std::string_view::npos; }, '-');
  return name;
}

/// The file's name with its folder's, and its size.
std::string fileText(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(fmt::format("{}: {}", file.string(), error.message()));
  return fmt::format("{}/{}:{}", file.parent_path().filename().string(), file.filename().string(),
                     size);
}

}  // namespace

std::vector<DataSet> publishedDataSets(const std::vector<fs::path>& dirs) {
  std::vector<DataSet> sets;
  std::map<std::string, fs::path> seen;
  for (const fs::path& dir : dirs) {
    for (PublishedPair& pair : findPublishedPairs(dir)) {
      DataSet set;
      set.name = nameOf(pair);
      set.kind = DataKind::kReal;
      const auto [other, is_new] = seen.emplace(set.name, pair.moving_cloud);
      if (!is_new) {
        throw InputError(
            fmt::format("{} and {}: both are the pair '{}'; name one folder that has both of them "
                        "in folders of different names",
                        other->second.string(), pair.moving_cloud.string(), set.name));
      }
      set.published = std::move(pair);
      sets.push_back(std::move(set));
    }
  }
  return sets;
}

std::string publishedText(const std::vector<DataSet>& sets) {
  std::string text;
  for (const DataSet& set : sets) {
    if (!set.published) continue;
    const PublishedPair& pair = *set.published;
    text +=
        fmt::format("{}|{}|{}|", set.name, fileText(pair.fixed_cloud), fileText(pair.moving_cloud));
    if (pair.true_fixed_from_moving) {
      for (const double value : pair.true_fixed_from_moving->matrix().reshaped()) {
        text += fmt::format("{:.17g} ", value);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace agricolmap::experiments
