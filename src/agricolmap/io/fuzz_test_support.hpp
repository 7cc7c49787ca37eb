// What tests need that damage files by thousands.
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::test {

/// A file in memory: rewriting one on disk thousands of times waits for the disk.
class MemoryFile {
 public:
  MemoryFile() : fd_(::memfd_create("cloud", MFD_CLOEXEC)) {
    if (fd_ < 0) throw OutputError("no file in memory");
  }
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path write(const std::string& content) const {
    const auto size = static_cast<ssize_t>(content.size());
    if (::ftruncate(fd_, 0) != 0 || ::pwrite(fd_, content.data(), content.size(), 0) != size) {
      throw OutputError("no space in memory");
    }
    return "/proc/self/fd/" + std::to_string(fd_);
  }

 private:
  int fd_;
};

/// Cuts a file off, or changes or inserts a few bytes, most of them in its first `header`.
inline std::string damage(std::string file, std::size_t header, Random& random) {
  const std::uint64_t kind = random.below(3);
  if (kind == 0) return file.substr(0, random.below(file.size()));
  header = std::min(file.size(), header);
  const std::uint64_t changes = 1 + random.below(4);
  for (std::uint64_t i = 0; i < changes; ++i) {
    const std::size_t at = random.below(random.chance(0.7) ? header : file.size());
    if (kind == 1) {
      file[at] = static_cast<char>(random.below(256));
    } else {
      file.insert(at, 1, "0123456789 -\n"[random.below(13)]);
    }
  }
  return file;
}

struct Survived {
  int read = 0;
  int refused = 0;
};

/// Reads `times` damaged versions of each file of 20 points: a cloud of finite points or an
/// InputError, nothing else, must come of it.
inline Survived readDamaged(const std::vector<std::string>& files, std::size_t header, int times,
                            std::uint64_t seed) {
  const MemoryFile memory;
  Random random(seed);
  Survived survived;
  for (const std::string& file : files) {
    EXPECT_EQ(io::readCloud(memory.write(file)).size(), 20U);
    for (int i = 0; i < times; ++i) {
      const auto path = memory.write(damage(file, header, random));
      try {
        const Cloud cloud = io::readCloud(path);
        ++survived.read;
        EXPECT_FALSE(cloud.empty());
        EXPECT_TRUE(std::all_of(cloud.xyz.begin(), cloud.xyz.end(),
                                [](const Eigen::Vector3f& p) { return p.allFinite(); }));
      } catch (const InputError&) {
        ++survived.refused;
      }
    }
  }
  return survived;
}

}  // namespace agricolmap::test
