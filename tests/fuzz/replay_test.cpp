// The seeds of the fuzzers, and what once went wrong, as a test for every compiler.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <vector>

#include "targets.hpp"

namespace agricolmap::fuzz {
namespace {

TEST(Replay, EverySeedIsReadOrRefused) {
  for (const Target& target : targets()) {
    const auto folder = std::filesystem::path(AGRICOLMAP_FUZZ_CORPUS) / target.name;
    int seeds = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      SCOPED_TRACE(entry.path());
      std::ifstream file(entry.path(), std::ios::binary);
      const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
      runOn(target, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
      ++seeds;
    }
    EXPECT_GT(seeds, 0) << folder;
  }
}

}  // namespace
}  // namespace agricolmap::fuzz
