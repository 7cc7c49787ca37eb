// Many strips in one go: each folder is what `register` makes, whole or not there; what is done is
// kept, and one bad strip is one strip's affair.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

namespace fs = std::filesystem;

class BatchTest : public CliTest {
 protected:
  /// A manifest of strips of the small pairs; `strips`: lines of its list.
  std::string manifest(const std::string& strips, const std::string& more = "") const {
    return write("m.yaml", "maps:\n  - {id: field, file: " + pair().uav() +
                               "}\n  - {id: other, file: " + pair("other_field").uav() + "}\n" +
                               more + "strips:\n" + strips);
  }
  /// `kind`: of the pair; the strip of `other_field` is rejected.
  static std::string strip(const std::string& id, const std::string& kind = "same_field",
                           const std::string& more = "") {
    return "  - {id: " + id + ", map: " + (kind == "same_field" ? "field" : "other") +
           ", file: " + pair(kind).ugv() + ", prior: " + pair(kind).prior() + more + "}\n";
  }
  /// Of a page but for the report in it, which is registration.json with its times. Megabytes that
  /// differ are more than a test's output can hold.
  static std::string digestOfPage(std::string page) {
    const std::size_t from = page.find("id=\"data-report\">");
    page.erase(from, page.find("</script>", from) - from);
    return std::to_string(page.size()) + " bytes, " +
           std::to_string(std::hash<std::string>()(page));
  }
  /// All files of the folders of strips, with what does not differ from run to run.
  std::set<std::string> results(const std::string& folder) const {
    std::set<std::string> found;
    for (const std::string& name : entries(folder)) {
      const fs::path path = inFolder(folder) + "/" + name;
      if (!fs::is_regular_file(path) || name.starts_with("summary")) continue;
      if (name.ends_with("report.html")) {
        found.insert(name + ": " + digestOfPage(contentOf(path)));
        continue;
      }
      if (path.extension() != ".json") {
        // A digest: the differences of two large texts take gigabytes to be told.
        const std::string content = contentOf(path);
        found.insert(name + ": " + std::to_string(content.size()) + " bytes, " +
                     std::to_string(std::hash<std::string>()(content)));
        continue;
      }
      nlohmann::json json = jsonOf(path);
      for (const char* varying :
           {"times", "peak_memory_bytes", "threads", "command_line", "seconds"}) {
        json.erase(varying);
      }
      found.insert(name + ": " + json.dump());
    }
    return found;
  }
  ProgramResult batch(const std::string& manifest, const std::string& folder,
                      const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"batch", manifest, "-o", inFolder(folder)};
    words.insert(words.end(), more.begin(), more.end());
    return runAgricolmap(words);
  }
};

TEST_F(BatchTest, AStripIsWhatRegisterMakesOfIt) {
  const PairFiles files = pair();
  ASSERT_EQ(batch(manifest(strip("a") + strip("b")), "out").exit_code, 0);
  run({"register", files.uav(), files.ugv(), "--prior", files.prior(), "-o", inFolder("alone/a")});
  fs::remove(inFolder("out/a/batch_item.json"));
  fs::remove_all(inFolder("out/b"));
  EXPECT_EQ(results("out"), results("alone"));
  // And it says how it would be done alone.
  const std::string command = jsonOf(inFolder("out/a/registration.json"))["command_line"];
  EXPECT_EQ(command, "agricolmap register " + files.uav() + " " + files.ugv() + " -o " +
                         inFolder("out/a") + " --prior " + files.prior());
}

