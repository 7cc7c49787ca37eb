#include "agricolmap/io/output/staged_output.hpp"

#include <set>

#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::expectError;
using test::TempDir;

std::set<std::string> namesIn(const fs::path& dir) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(dir)) {
    names.insert(entry.path().lexically_relative(dir).string());
  }
  return names;
}

using Names = std::set<std::string>;

TEST(StagedOutput, AppearsWholeOnCommit) {
  const TempDir dir;
  {
    StagedOutput output(dir / "a/b/out/", false);
    writeText(output.path("one.txt"), "1");
    writeText(output.path("sub/two.txt"), "2");
    EXPECT_FALSE(fs::exists(dir / "a/b/out"));
    output.commit();
    EXPECT_THROW(output.commit(), UsageError);
    EXPECT_THROW(output.path("late"), UsageError);
  }
  EXPECT_EQ(namesIn(dir / "a/b"), (Names{"out", "out/one.txt", "out/sub", "out/sub/two.txt"}));
}

TEST(StagedOutput, LeavesNothingWithoutCommit) {
  const TempDir dir;
  const auto interrupted = [&] {
    StagedOutput output(dir / "a/b/out", false);
    writeText(output.path("one.txt"), "1");
    throw Interrupted();
  };
  EXPECT_THROW(interrupted(), Interrupted);
  EXPECT_TRUE(namesIn(dir.path()).empty());
  fs::create_directory(dir / "there");
  { StagedOutput output(dir / "there", false); }
  EXPECT_EQ(namesIn(dir.path()), Names{"there"});
}

TEST(StagedOutput, OverwritesOnlyOnRequestAndOnlyItsOwn) {
  const TempDir dir;
  fs::create_directory(dir / "out");
  dir.write("out/old.txt", "old");
  dir.write("out/stale.txt", "stale");
  dir.write("out/mine.txt", "mine");
  expectError<OutputError>([&] { StagedOutput(dir / "out", false); }, {"replaced"});
  StagedOutput output(dir / "out", true);
  writeText(output.path("old.txt"), "new");
  writeText(output.path("sub/more.txt"), "more");
  EXPECT_EQ(contentOf(dir / "out/old.txt"), "old");
  output.commit({"stale.txt", "old.txt", "never.txt"});
  EXPECT_EQ(contentOf(dir / "out/old.txt"), "new");
  EXPECT_EQ(namesIn(dir / "out"), (Names{"mine.txt", "old.txt", "sub", "sub/more.txt"}));
}

TEST(StagedOutput, UndoesACommitThatFailsHalfway) {
  const TempDir dir;
  fs::create_directories(dir / "out/b.txt");
  dir.write("out/a.txt", "old");
  {
    StagedOutput output(dir / "out", true);
    writeText(output.path("a.txt"), "new");
    writeText(output.path("b.txt"), "new");
    expectError<OutputError>([&] { output.commit(); }, {"b.txt", "folder"});
  }
  EXPECT_EQ(contentOf(dir / "out/a.txt"), "old");
  EXPECT_EQ(namesIn(dir / "out"), (Names{"a.txt", "b.txt"}));
}

TEST(StagedOutput, IgnoresWhatKilledRunsLeft) {
  const TempDir dir;
  fs::create_directories(dir / ("out/.out.partial-" + std::to_string(::getpid())));
  StagedOutput output(dir / "out", false);
  writeText(output.path("a"), "1");
  EXPECT_NO_THROW(output.commit());
  EXPECT_EQ(contentOf(dir / "out/a"), "1");
}

TEST(StagedOutput, RefusesImpossiblePlaces) {
  const TempDir dir;
  dir.write("file", "x");
  expectError<OutputError>([&] { StagedOutput(dir / "file", true); }, {"is a file"});
  expectError<OutputError>([&] { StagedOutput(dir / "file/out", true); }, {"file/out"});
  expectError<OutputError>([&] { StagedOutput("/proc/none/out", true); }, {"/proc/none"});
  expectError<OutputError>([&] { StagedOutput("", true); }, {"empty"});
  expectError<OutputError>([&] { StagedOutput("/", false); }, {"not usable"});
  EXPECT_EQ(contentOf(dir / "file"), "x");
  StagedOutput output(dir / "out", false);
  for (const char* name : {"", ".", "..", "../x", "/x", "a/../../x", "a/"}) {
    EXPECT_THROW(output.path(name), UsageError) << name;
  }
}

/// What `call` complains of, up to the first colon.
template <typename Call>
std::string placeInError(const Call& call) {
  try {
    call();
  } catch (const OutputError& error) {
    const std::string message = error.what();
    return message.substr(0, message.find(": "));
  }
  return "no error";
}

