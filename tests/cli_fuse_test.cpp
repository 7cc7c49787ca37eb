// Shared maps, as a user meets them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

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
  for (const char* name :
       {"layers/plant_height", "layers/error", "layers/source", "fine/strip_1", "fine/cover"}) {
    const std::string style = contentOf(inFolder(std::string("map/") + name + ".qml"));
    EXPECT_NE(style.find("<rasterrenderer"), std::string::npos) << name;
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

/// A LAS file as this program writes it, uncompressed.
class LasFile {
 public:
  explicit LasFile(std::string bytes) : bytes_(std::move(bytes)) {}
  std::size_t points() const { return at<std::uint64_t>(247); }
  std::size_t record(std::size_t i) const {
    return at<std::uint32_t>(96) + i * at<std::uint16_t>(105);
  }
  template <typename T>
  T at(std::size_t place) const {
    T value;
    std::memcpy(&value, &bytes_[place], sizeof(T));
    return value;
  }
  template <typename T>
  void set(std::size_t place, T value) {
    std::memcpy(&bytes_[place], &value, sizeof(T));
  }
  const std::string& bytes() const { return bytes_; }
  /// Where a point lies from west to east, in millimetres of a whole metre: it stays as points are
  /// copied.
  std::uint16_t millimetres(std::size_t i) const {
    const double x = at<double>(131) * at<std::int32_t>(record(i)) + at<double>(155);
    return static_cast<std::uint16_t>(std::llround(1000.0 * x) % 1000);
  }

 private:
  std::string bytes_;
};

TEST_F(FuseTest, MarksOfPointsComeAlongWhereASourceIsLas) {
  // Intensities by place, so that no point has those of another; a class for each source.
  const auto mark = [&](const std::string& cloud, const std::string& name, std::uint8_t kind) {
    LasFile las(contentOf(converted(cloud, "plain_" + name)));
    for (std::size_t i = 0; i < las.points(); ++i) {
      las.set(las.record(i) + 12, las.millimetres(i));
      las.set(las.record(i) + 14, std::uint8_t{0x21});
      las.set(las.record(i) + 16, kind);
    }
    return write(name, las.bytes());
  };
  const std::string drone = mark(fixed(), "drone.las", 6);
  fs::copy(strip(1), inFolder("marked"));
  mark(inFolder("marked/aligned.ply"), "marked/aligned.las", 40);
  fs::remove(inFolder("marked/aligned.ply"));
  run({"fuse", drone, inFolder("marked"), strip(3), "-o", inFolder("map"), "--adjust=false",
       "--cloud-format", "las"});
  const LasFile fused(contentOf(inFolder("map/cloud.las")));
  std::array<std::size_t, 4> of_source{};
  for (std::size_t i = 0; i < fused.points(); ++i) {
    const std::size_t record = fused.record(i);
    const auto source = fused.at<std::uint16_t>(record + 20);
    ASSERT_LT(source, 4);
    ++of_source[source];
    const bool has = source != 3;  // strip 3 is a PLY file
    ASSERT_EQ(fused.at<std::uint16_t>(record + 12), has ? fused.millimetres(i) : 0) << i;
    ASSERT_EQ(fused.at<std::uint8_t>(record + 14), has ? 0x21 : 0x11);
    ASSERT_EQ(fused.at<std::uint8_t>(record + 16), source == 1 ? 6 : source == 2 ? 40 : 0);
  }
  EXPECT_GT(of_source[1], 0U);
  EXPECT_GT(of_source[2], 0U);
  EXPECT_GT(of_source[3], 0U);
}

}  // namespace
}  // namespace agricolmap::test
