#include "experiments/pairs/published.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"

namespace agricolmap::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCloud = "point_cloud.ply";
constexpr int kDepth = 3;
constexpr const char* kLayout =
    "a crop is a folder with folders like 'uav' and 'ugv_row1', each with a point_cloud.ply";

constexpr std::array<std::string_view, 2> kDroneWords = {"uav", "aerial"};
constexpr std::array<std::string_view, 3> kRowWords = {"ugv", "ground", "row"};
constexpr std::array<std::string_view, 2> kTruthWords = {"truth", "affine"};

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isWordChar(char c) { return isDigit(c) || (c >= 'a' && c <= 'z'); }

std::string lowered(std::string text) {
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

/// The letters and digits of a name, cut where anything else stands.
std::vector<std::string> wordsOf(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : lowered(name) + ' ') {
    if (isWordChar(c)) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  return words;
}

/// A folder's name without what says whose cloud it is, so that those of one crop are equal.
std::string cropKey(const std::string& name) {
  std::vector<std::string> kept;
  bool after_role = false;
  for (const std::string& word : wordsOf(name)) {
    const bool number = std::all_of(word.begin(), word.end(), isDigit);
    if (number && after_role) continue;
    after_role = hasAny(word, kDroneWords) || hasAny(word, kRowWords);
    if (!after_role) kept.push_back(word);
  }
  return fmt::format("{}", fmt::join(kept, "-"));
}

/// The number after "row" (else "ugv", "ground"), without separators and leading zeros; empty when
/// there is none.
std::string rowNumber(const std::string& name) {
  const std::string text = lowered(name);
  for (const std::string_view word : {"row", "ugv", "ground"}) {
    for (std::size_t at = text.rfind(word); at != std::string::npos;
         at = at == 0 ? std::string::npos : text.rfind(word, at - 1)) {
      std::size_t begin = at + word.size();
      while (begin < text.size() && !isWordChar(text[begin])) ++begin;
      while (begin + 1 < text.size() && text[begin] == '0' && isDigit(text[begin + 1])) ++begin;
      std::size_t end = begin;
      while (end < text.size() && isDigit(text[end])) ++end;
      if (end > begin) return text.substr(begin, end - begin);
    }
  }
  return "";
}

/// Clouds of one folder, which is one crop or, where names tell them apart, several.
struct CropFolder {
  std::vector<fs::path> drones;  ///< folders of clouds
  std::vector<fs::path> rows;
};

/// Calls `visit(entry, depth)` for what lies in `dir`, depth from 0; it says whether to go deeper.
template <typename Visit>
void walk(const fs::path& dir, const Visit& visit) {
  std::error_code error;
  fs::recursive_directory_iterator it(dir, fs::directory_options::follow_directory_symlink, error);
  for (; !error && it != fs::end(it); it.increment(error)) {
    if (!visit(*it, it.depth())) it.disable_recursion_pending();
  }
  if (error) {
    throw InputError(fmt::format("{}: cannot be searched: {}", dir.string(), error.message()));
  }
}

bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::map<fs::path, CropFolder> cropFolders(const fs::path& dir) {
  std::map<fs::path, CropFolder> crops;
  walk(dir, [&](const fs::directory_entry& entry, int depth) {
    std::error_code ignored;
    const fs::path& path = entry.path();
    if (!entry.is_directory(ignored) || path.filename().string().starts_with('.')) return false;
    if (isFile(path / kCloud)) {
      const std::string name = lowered(path.filename().string());
      CropFolder& crop = crops[path.parent_path()];
      if (hasAny(name, kDroneWords)) {
        crop.drones.push_back(path);
      } else if (hasAny(name, kRowWords)) {
        crop.rows.push_back(path);
      } else {
        spdlog::warn(
            "{}: left out; its name has neither 'uav' or 'aerial' nor 'ugv', 'ground' or "
            "'row'",
            path.string());
      }
    }
    return depth + 1 < kDepth;
  });
  for (auto& [folder, crop] : crops) {
    std::sort(crop.drones.begin(), crop.drones.end());
    std::sort(crop.rows.begin(), crop.rows.end());
  }
  return crops;
}

std::string namesOf(const std::vector<fs::path>& paths) {
  std::vector<std::string> names;
  names.reserve(paths.size());
  for (const fs::path& path : paths) names.push_back(path.filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The drone's cloud of a row.
const fs::path& droneOf(const fs::path& row, const fs::path& folder, const CropFolder& crop) {
  if (crop.drones.size() == 1) return crop.drones.front();
  const std::string key = cropKey(row.filename().string());
  const fs::path* found = nullptr;
  for (const fs::path& drone : crop.drones) {
    if (cropKey(drone.filename().string()) != key) continue;
    if (found != nullptr) {
      found = nullptr;
      break;
    }
    found = &drone;
  }
  if (found == nullptr) {
    throw InputError(fmt::format(
        "{}: has {} clouds of drones ({}), and names do not say which of them the row "
        "'{}' belongs to; give each crop a folder of its own",
        folder.string(), crop.drones.size(), namesOf(crop.drones), row.filename().string()));
  }
  return *found;
}

/// Files that may be a truth, sorted.
std::vector<fs::path> truthsIn(const fs::path& folder) {
  std::vector<fs::path> truths;
  walk(folder, [&](const fs::directory_entry& entry, int) {
    const std::string name = lowered(entry.path().filename().string());
    if (name.ends_with(".txt") && hasAny(name, kTruthWords) && isFile(entry.path())) {
      truths.push_back(entry.path());
    }
    return false;
  });
  std::sort(truths.begin(), truths.end());
  return truths;
}

/// Of truths in the folder above a row's, those that are named after the row.
std::vector<fs::path> namedAfter(const fs::path& row, const std::vector<fs::path>& truths,
                                 bool several_crops) {
  const std::string name = lowered(row.filename().string());
  const std::string number = rowNumber(name);
  std::vector<fs::path> by_name;
  std::vector<fs::path> by_number;
  for (const fs::path& truth : truths) {
    const std::string stem = lowered(truth.stem().string());
    const std::size_t at = stem.find(name);
    // "ugv_row1" is no name in "ugv_row12_truth".
    const std::size_t after = at + name.size();
    const bool whole = at != std::string::npos &&
                       (after >= stem.size() || !isDigit(name.back()) || !isDigit(stem[after]));
    if (whole) by_name.push_back(truth);
    if (!several_crops && !number.empty() && rowNumber(stem) == number) by_number.push_back(truth);
  }
  return by_name.empty() ? by_number : by_name;
}

std::optional<fs::path> truthOf(const fs::path& row, const CropFolder& crop,
                                const std::vector<fs::path>& truths_above) {
  std::vector<fs::path> truths = truthsIn(row);
  if (truths.empty()) {
    const bool only = crop.rows.size() == 1 && truths_above.size() == 1;
    truths = only ? truths_above : namedAfter(row, truths_above, crop.drones.size() > 1);
  }
  if (truths.size() > 1) {
    throw InputError(fmt::format("{}: {} files may be the truth of the row '{}' ({}); leave one",
                                 truths.front().parent_path().string(), truths.size(),
                                 row.filename().string(), namesOf(truths)));
  }
  if (truths.empty()) return std::nullopt;
  return truths.front();
}

std::string cropName(const fs::path& dir, const fs::path& folder, const CropFolder& crop,
                     const fs::path& row) {
  std::string key = crop.drones.size() > 1 ? cropKey(row.filename().string()) : "";
  if (folder != dir) {
    const fs::path relative = folder.lexically_relative(dir);
    return (key.empty() ? relative : relative / key).generic_string();
  }
  if (!key.empty()) return key;
  std::error_code ignored;
  return fs::weakly_canonical(dir, ignored).filename().string();
}

void addPairs(const fs::path& dir, const fs::path& folder, const CropFolder& crop,
              std::vector<PublishedPair>& pairs) {
  if (crop.drones.empty() && crop.rows.empty()) return;
  if (crop.drones.empty()) {
    throw InputError(fmt::format("{}: has rows ({}) and no cloud of a drone; {}", folder.string(),
                                 namesOf(crop.rows), kLayout));
  }
  std::set<fs::path> without_row(crop.drones.begin(), crop.drones.end());
  const std::vector<fs::path> truths_above = truthsIn(folder);
  std::set<fs::path> idle_truths(truths_above.begin(), truths_above.end());
  bool all_have_truth = true;
  for (const fs::path& row : crop.rows) {
    const fs::path& drone = droneOf(row, folder, crop);
    without_row.erase(drone);
    PublishedPair pair;
    pair.crop = cropName(dir, folder, crop, row);
    pair.row = row.filename().string();
    pair.fixed_cloud = drone / kCloud;
    pair.moving_cloud = row / kCloud;
    pair.world_from_fixed = io::readOffsetBeside(pair.fixed_cloud);
    pair.world_from_moving = io::readOffsetBeside(pair.moving_cloud);
    pair.truth_file = truthOf(row, crop, truths_above);
    if (pair.truth_file) {
      idle_truths.erase(*pair.truth_file);
      pair.true_fixed_from_moving = io::readTransform(*pair.truth_file);
    }
    all_have_truth = all_have_truth && pair.truth_file.has_value();
    pairs.push_back(std::move(pair));
  }
  if (!without_row.empty()) {
    throw InputError(fmt::format("{}: no row belongs to this drone's cloud; {}",
                                 without_row.begin()->string(), kLayout));
  }
  if (!all_have_truth && !idle_truths.empty()) {
    throw InputError(fmt::format(
        "{}: does not say which row it is the truth of; put it into the row's folder or "
        "call it like '{}_ground_truth.txt'",
        idle_truths.begin()->string(), crop.rows.front().filename().string()));
  }
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

std::vector<PublishedPair> findPublishedPairs(const fs::path& dir) {
  std::error_code ignored;
  if (!fs::is_directory(dir, ignored)) {
    throw InputError(fmt::format("{}: is no folder that can be opened", dir.string()));
  }
  // Without the slash that shells add, parents compare equal to it.
  const fs::path top = dir.has_filename() ? dir : dir.parent_path();
  std::vector<PublishedPair> pairs;
  for (const auto& [folder, crop] : cropFolders(top)) addPairs(top, folder, crop, pairs);
  if (pairs.empty()) {
    throw InputError(fmt::format("{}: no pair of clouds in it, {} folders deep; {}", dir.string(),
                                 kDepth, kLayout));
  }
  std::sort(pairs.begin(), pairs.end(), [](const PublishedPair& a, const PublishedPair& b) {
    return std::tie(a.crop, a.row) < std::tie(b.crop, b.row);
  });
  return pairs;
}

std::string publishedText(const PublishedPair& pair) {
  std::string text = fmt::format("{}|{}|{}|{}|", pair.crop, pair.row, fileText(pair.fixed_cloud),
                                 fileText(pair.moving_cloud));
  if (pair.true_fixed_from_moving) {
    for (const double value : pair.true_fixed_from_moving->matrix().reshaped()) {
      text += fmt::format("{:.17g} ", value);
    }
  }
  return text;
}

}  // namespace agricolmap::experiments
