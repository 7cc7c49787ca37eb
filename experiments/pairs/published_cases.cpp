#include "experiments/pairs/published_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "agricolmap/core/error.hpp"

namespace agricolmap::experiments {
namespace {

namespace fs = std::filesystem;

/// With a slash, so that it is no other case's name.
std::string nameOf(const PublishedPair& pair) {
  std::string name = fmt::format("{}/{}", pair.crop, pair.row);
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::string_view(",;|\"\n\r").find(c) != std::string_view::npos; }, '-');
  return name;
}

}  // namespace

std::vector<Case> publishedCases(const std::vector<fs::path>& dirs) {
  std::vector<Case> cases;
  std::map<std::string, fs::path> seen;
  for (const fs::path& dir : dirs) {
    for (PublishedPair& pair : findPublishedPairs(dir)) {
      Case made;
      made.name = made.dataset = nameOf(pair);
      made.source = PairSource::kPublished;
      const auto [other, is_new] = seen.emplace(made.name, pair.moving_cloud);
      if (!is_new) {
        throw InputError(
            fmt::format("{} and {}: both are the pair '{}'; name one folder that has both of them "
                        "in folders of different names",
                        other->second.string(), pair.moving_cloud.string(), made.name));
      }
      made.published = std::move(pair);
      cases.push_back(std::move(made));
    }
  }
  return cases;
}

}  // namespace agricolmap::experiments