TEST_F(BatchTest, ABadStripDoesNotStopTheOthers) {
  const std::string bad = write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  const ProgramResult result =
      batch(manifest(strip("a") + "  - {id: bad, map: field, file: " + bad + "}\n" +
                     strip("c", "other_field")),
            "out", {"--no-pictures"});
  EXPECT_EQ(result.exit_code, 12) << result.err;
  EXPECT_FALSE(fs::exists(inFolder("out/bad")));
  const nlohmann::json summary = jsonOf(inFolder("out/summary.json"));
  EXPECT_EQ(summary["counts"]["accepted"], 1);
  EXPECT_EQ(summary["counts"]["rejected"], 1);
  EXPECT_EQ(summary["counts"]["failed"], 1);
  EXPECT_EQ(summary["strips"][1]["id"], "bad");
  EXPECT_NE(std::string(summary["strips"][1]["message"]).find("bad.ply"), std::string::npos);
  EXPECT_NE(contentOf(inFolder("out/summary.csv")).find("\nbad,field,,failed,"), std::string::npos);
  EXPECT_TRUE(fs::exists(inFolder("out/c/registration.json")));
  // Of a single strip, the code is that of register.
  EXPECT_EQ(batch(inFolder("m.yaml"), "one", {"--no-pictures", "--item", "bad"}).exit_code, 3);
  EXPECT_EQ(batch(inFolder("m.yaml"), "one", {"--no-pictures", "--item", "3"}).exit_code, 10);
  EXPECT_EQ(batch(inFolder("m.yaml"), "one", {"--no-pictures", "--item", "a"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(inFolder("one/summary.csv")));
}

TEST_F(BatchTest, ShardsTogetherAreTheWhole) {
  const std::string file = manifest(strip("a") + strip("b", "other_field") + strip("c"));
  EXPECT_EQ(batch(file, "whole", {"--no-pictures", "--jobs", "3"}).exit_code, 10);
  EXPECT_EQ(batch(file, "parts", {"--no-pictures", "--shard", "2/2"}).exit_code, 10);
  EXPECT_EQ(entries("parts").count("a"), 0U);
  EXPECT_EQ(batch(file, "parts", {"--no-pictures", "--shard", "1/2", "--threads", "1"}).exit_code,
            0);
  EXPECT_EQ(results("parts"), results("whole"));
  // The summary of parts: the whole, of which all is done.
  const ProgramResult rest = batch(file, "parts", {"--no-pictures", "--resume"});
  EXPECT_EQ(rest.exit_code, 10);
  EXPECT_NE(rest.out.find("3 of 3 strips are done already"), std::string::npos) << rest.out;
  EXPECT_EQ(jsonOf(inFolder("parts/summary.json"))["counts"]["accepted"], 2);
}

TEST_F(BatchTest, ResumeDoesWhatIsMissingOrChanged) {
  const std::string file = manifest(strip("a") + strip("b"));
  EXPECT_EQ(batch(file, "out", {"--no-pictures", "--item", "a"}).exit_code, 0);
  expectFailure({"batch", file, "-o", inFolder("out"), "--no-pictures"}, 4,
                {"1 of the strips", "--resume", "--overwrite"});
  const auto stamp = [&](const std::string& id) {
    return fs::last_write_time(inFolder("out/" + id + "/registration.json"));
  };
  const auto first = stamp("a");
  EXPECT_EQ(batch(file, "out", {"--no-pictures", "--resume"}).exit_code, 0);
  EXPECT_EQ(stamp("a"), first);
  const auto second = stamp("b");
  write("out/b/notes.txt", "of an answer that goes");
  manifest(strip("a") + strip("b", "same_field", ", options: {grid: {cell: 0.03}}"));
  EXPECT_EQ(batch(file, "out", {"--no-pictures", "--resume"}).exit_code, 0);
  EXPECT_EQ(stamp("a"), first);
  EXPECT_NE(stamp("b"), second);
  EXPECT_EQ(jsonOf(inFolder("out/b/registration.json"))["options"]["grid"]["cell"], 0.03);
  EXPECT_FALSE(fs::exists(inFolder("out/b/notes.txt")));
}

TEST_F(BatchTest, AKillLeavesWholeFoldersAlone) {
  const std::string file = manifest(strip("a") + strip("b", "other_field") + strip("c"));
  EXPECT_EQ(batch(file, "whole", {"--no-pictures"}).exit_code, 10);
  const std::vector<std::string> words = {
      "batch", file, "-o", inFolder("out"), "--resume", "--no-pictures", "--jobs", "1"};
  for (const char* after : {"0.5", "1", "2"}) {
    runInShell(std::string("timeout -s KILL ") + after, words);
    for (const char* id : {"a", "b", "c"}) {
      const std::string folder = inFolder("out/") + id;
      if (fs::exists(folder)) {
        EXPECT_TRUE(fs::exists(folder + "/batch_item.json") &&
                    fs::exists(folder + "/registration.json"))
            << id;
      }
    }
  }
  EXPECT_EQ(runAgricolmap(words).exit_code, 10);
  EXPECT_EQ(results("out"), results("whole"));  // and nothing hidden is left
}

TEST_F(BatchTest, AnInterruptKeepsWhatIsDoneAndSaysHowToGoOn) {
  const std::string file = manifest(strip("a") + strip("b") + strip("c") + strip("d"));
  const ProgramResult result =
      runAgricolmap({"batch", file, "-o", inFolder("out"), "--no-pictures", "--jobs", "1", "-v"},
                    "1 of 4 strips");
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_NE(result.err.find("--resume does the rest"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::exists(inFolder("out/a/batch_item.json")));
  EXPECT_FALSE(fs::exists(inFolder("out/d")));
  EXPECT_EQ(batch(file, "out", {"--no-pictures", "--resume"}).exit_code, 0);
}

TEST_F(BatchTest, TheSummaryHasAPictureOfAllMaps) {
  EXPECT_EQ(
      batch(manifest(strip("a") + strip("b", "other_field"), "pictures: false\n"), "out").exit_code,
      10);
  EXPECT_EQ(contentOf(inFolder("out/summary.png")).substr(1, 3), "PNG");
  EXPECT_NE(contentOf(inFolder("out/summary.html")).find("<title>1 accepted, 1 rejected"),
            std::string::npos);
  EXPECT_EQ(entries("out/a"),
            (std::set<std::string>{"aligned.ply", "batch_item.json", "registration.json",
                                   "report.html", "transform.txt"}));
}

TEST_F(BatchTest, WhatIsNotOfABatchIsLeftAlone) {
  write("out/a/notes.txt", "mine");
  const std::string file = manifest(strip("a") + strip("b"));
  const ProgramResult result = batch(file, "out", {"--no-pictures", "--overwrite"});
  EXPECT_EQ(result.exit_code, 12) << result.err;
  EXPECT_EQ(entries("out/a"), (std::set<std::string>{"notes.txt"}));
  EXPECT_TRUE(fs::exists(inFolder("out/b/batch_item.json")));
}

TEST_F(BatchTest, MisuseIsToldBeforeAnythingIsDone) {
  const std::string file = manifest(strip("a"));
  const std::string out = inFolder("out");
  expectFailure({"batch"}, 2, {"MANIFEST", "-o"});
  expectFailure({"batch", file}, 2, {"-o"});
  expectFailure({"batch", inFolder("none.yaml"), "-o", out}, 3, {"none.yaml", "no such file"});
  expectFailure({"batch", inFolder(""), "-o", out}, 3, {"is a folder", "YAML"});
  expectFailure({"batch", file, "-o", write("taken", "mine")}, 4, {"taken: is a file"});
  EXPECT_EQ(contentOf(inFolder("taken")), "mine");
  EXPECT_EQ(entries().count("out"), 0U);
  expectFailure({"batch", file, "-o", out, "--shard", "3/2"}, 2, {"--shard 3/2"});
  expectFailure({"batch", file, "-o", out, "--shard", "0/2"}, 2, {"--shard 0/2"});
  expectFailure({"batch", file, "-o", out, "--shard", "1"}, 2, {"--shard 1"});
  expectFailure({"batch", file, "-o", out, "--item", "2"}, 2, {"--item 2", "--list"});
  expectFailure({"batch", file, "-o", out, "--item", "a", "--shard", "1/1"}, 2, {"together"});
  expectFailure({"batch", file, "-o", out, "--memory", "-1"}, 2, {});
  const std::string wrong = write("wrong.yaml", "maps: [{id: a, file: none.las}]\nstrip: []\n");
  expectFailure({"batch", wrong, "-o", out}, 2,
                {"wrong.yaml:1: ", "none.las", "wrong.yaml:2: ", "did you mean 'strips'"});
  EXPECT_EQ(run({"batch", file, "--list"}).out, "a\n");
}

}  // namespace
}  // namespace agricolmap::test
