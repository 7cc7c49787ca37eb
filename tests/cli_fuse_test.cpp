// Shared maps, as a user meets them.
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

namespace fs = std::filesystem;

class FuseTest : public CliTest {
 protected:
  /// The fixed cloud of a field with three strips; see CMakeLists.txt.
  std::string fixed() const { return pair("strips").uav(); }
  /// The folder of strip 1, 2 or 3's registration.
  std::string strip(int number) const {
    return pair("strips").folder.parent_path() / "runs" / ("strip_" + std::to_string(number));
  }
  std::vector<std::string> words(std::vector<std::string> more) const {
    more.insert(more.begin(), {"fuse", fixed(), "-o", inFolder("map")});
    return more;
  }
  ProgramResult fuse(const std::vector<std::string>& more) const { return run(words(more)); }
  void refuses(const std::vector<std::string>& more, int code, const std::string& part) const {
    expectFailure(words(more), code, {part});
  }
  nlohmann::json report() const { return jsonOf(inFolder("map/map.json")); }
  std::string layer(const std::string& name) const {
    return contentOf(inFolder("map/layers/" + name + ".tif"));
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    const nlohmann::json map = report();
    for (const nlohmann::json& source : map.at("sources")) all.insert(source.at("id"));
    return all;
  }
};

TEST_F(FuseTest, AMapGrowsShrinksAndForgetsNothing) {
  const ProgramResult first = fuse({strip(1), strip(2), strip(3)});
  EXPECT_NE(first.out.find("3 strips"), std::string::npos) << first.out;
  EXPECT_EQ(names(), (std::set<std::string>{"fixed", "strip_1", "strip_2", "strip_3"}));
  const nlohmann::json map = report();
  for (const nlohmann::json& name : map.at("layers")) {
    EXPECT_TRUE(fs::exists(inFolder("map/" + name.get<std::string>()))) << name;
  }
  std::uint64_t kept = 0;
  for (const nlohmann::json& source : map.at("sources")) {
    kept += source.at("points_in_cloud").get<std::uint64_t>();
    EXPECT_GT(source.at("points_in_cloud"), 0);
  }
  const ProgramResult info = run({"info", inFolder("map/cloud.copc.laz")});
  EXPECT_NE(info.out.find(std::to_string(kept)), std::string::npos) << info.out;

  // The same strips one after the other, in another order: the same layers to the bit.
  const std::string surface = layer("surface"), source = layer("source");
  fs::remove_all(inFolder("map"));
  fuse({strip(3), "--cloud-format", "none"});
  write("map/notes.txt", "mine");
  fuse({strip(1), "--cloud-format", "none"});
  fuse({strip(2), "--cloud-format", "none"});
  EXPECT_TRUE(layer("surface") == surface);
  EXPECT_TRUE(layer("source") == source);
  EXPECT_EQ(contentOf(inFolder("map/notes.txt")), "mine");

  // What comes out leaves nothing behind.
  fuse({"--remove", "strip_2", "--cloud-format", "none"});
  EXPECT_EQ(names(), (std::set<std::string>{"fixed", "strip_1", "strip_3"}));
  EXPECT_FALSE(fs::exists(inFolder("map/strips/strip_2.laz")));
  const std::string without = layer("surface");
  fuse({strip(1), strip(3), "--anew", "--cloud-format", "none"});
  EXPECT_TRUE(layer("surface") == without);
}

TEST_F(FuseTest, WhatIsNoMapOrNoStripIsToldSo) {
  refuses({}, 3, "no strip to fuse");
  refuses({"--remove", "strip_1"}, 2, "no map");
  refuses({pair("strips").folder}, 3, "registration.json");
  refuses({strip(1), "--date", "x=2026-05-01"}, 2, "no strip of that name");
  refuses({strip(1), "--fixed-date", "2026-13-01"}, 2, "YYYY-MM-DD");
  EXPECT_FALSE(fs::exists(inFolder("map")));
  // A folder of somebody else's.
  write("map/notes.txt", "mine");
  refuses({strip(1)}, 4, "not empty");
  fs::remove_all(inFolder("map"));
  fuse({strip(1), "--cloud-format", "none", "--date", "strip_1=2026-05-01"});
  EXPECT_EQ(report().at("sources").at(1).at("date"), 20260501);
  // A map of another field, a newer one, a damaged one: it stays as it is.
  const std::string map = contentOf(inFolder("map/map.json"));
  expectFailure({"fuse", pair("strips").ugv(), strip(2), "-o", inFolder("map")}, 3,
                {"is a map of"});
  EXPECT_EQ(contentOf(inFolder("map/map.json")), map);
  std::string newer = map;
  newer.replace(newer.find("\"format_version\": 1"), 19, "\"format_version\": 2");
  write("map/map.json", newer);
  refuses({strip(2)}, 3, "format version 2");
  write("map/map.json", map.substr(0, map.size() / 2));
  refuses({strip(2)}, 3, "damaged");
}

TEST_F(FuseTest, ARejectedStripIsFusedOnlyByForce) {
  fs::copy(strip(2), inFolder("strip_2"));
  nlohmann::json rejected = jsonOf(inFolder("strip_2/registration.json"));
  rejected["status"] = "rejected";
  write("strip_2/registration.json", rejected.dump());
  const ProgramResult result = fuse({strip(1), inFolder("strip_2"), "--cloud-format", "none"});
  EXPECT_NE(result.err.find("not fused"), std::string::npos) << result.err;
  EXPECT_EQ(names(), (std::set<std::string>{"fixed", "strip_1"}));
  fuse({inFolder("strip_2"), "--force", "--cloud-format", "none"});
  EXPECT_EQ(names(), (std::set<std::string>{"fixed", "strip_1", "strip_2"}));
}

}  // namespace
}  // namespace agricolmap::test
