#include "experiments/pairs/published.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/matrix_file.hpp"

namespace agricolmap::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCloud = "point_cloud.ply";
constexpr const char* kLayout =
    "a crop is a folder with one folder like 'uav' and some like 'ugv_row1', each with a "
    "point_cloud.ply";

constexpr std::array<std::string_view, 2> kDroneWords = {"uav", "aerial"};
constexpr std::array<std::string_view, 3> kRowWords = {"ugv", "ground", "row"};
constexpr std::array<std::string_view, 2> kTruthWords = {"truth", "affine"};

std::string loweredName(const fs::path& path) {
  std::string text = path.filename().string();
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

template <std::size_t N>
bool hasAny(std::string_view name, const std::array<std::string_view, N>& words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return name.find(word) != std::string_view::npos;
  });
}

/// What lies in the folder and is not hidden, sorted.
std::vector<fs::path> entriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!loweredName(it->path()).starts_with('.')) entries.push_back(it->path());
  }
  if (error) {
    throw InputError(fmt::format("{}: cannot be searched: {}", folder.string(), error.message()));
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

std::string namesOf(const std::vector<fs::path>& paths) {
  std::vector<std::string> names;
  for (const fs::path& path : paths) names.push_back(path.filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

std::optional<fs::path> truthIn(const fs::path& folder) {
  std::vector<fs::path> truths = entriesOf(folder);
  std::erase_if(truths, [](const fs::path& path) {
    const std::string name = loweredName(path);
    return !name.ends_with(".txt") || !hasAny(name, kTruthWords);
  });
  if (truths.size() > 1) {
    throw InputError(fmt::format("{}: {} files may be the truth of a row ({}); leave one",
                                 folder.string(), truths.size(), namesOf(truths)));
  }
  if (truths.empty()) return std::nullopt;
  return truths.front();
}

Case caseOf(const std::string& crop, const fs::path& drone, const fs::path& row,
            const std::optional<fs::path>& truth) {
  Case made;
  // With a slash, so that it is no other case's name.
  made.name = fmt::format("{}/{}", crop, row.filename().string());
  std::replace_if(
      made.name.begin(), made.name.end(),
      [](char c) { return std::string_view(",;|\"\n\r").find(c) != std::string_view::npos; }, '-');
  made.dataset = made.name;
  made.source = PairSource::kPublished;
  made.published = PublishedPair{.fixed_cloud = drone / kCloud,
                                 .moving_cloud = row / kCloud,
                                 .truth_file = truth,
                                 .true_fixed_from_moving = {}};
  if (truth) made.published->true_fixed_from_moving = io::readTransform(*truth);
  return made;
}

/// The cases of a folder that holds the folders of clouds; none where it holds no cloud.
std::vector<Case> casesOfCrop(const std::string& name, const fs::path& crop) {
  std::vector<fs::path> drones;
  std::vector<fs::path> rows;
  for (const fs::path& folder : entriesOf(crop)) {
    std::error_code ignored;
    if (!fs::is_regular_file(folder / kCloud, ignored)) continue;
    if (hasAny(loweredName(folder), kDroneWords)) {
      drones.push_back(folder);
    } else if (hasAny(loweredName(folder), kRowWords)) {
      rows.push_back(folder);
    } else {
      spdlog::warn("{}: left out; its name has none of: {}, {}", folder.string(),
                   fmt::join(kDroneWords, ", "), fmt::join(kRowWords, ", "));
    }
  }
  if (drones.empty() && rows.empty()) return {};
  if (drones.size() != 1 || rows.empty()) {
    throw InputError(fmt::format("{}: has {} clouds of drones ({}) and {} of rows ({}); {}",
                                 crop.string(), drones.size(), namesOf(drones), rows.size(),
                                 namesOf(rows), kLayout));
  }
  std::vector<Case> cases;
  for (const fs::path& row : rows) {
    std::optional<fs::path> truth = truthIn(row);
    if (!truth && rows.size() == 1) truth = truthIn(crop);
    cases.push_back(caseOf(name, drones.front(), row, truth));
  }
  return cases;
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

std::vector<Case> publishedCases(const std::vector<fs::path>& dirs) {
  std::vector<Case> cases;
  const auto add = [&](std::vector<Case> more) {
    for (Case& one : more) {
      const auto same = std::find_if(cases.begin(), cases.end(),
                                     [&](const Case& known) { return known.name == one.name; });
      if (same != cases.end()) {
        throw InputError(
            fmt::format("{} and {}: both are the pair '{}'; name one folder that has both of them "
                        "in folders of different names",
                        same->published->moving_cloud.string(),
                        one.published->moving_cloud.string(), one.name));
      }
      cases.push_back(std::move(one));
    }
  };
  for (const fs::path& dir : dirs) {
    std::error_code ignored;
    if (!fs::is_directory(dir, ignored)) {
      throw InputError(fmt::format("{}: is no folder that can be opened", dir.string()));
    }
    const std::size_t before = cases.size();
    // Without the slash that shells add.
    const fs::path top =
        fs::weakly_canonical(dir.has_filename() ? dir : dir.parent_path(), ignored);
    add(casesOfCrop(top.filename().string(), dir));
    for (const fs::path& crop : entriesOf(dir)) {
      if (fs::is_directory(crop, ignored)) add(casesOfCrop(crop.filename().string(), crop));
    }
    if (cases.size() == before) {
      throw InputError(fmt::format("{}: no pair of clouds in it; {}", dir.string(), kLayout));
    }
  }
  return cases;
}

std::string publishedText(const PublishedPair& pair) {
  std::string text = fmt::format("{}|{}|", fileText(pair.fixed_cloud), fileText(pair.moving_cloud));
  if (pair.true_fixed_from_moving) {
    for (const double value : pair.true_fixed_from_moving->matrix().reshaped()) {
      text += fmt::format("{:.17g} ", value);
    }
  }
  return text;
}

}  // namespace agricolmap::experiments
