#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "agricolmap/batch/run/batch_run.hpp"

namespace agricolmap::batch {
namespace {

using Numbers = std::vector<std::size_t>;

Manifest manifestWith(const std::vector<std::string>& ids) {
  Manifest manifest;
  manifest.file = "fields.yaml";
  for (const std::string& id : ids) manifest.strips.emplace_back().id = id;
  return manifest;
}

TEST(Choice, PartsAreTheWholeTogether) {
  const Manifest manifest = manifestWith({"a", "b", "c", "d", "e"});
  EXPECT_EQ(allStrips(manifest), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_EQ(shardOf(manifest, 1, 2), (Numbers{0, 2, 4}));
  EXPECT_EQ(shardOf(manifest, 2, 2), (Numbers{1, 3}));
  EXPECT_EQ(shardOf(manifest, 7, 8), Numbers{});
}

TEST(Choice, StripsAreKnownByIdsBeforeNumbers) {
  const Manifest manifest = manifestWith({"2", "b", "c"});
  const std::vector<std::string> named = {"c", "2", "3", "2"};
  EXPECT_EQ(stripsCalled(named, manifest, "item"), (Numbers{0, 2}));
  for (const char* wrong : {"d", "0", "4", "1.5", ""}) {
    const std::vector<std::string> one = {wrong};
    EXPECT_THROW(stripsCalled(one, manifest, "item"), UsageError) << wrong;
  }
}

}  // namespace
}  // namespace agricolmap::batch
