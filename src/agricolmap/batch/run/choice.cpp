#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string_view>

#include "agricolmap/batch/run/batch_run.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::batch {
namespace {

/// Of a strip that is called so, or has that number.
std::size_t stripCalled(const std::string& name, const Manifest& manifest, const std::string& of,
                        const std::string& hint) {
  const auto found = std::ranges::find(manifest.strips, name, &Strip::id);
  if (found != manifest.strips.end()) {
    return static_cast<std::size_t>(found - manifest.strips.begin());
  }
  const std::optional<double> number = io::parseNumber(name);
  for (std::size_t i = 0; number && i < manifest.strips.size(); ++i) {
    if (*number == static_cast<double>(i + 1)) return i;
  }
  throw UsageError(
      fmt::format("{} {}: is neither the id of a strip of {} nor a number from 1 to {}{}", of, name,
                  manifest.file.string(), manifest.strips.size(), hint));
}

}  // namespace

std::vector<std::size_t> allStrips(const Manifest& manifest) {
  std::vector<std::size_t> chosen(manifest.strips.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  return chosen;
}

std::vector<std::size_t> shardOf(const Manifest& manifest, std::size_t part, std::size_t parts) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = part - 1; i < manifest.strips.size(); i += parts) chosen.push_back(i);
  return chosen;
}

std::vector<std::size_t> stripsCalled(std::span<const std::string> names, const Manifest& manifest,
                                      const std::string& of, const std::string& hint) {
  std::vector<std::size_t> chosen;
  for (const std::string& name : names) chosen.push_back(stripCalled(name, manifest, of, hint));
  std::ranges::sort(chosen);
  const auto twice = std::ranges::unique(chosen);
  chosen.erase(twice.begin(), twice.end());
  return chosen;
}

}  // namespace agricolmap::batch
