#include "agricolmap/batch/manifest.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "agricolmap/core/error.hpp"

namespace agricolmap::batch {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class ManifestTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("agricolmap_manifest_{}[1]", ::getpid());
    fs::create_directories(folder_);
    for (const char* file : {"drone.las", "other.las", "s/a.ply", "s/b.ply", "s/b.txt", "s/a.txt",
                             "runs/r1/ugv/cloud.ply", "runs/r2/ugv/cloud.ply", "runs/r1/p.txt",
                             "runs/r2/p.txt", "ortho.tif", "dsm.tif"}) {
      write(file, "x");
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  Manifest read(const std::string& text) const {
    write("m.yaml", text);
    return readManifest(folder_ / "m.yaml");
  }
  /// What it is refused with, without the folder's name.
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const UsageError& error) {
      std::string what = error.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at = 0; (at = what.find(prefix, at)) != std::string::npos;) {
        what.erase(at, prefix.size());
      }
      return what;
    }
    return "accepted";
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

constexpr const char* kMap = "maps: [{id: field, file: drone.las}]\n";

TEST_F(ManifestTest, OneStripNeedsLittle) {
  const Manifest manifest = read(std::string(kMap) + "strips: [{file: s/a.ply}]");
  ASSERT_EQ(manifest.strips.size(), 1U);
  const Strip& strip = manifest.strips[0];
  EXPECT_EQ(strip.id, "a");
  EXPECT_EQ(strip.map, 0U);
  EXPECT_EQ(strip.file, at("s/a.ply"));
  EXPECT_EQ(strip.prior, "");
  EXPECT_EQ(strip.date, 0);
  EXPECT_EQ(manifest.maps[0].file, at("drone.las"));
}

TEST_F(ManifestTest, PatternsMakeAStripOfEachFile) {
  const Manifest manifest = read(std::string(kMap) + R"(
strips:
  - {file: "s/*.ply", prior: "s/{name}.txt"}
  - {file: "runs/*/ugv/*.ply", id: "run-{1}-{2}", path: "runs/{1}/p.txt", date: 2026-05-31}
)");
  std::vector<std::string> ids;
  for (const Strip& strip : manifest.strips) ids.push_back(strip.id);
  EXPECT_THAT(ids, ElementsAre("a", "b", "run-r1-cloud", "run-r2-cloud"));
  EXPECT_EQ(manifest.strips[1].prior, at("s/b.txt"));
  EXPECT_EQ(manifest.strips[3].path, at("runs/r2/p.txt"));
  EXPECT_EQ(manifest.strips[3].date, 20260531);
}

TEST_F(ManifestTest, TheNearestLevelDecides) {
  const Manifest manifest = read(R"(
options: {grid: {cell: 0.03}, seed: 7}
pictures: false
maps:
  - {id: one, file: drone.las}
  - {id: two, file: [ortho.tif, dsm.tif], options: {grid: {cell: 0.04}}}
strips:
  - {id: a, map: one, file: s/a.ply}
  - {id: b, map: two, file: s/b.ply, keep_rejected: true}
  - {id: c, like: d, file: s/b.ply, pictures: true}
  - {id: d, map: two, file: s/a.ply, prior: s/a.txt, options: {grid: {cell: 0.05}}}
)");
  ASSERT_EQ(manifest.strips.size(), 4U);
  EXPECT_EQ(manifest.strips[0].options.grid.cell, 0.03);
  EXPECT_EQ(manifest.strips[0].options.seed, 7);
  EXPECT_FALSE(manifest.strips[0].settings.pictures);
  EXPECT_EQ(manifest.strips[1].options.grid.cell, 0.04);
  EXPECT_TRUE(manifest.strips[1].settings.keep_rejected);
  EXPECT_EQ(manifest.strips[2].options.grid.cell, 0.05);
  EXPECT_EQ(manifest.strips[2].map, 1U);
  EXPECT_EQ(manifest.strips[2].prior, at("s/a.txt"));
  EXPECT_TRUE(manifest.strips[2].settings.pictures);
  EXPECT_EQ(manifest.maps[1].file, at("ortho.tif") + "," + at("dsm.tif"));
}

