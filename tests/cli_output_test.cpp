// Results appear whole or not at all, and replace nothing that nobody allowed to be replaced.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

using OutputTest = CliTest;

TEST_F(OutputTest, AFullFolderIsLeftAlone) {
  const PairFiles files = pair();
  write("out/notes.txt", "mine");
  write("out/transform.txt", "older");
  expectFailure({"register", files.uav(), files.ugv(), "-o", inFolder("out")}, 4,
                {inFolder("out"), "--overwrite"});
  EXPECT_EQ(contentOf(inFolder("out/transform.txt")), "older");
  expectFailure({"simulate", "-o", inFolder("out")}, 4, {inFolder("out"), "--overwrite"});
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(3.0)));
  const std::string unit = write("unit.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expectFailure(
      {"evaluate", unit, cloud, "--truth", unit, "-o", inFolder("out/notes.txt"), "--quiet"}, 4,
      {inFolder("out/notes.txt"), "--overwrite"});
  EXPECT_EQ(contentOf(inFolder("out/notes.txt")), "mine");
}

TEST_F(OutputTest, OverwriteReplacesResultsAndNothingElse) {
  const PairFiles files = pair();
  write("out/notes.txt", "mine");
  write("out/transform.txt", "older");
  write("out/overlay_after.png", "stale");
  const ProgramResult result = runAgricolmap({"register", files.uav(), files.ugv(), "-o",
                                              inFolder("out"), "--overwrite", "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // A picture of an earlier run would show another registration than the report.
  EXPECT_EQ(entries("out"), (std::set<std::string>{"aligned.ply", "notes.txt", "registration.json",
                                                   "report.html", "transform.txt"}));
  EXPECT_EQ(contentOf(inFolder("out/notes.txt")), "mine");
  EXPECT_NE(contentOf(inFolder("out/transform.txt")), "older");
}

TEST_F(OutputTest, ARejectionRemovesTheResultOfAnEarlierRun) {
  const PairFiles files = pair("other_field");
  write("out/transform.txt", "older");
  write("out/aligned.ply", "older");
  const ProgramResult result = runAgricolmap({"register", files.uav(), files.ugv(), "-o",
                                              inFolder("out"), "--overwrite", "--no-pictures"});
  ASSERT_EQ(result.exit_code, 10) << result.err;
  EXPECT_EQ(entries("out"), (std::set<std::string>{"registration.json", "report.html"}));
}

TEST_F(OutputTest, WhatIsSaidToAFullDiskIsAnError) {
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(3.0)));
  const std::vector<std::vector<std::string>> commands = {{"info", cloud},
                                                          {"document-options"},
                                                          {"register", "--dump-config"},
                                                          {"--help"},
                                                          {"--version"}};
  for (const std::vector<std::string>& command : commands) {
    const ProgramResult result = runInShell("", command, "> /dev/full");
    EXPECT_EQ(result.exit_code, 4) << command[0] << result.err;
    EXPECT_NE(result.err.find("standard output: cannot"), std::string::npos) << result.err;
  }
}

TEST_F(OutputTest, AFileSizeLimitLeavesNothingBehind) {
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(12.0)));
  const std::set<std::string> before = entries();
  for (const std::string name : {"big.las", "big.ply"}) {
    const ProgramResult result = runInShell("ulimit -f 100;", {"convert", cloud, inFolder(name)});
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("File too large"), std::string::npos) << result.err;
    EXPECT_EQ(entries(), before);
  }
}

TEST_F(OutputTest, BelowARegularFile) {
  const PairFiles files = pair();
  const std::string file = write("file", "text");
  expectFailure({"register", files.uav(), files.ugv(), "-o", file}, 4, {file});
  expectFailure({"register", files.uav(), files.ugv(), "-o", file + "/out"}, 4, {file});
  expectFailure({"simulate", "-o", file + "/out"}, 4, {file});
}

TEST_F(OutputTest, FullDisk) {
  const PairFiles files = pair();
  const std::string disk = inFolder("disk");
  std::filesystem::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=1m") != 0) {
    GTEST_SKIP() << "a small file system cannot be mounted here: " << std::strerror(errno);
  }
  struct Unmount {
    const std::string& disk;
    ~Unmount() { ::umount2(disk.c_str(), MNT_DETACH); }
  } const unmount{disk};
  // The message names the file as it would have been, not the hidden one.
  for (const std::string& out : {disk, disk + "/out"}) {
    expectFailure({"register", files.uav(), files.ugv(), "-o", out}, 4,
                  {out + "/aligned.ply: ", "No space left on device"});
    expectFailure({"register", files.uav(), files.ugv(), "-o", out, "--no-pictures"}, 4,
                  {out + "/aligned.ply: ", "No space left on device"});
  }
  expectFailure({"simulate", "--field.width", "8", "--field.height", "8", "--ugv.length", "3", "-o",
                 disk + "/pair"},
                4, {disk + "/pair/uav/point_cloud.ply: ", "No space left on device"});
}

