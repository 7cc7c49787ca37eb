#include "targets.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/control_points/control_points_file.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/raster_import.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/io/text/path_file.hpp"

namespace agricolmap::fuzz {
namespace {

/// A file in memory: on a disk a run would take a hundred times as long.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes) : fd_(::memfd_create("fuzz", 0)) {
    if (fd_ < 0 || ::write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      std::abort();
    }
  }
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

void readCloud(const std::filesystem::path& file) {
  const Cloud cloud = io::readCloud(file);
  const bool finite = std::all_of(cloud.xyz.begin(), cloud.xyz.end(),
                                  [](const Eigen::Vector3f& p) { return p.allFinite(); });
  if (cloud.empty() || !finite || (cloud.hasColour() && cloud.rgb.size() != cloud.size())) {
    std::abort();
  }
}

void readYaml(const std::filesystem::path& file) {
  io::ImportOptions options;  // few, and of all kinds
  OptionTable table = optionTable(options);
  config::loadYaml(file, table);
}

constexpr std::array<Target, 8> kTargets{{
    {"cloud", readCloud},
    {"las", readCloud},
    {"crs", [](const std::filesystem::path& file) { io::crsOf(file); }},
    {"matrix", [](const std::filesystem::path& file) { io::readTransform(file); }},
    {"offset", [](const std::filesystem::path& file) { io::readOffset(file); }},
    {"path", [](const std::filesystem::path& file) { io::readPath(file); }},
    {"control_points",
     [](const std::filesystem::path& file) { control_points::readControlPairs(file); }},
    {"options", readYaml},
}};

}  // namespace

std::span<const Target> targets() { return kTargets; }

const Target* targetOf(std::string_view name) {
  const auto* const found = std::find_if(kTargets.begin(), kTargets.end(),
                                         [&](const Target& target) { return target.name == name; });
  return found == kTargets.end() ? nullptr : found;
}

bool runOn(const Target& target, std::span<const std::uint8_t> bytes) {
  const MemoryFile file(bytes);
  try {
    target.read(file.path());
    return true;
  } catch (const InputError&) {
    return false;
  } catch (const UsageError&) {
    return false;
  }
}

}  // namespace agricolmap::fuzz