TEST_F(ManifestTest, TellsAllThatIsWrongWithItsLines) {
  const std::string refused = refusal(R"(# line 1 is empty
option: {grid: {cell: 0.02}}
maps:
  - {id: field, file: drone.las, options: {grid: {cel: 0.02}}}
  - {id: field, file: nowhere.las}
strips:
  - {id: a, map: feld, file: s/a.ply}
  - {id: a, map: field, file: s/b.ply, prior: s/none.txt}
  - {id: c, map: field, file: "s/*.xyz", date: 2026-02-30}
  - {id: "no good", map: field, fille: s/a.ply}
  - {id: e, map: field, file: s/a.ply, options: {grid: {cell: 99}}, pictures: maybe}
  - {id: f, map: field, file: s/a.ply, preset: papper}
  - {id: g, map: field, file: s/a.ply, map: field}
)");
  EXPECT_THAT(refused, HasSubstr("m.yaml:2: the manifest has no field 'option' (did you mean "
                                 "'options'?)"));
  EXPECT_THAT(refused,
              HasSubstr("m.yaml:4: unknown option 'grid.cel' (did you mean 'grid.cell'?)"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:5: a map 'field' is there already, in line 4"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:5: nowhere.las: there is no such file"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:7: there is no map 'feld' (did you mean 'field'?)"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:8: s/none.txt: there is no such file"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:9: no file is like s/*.xyz"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:9: '2026-02-30' is no day"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:10: a strip has no field 'fille' (did you mean 'file'?)"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:10: a strip needs a file"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:11: option grid.cell cannot be '99'"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:11: pictures must be true or false"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:12: there is no preset 'papper' (did you mean 'paper'?)"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:13: map was given in line 13 already"));
}

TEST_F(ManifestTest, StripsLikeOneAnotherInACircleAreRefused) {
  const std::string refused = refusal(std::string(kMap) + R"(strips:
  - {id: a, file: s/a.ply, like: b}
  - {id: b, file: s/b.ply, like: c}
  - {id: c, file: s/b.ply, like: b}
  - {id: d, file: s/b.ply, like: d}
  - {id: e, file: s/b.ply, like: bb}
)");
  EXPECT_THAT(refused, HasSubstr("m.yaml:4: strips are like one another in a circle: b -> c -> b"));
  EXPECT_THAT(refused, HasSubstr("m.yaml:6: strips are like one another in a circle: d -> d"));
  EXPECT_THAT(refused,
              HasSubstr("m.yaml:7: there is no strip 'bb' to be like (did you mean 'b'?)"));
}

TEST_F(ManifestTest, DuplicateIdsAreRefusedWhereverTheyComeFrom) {
  EXPECT_THAT(refusal(std::string(kMap) + "strips: [{file: s/a.ply}, {file: \"s/*.ply\"}]"),
              HasSubstr("a strip 'a' is there already"));
  EXPECT_THAT(refusal(std::string(kMap) + "strips: [{file: \"runs/*/ugv/*.ply\"}]"),
              HasSubstr("a strip 'cloud' is there already"));
}

TEST_F(ManifestTest, IdsAreNamesOfFolders) {
  for (const char* id : {"../x", ".x", "-x", "a/b", "summary.csv", "a b", "a\\nb"}) {
    EXPECT_THAT(
        refusal(std::string(kMap) + fmt::format("strips: [{{file: s/a.ply, id: \"{}\"}}]", id)),
        HasSubstr("is no id"))
        << id;
  }
  EXPECT_EQ(refusal(std::string(kMap) + "strips: [{file: s/a.ply, id: Köln-3.2_b+}]"), "accepted");
}

TEST_F(ManifestTest, WhatIsNoManifestIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("m.yaml:1: the manifest must be a map"));
  EXPECT_THAT(refusal("- a\n- b"), HasSubstr("must be a map"));
  EXPECT_THAT(refusal("maps: [\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(refusal("a: 1\n---\nb: 2"), HasSubstr("second document"));
  EXPECT_THAT(refusal(kMap), HasSubstr("needs 'strips'"));
  EXPECT_THAT(refusal(std::string(kMap) + "strips: []"), HasSubstr("needs 'strips'"));
  EXPECT_THAT(refusal(std::string(kMap) + "strips: [{file: s/a.ply, id: \"{2}\"}]"),
              HasSubstr("'{2}' stands for nothing here"));
  EXPECT_THROW(readManifest(folder_ / "none.yaml"), InputError);
  EXPECT_THROW(readManifest(folder_), InputError);
}

TEST_F(ManifestTest, AnOptionWithoutEffectIsRefused) {
  EXPECT_THAT(
      refusal(std::string(kMap) + "strips: [{file: s/a.ply, options: {flow: {vote: {step: 2}}}}]"),
      testing::AnyOf(HasSubstr("would do nothing"), HasSubstr("unknown option")));
}

}  // namespace
}  // namespace agricolmap::batch