TEST_F(OutputTest, AnInterruptLeavesNothing) {
  const PairFiles files = pair();
  // -v names the stages on stderr; the signal comes once the stage has begun.
  for (const std::string stage : {"level", "refine", "pictures"}) {
    const ProgramResult result = runAgricolmap(
        {"register", files.uav(), files.ugv(), "-o", inFolder("deep/out"), "-v"}, ": " + stage);
    EXPECT_EQ(result.exit_code, 130) << stage << "\n" << result.err;
    EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
    EXPECT_EQ(entries(), std::set<std::string>{}) << stage;
  }
  // What stood there before is as it was.
  write("out/transform.txt", "older");
  const ProgramResult result = runAgricolmap(
      {"register", files.uav(), files.ugv(), "-o", inFolder("out"), "--overwrite", "-v"},
      ": pictures");
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_EQ(entries(), (std::set<std::string>{"out", "out/transform.txt"}));
  EXPECT_EQ(contentOf(inFolder("out/transform.txt")), "older");
}

TEST_F(OutputTest, SimulationCanBeInterrupted) {
  const ProgramResult result =
      runAgricolmap({"simulate", "-o", inFolder("pair"), "-v"}, ": simulate");
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_EQ(entries(), std::set<std::string>{});
}

TEST_F(OutputTest, SimulationDrawsWhatItMade) {
  // The shared pairs were made without further flags.
  for (const std::string kind : {"same_field", "other_field"}) {
    const std::string png = contentOf(pair(kind).folder / "pair.png");
    EXPECT_EQ(png.substr(0, 4), "\x89PNG") << kind;
    EXPECT_GT(png.size(), 100000U) << kind;
  }
  // A picture of an earlier pair does not stay beside a later one.
  write("pair/pair.png", "older");
  const std::vector<std::string> small = {
      "simulate",      "--field.width", "8",  "--field.height", "8", "--ugv.length", "3",
      "--no-pictures", "--overwrite",   "-o", inFolder("pair")};
  ASSERT_EQ(runAgricolmap(small).exit_code, 0);
  EXPECT_EQ(entries("pair").count("pair.png"), 0U);
  EXPECT_EQ(entries("pair").count("truth.txt"), 1U);
}

TEST_F(OutputTest, SimulationWritesStripsAndPlantsOfOneField) {
  std::vector<std::string> field = {"simulate",
                                    "--field.width",
                                    "8",
                                    "--field.height",
                                    "8",
                                    "--ugv.length",
                                    "3",
                                    "--no-pictures",
                                    "--overwrite",
                                    "-o",
                                    inFolder("pair"),
                                    "--strips",
                                    "3"};
  ASSERT_EQ(runAgricolmap(field).exit_code, 0);
  const std::string first = contentOf(inFolder("pair/ugv/point_cloud.ply"));
  const std::string third = contentOf(inFolder("pair/ugv_3/point_cloud.ply"));
  EXPECT_NE(third, first);
  for (const std::string name : {"prior_2.txt", "truth_3.txt", "truth_points_2.ply",
                                 "ugv_2/offset.xyz", "ugv_3/path.txt", "truth_plants.csv"}) {
    EXPECT_EQ(entries("pair").count(name), 1U) << name;
  }
  const std::string plants = contentOf(inFolder("pair/truth_plants.csv"));
  EXPECT_TRUE(plants.starts_with("x,y,z,height,kind,row,radius\n")) << plants.substr(0, 80);
  EXPECT_NE(plants.find(",crop,1,"), std::string::npos);
  EXPECT_NE(plants.find(",weed,,"), std::string::npos);
  // One strip is what it was among several, and nothing of the others stays beside it.
  field.back() = "1";
  ASSERT_EQ(runAgricolmap(field).exit_code, 0);
  EXPECT_EQ(contentOf(inFolder("pair/ugv/point_cloud.ply")), first);
  EXPECT_EQ(entries("pair").count("truth_2.txt"), 0U);
  EXPECT_EQ(entries("pair").count("ugv_3/point_cloud.ply"), 0U);
}

}  // namespace
}  // namespace agricolmap::test
