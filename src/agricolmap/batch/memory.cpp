#include "agricolmap/batch/memory.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

namespace agricolmap::batch {
namespace {

constexpr double kKiB = 1024.0;

/// The number behind `name` in a file of "Name:   123 kB" lines [bytes].
std::optional<double> fieldOf(const char* file, const std::string& name) {
  std::ifstream stream(file);
  for (std::string word; stream >> word;) {
    double value = 0.0;
    if (word == name && stream >> value) return kKiB * value;
  }
  return std::nullopt;
}

/// A file with one number; nothing for "max" and where there is no such file.
std::optional<double> numberIn(const char* file) {
  std::ifstream stream(file);
  double value = 0.0;
  return stream >> value ? std::optional(value) : std::nullopt;
}

}  // namespace

double availableMemory() {
  double available = fieldOf("/proc/meminfo", "MemAvailable:").value_or(0.0);
  const auto limit = numberIn("/sys/fs/cgroup/memory.max");
  const auto used = numberIn("/sys/fs/cgroup/memory.current");
  if (limit && used) available = std::min(available, std::max(0.0, *limit - *used));
  return available;
}

double memoryInUse() { return fieldOf("/proc/self/status", "RssAnon:").value_or(0.0); }

}  // namespace agricolmap::batch