TEST(StagedOutput, ErrorsNameThePlaceAskedFor) {
  const TempDir dir;
  fs::create_directory(dir / "there");
  for (const fs::path& name : {dir / "there", dir / "new"}) {
    const StagedOutput output(name, false);
    // Neither a folder nor what lies below a file can be written as a file.
    fs::create_directory(output.path("a").file());
    writeText(output.path("b"), "1");
    EXPECT_EQ(placeInError([&] { writeText(output.path("a"), "1"); }), name / "a");
    EXPECT_EQ(placeInError([&] { writeText(output.folder() / "a", "1"); }), name / "a");
    EXPECT_EQ(placeInError([&] { output.path("b/c"); }), name / "b/c");
  }
}

TEST(StagedFile, ErrorsNameThePlaceAskedFor) {
  const TempDir dir;
  const StagedFile file(dir / "a.txt", false);
  fs::remove(file.path().file());
  fs::create_directory(file.path().file());
  EXPECT_EQ(placeInError([&] { writeText(file.path(), "1"); }), dir / "a.txt");
  fs::remove(file.path().file());
}

TEST(StagedOutput, FollowsLinks) {
  const TempDir dir;
  fs::create_directory(dir / "real");
  fs::create_directory_symlink(dir / "real", dir / "link");
  StagedOutput output(dir / "link", false);
  writeText(output.path("a"), "1");
  output.commit();
  EXPECT_TRUE(fs::is_symlink(dir / "link"));
  EXPECT_EQ(contentOf(dir / "real/a"), "1");
}

TEST(StagedOutput, ReplacesAllOfAFolderOnRequest) {
  const TempDir dir;
  fs::create_directory(dir / "out");
  dir.write("out/a", "old");
  dir.write("out/b", "old");
  {
    StagedOutput output(dir / "out", Existing::kReplace);
    writeText(output.path("a"), "new");
    EXPECT_EQ(namesIn(dir / "out"), (Names{"a", "b"}));
  }
  EXPECT_EQ(contentOf(dir / "out/a"), "old");
  StagedOutput output(dir / "out", Existing::kReplace);
  writeText(output.path("a"), "new");
  output.commit();
  EXPECT_EQ(namesIn(dir / "out"), Names{"a"});
  EXPECT_EQ(contentOf(dir / "out/a"), "new");
  EXPECT_EQ(namesIn(dir.path()), (Names{"out", "out/a"}));
}

TEST(StagedOutput, KnowsWhatAKilledRunHasLeft) {
  const TempDir dir;
  const StagedOutput output(dir / "row.1", false);
  const Names names = namesIn(dir.path());
  ASSERT_EQ(names.size(), 1U);
  EXPECT_EQ(targetOfHidden(*names.begin()), "row.1");
  for (const char* other : {"row.1", ".row", ".partial-1", ".row.partial-", ".row.partial-x", ""}) {
    EXPECT_EQ(targetOfHidden(other), "") << other;
  }
}

TEST(StagedFile, AppearsWholeOnCommit) {
  const TempDir dir;
  {
    StagedFile file(dir / "new/out.ply", false);
    writeText(file.path(), "1");
    EXPECT_FALSE(fs::exists(dir / "new/out.ply"));
    file.commit();
  }
  EXPECT_EQ(namesIn(dir / "new"), Names{"out.ply"});
  {
    StagedFile file(dir / "gone/out.ply", false);
    writeText(file.path(), "1");
  }
  EXPECT_FALSE(fs::exists(dir / "gone"));
}

TEST(StagedFile, OverwritesOnlyOnRequest) {
  const TempDir dir;
  dir.write("out", "old");
  expectError<OutputError>([&] { StagedFile(dir / "out", false); }, {"replaced"});
  { StagedFile file(dir / "out", true); }
  EXPECT_EQ(contentOf(dir / "out"), "old");
  StagedFile file(dir / "out", true);
  writeText(file.path(), "new");
  file.commit();
  EXPECT_EQ(contentOf(dir / "out"), "new");
}

TEST(StagedFile, RefusesImpossiblePlacesAndWritesDevicesStraight) {
  const TempDir dir;
  dir.write("file", "x");
  expectError<OutputError>([&] { StagedFile(dir.path(), true); }, {"is a folder"});
  expectError<OutputError>([&] { StagedFile(dir / "file/out", true); }, {"file/out"});
  StagedFile device("/dev/null", false);
  EXPECT_EQ(device.path().file(), "/dev/null");
  device.commit();
}

}  // namespace
}  // namespace agricolmap::io
