#include "agricolmap/io/output/swapped_folder.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::expectError;
using test::TempDir;

void make(const fs::path& dir, const std::string& text) {
  SwappedFolder folder(dir);
  writeText(folder.path("sub/file.txt"), text);
  folder.commit();
}

TEST(SwappedFolder, TakesThePlaceOfTheOldOneAsAWhole) {
  const TempDir dir;
  make(dir / "a/map", "one");
  EXPECT_EQ(contentOf(dir / "a/map/sub/file.txt"), "one");
  dir.write("a/map/mine.txt", "notes");
  dir.write("a/map/old.tif", "layer");
  {
    SwappedFolder folder((dir / "a/map").string() + "/");
    writeText(folder.path("new.txt"), "two");
    folder.keep("sub/file.txt");
    folder.keepOthers([](const fs::path& name) { return name.extension() != ".tif"; });
    EXPECT_FALSE(fs::exists(dir / "a/map/new.txt"));
    folder.commit();
    EXPECT_THROW(folder.commit(), UsageError);
  }
  EXPECT_EQ(contentOf(dir / "a/map/new.txt"), "two");
  EXPECT_EQ(contentOf(dir / "a/map/sub/file.txt"), "one");
  EXPECT_EQ(contentOf(dir / "a/map/mine.txt"), "notes");
  EXPECT_FALSE(fs::exists(dir / "a/map/old.tif"));
  EXPECT_EQ(std::distance(fs::directory_iterator(dir / "a"), {}), 1);
}

TEST(SwappedFolder, WithoutCommitNothingChanges) {
  const TempDir dir;
  make(dir / "map", "one");
  {
    SwappedFolder folder(dir / "map");
    writeText(folder.path("sub/file.txt"), "two");
  }
  EXPECT_EQ(contentOf(dir / "map/sub/file.txt"), "one");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), {}), 1);
}

TEST(SwappedFolder, WhatAKilledRunLeftIsRemoved) {
  const TempDir dir;
  make(dir / "map", "one");
  const pid_t child = ::fork();
  if (child == 0) {
    SwappedFolder folder(dir / "map");
    writeText(folder.path("sub/file.txt"), "two");
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(contentOf(dir / "map/sub/file.txt"), "one");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), {}), 2);
  make(dir / "map", "three");
  EXPECT_EQ(contentOf(dir / "map/sub/file.txt"), "three");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), {}), 1);
}

TEST(SwappedFolder, WhatWasSetAsideComesBack) {
  const TempDir dir;
  make(dir / "map", "one");
  // As a run leaves it that was killed between two renames; the greatest of process numbers.
  fs::create_directories(dir / ".map.partial-4194304/new");
  fs::rename(dir / "map", dir / ".map.partial-4194304/old");
  { const SwappedFolder folder(dir / "map"); }
  EXPECT_EQ(contentOf(dir / "map/sub/file.txt"), "one");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), {}), 1);
}

TEST(SwappedFolder, OneRunAtATime) {
  const TempDir dir;
  make(dir / "map", "one");
  const SwappedFolder folder(dir / "map");
  expectError<OutputError>([&] { const SwappedFolder second(dir / "map"); },
                           {"map", "another run"});
}

TEST(SwappedFolder, AFileIsNoFolder) {
  const TempDir dir;
  dir.write("map", "");
  expectError<OutputError>([&] { const SwappedFolder folder(dir / "map"); }, {"map", "is a file"});
}

}  // namespace
}  // namespace agricolmap::io
