// Input that cannot be used: exit code 3, a message that names the file, and nothing left behind.
#include <gtest/gtest.h>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

class BadInputTest : public CliTest {
 protected:
  /// Expects `cloud` to be refused as the fixed and as the moving map.
  void expectRefused(const std::string& cloud, const std::vector<std::string>& parts) const {
    const std::string good = write("good.ply", plyBytes(bumpySquare(3.0)));
    std::vector<std::string> all = {cloud};
    all.insert(all.end(), parts.begin(), parts.end());
    expectFailure({"register", cloud, good, "-o", inFolder("results/out")}, 3, all);
    expectFailure({"register", good, cloud, "-o", inFolder("results/out")}, 3, all);
  }
};

TEST_F(BadInputTest, MissingFile) { expectRefused(inFolder("nowhere.ply"), {"No such file"}); }

TEST_F(BadInputTest, AFolder) {
  std::filesystem::create_directory(inFolder("folder.ply"));
  expectRefused(inFolder("folder.ply"), {});
}

TEST_F(BadInputTest, EmptyFile) { expectRefused(write("empty.ply", ""), {"empty"}); }

TEST_F(BadInputTest, NoCloudAtAll) {
  expectRefused(write("letter.txt", "Dear farmer,\n"), {"PLY", "PCD"});
  expectRefused(write("picture.ply", std::string("\x89PNG\r\n\x1a\n\0\0", 10)), {});
}

TEST_F(BadInputTest, TruncatedFiles) {
  const std::string whole = plyBytes(bumpySquare(3.0));
  expectRefused(write("half.ply", whole.substr(0, whole.size() / 2)), {});
  expectRefused(write("last_byte.ply", whole.substr(0, whole.size() - 1)), {});
  expectRefused(write("header.ply", whole.substr(0, 40)), {});
  expectRefused(write("no_points.ply", plyHeader(0)), {});
}

TEST_F(BadInputTest, CountsThatLie) {
  const std::string body = plyBytes(bumpySquare(3.0)).substr(plyHeader(3600).size());
  expectRefused(write("more.ply", plyHeader(3601) + body), {});
  expectRefused(write("huge.ply", plyHeader(1000000000000000000U) + body), {});
  expectRefused(write("negative.ply",
                      "ply\nformat ascii 1.0\nelement vertex -5\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\n"),
                {"line 3"});
}

TEST_F(BadInputTest, TypesAndListsThatLie) {
  const std::string begin = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n";
  expectRefused(write("type.ply", begin + "property triple x\nend_header\n"), {"triple"});
  expectRefused(write("no_z.ply", begin + "property float x\nproperty float y\nend_header\n" +
                                      std::string(16, '\0')),
                {});
  // A list whose length runs past the end of the file.
  expectRefused(write("list.ply", begin +
                                      "property list int int many\nproperty float x\n"
                                      "property float y\nproperty float z\nend_header\n" +
                                      std::string("\xff\xff\xff\x7f", 4) + std::string(60, '\1')),
                {});
  expectRefused(write("list_for_x.ply", begin +
                                            "property list uchar float x\nproperty float y\n"
                                            "property float z\nend_header\n" +
                                            std::string(60, '\1')),
                {});
  expectRefused(write("words.ply",
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\none two three\n"),
                {});
}

TEST_F(BadInputTest, NothingButPointsThatAreNotFinite) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\nnan 0 0\n0 inf 0\n";
  expectRefused(write("nan.ply", text), {});
}

TEST_F(BadInputTest, NoColours) {
  const std::string grey = write("grey.ply", plyBytes(bumpySquare(3.0), false));
  expectRefused(grey, {"no colours", "(it has x, y, z", "--geometry-only"});
}

TEST_F(BadInputTest, OnePoint) {
  expectRefused(write("one.ply", plyBytes({{{1.0, 2.0, 3.0}, {1, 2, 3}}})), {});
}

TEST_F(BadInputTest, AllPointsInOnePlace) {
  const std::vector<PlyPoint> points(1000, {{1.0, 2.0, 3.0}, {10, 200, 30}});
  expectRefused(write("heap.ply", plyBytes(points)), {});
}

TEST_F(BadInputTest, AllPointsOnOneLine) {
  std::vector<PlyPoint> points;
  for (int i = 0; i < 1000; ++i) points.push_back({{0.01 * i, 0.0, 0.0}, {10, 200, 30}});
  expectRefused(write("line.ply", plyBytes(points)), {});
}

TEST_F(BadInputTest, NoOverlapWhereThePriorLaysIt) {
  const std::string fixed = write("fixed.ply", plyBytes(bumpySquare(3.0)));
  const std::string moving = write("moving.ply", plyBytes(bumpySquare(2.0, 100000.0, 5.0)));
  expectFailure({"register", fixed, moving, "-o", inFolder("out")}, 3, {fixed, "prior"});
  const std::string near_by = write("near.ply", plyBytes(bumpySquare(2.0, 30.0, 5.0)));
  expectFailure({"register", fixed, near_by, "-o", inFolder("out")}, 3, {fixed, "prior"});
}

TEST_F(BadInputTest, FixedAndMovingSwapped) {
  const std::string wide = write("wide.ply", plyBytes(bumpySquare(12.0)));
  const std::string narrow = write("narrow.ply", plyBytes(bumpySquare(2.0)));
  expectFailure({"register", narrow, wide, "-o", inFolder("out")}, 3, {wide, narrow, "swapped"});
}

TEST_F(BadInputTest, PriorsThatAreNoMatrix) {
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(3.0)));
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"short.txt", "1 0 0 0\n0 1 0 0\n"},
      {"words.txt", "one two three\n"},
      {"nan.txt", "1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"},
      {"flat.txt", "1 0 0 0\n0 1 0 0\n0 0 0 0\n0 0 0 1\n"},
      {"projective.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n"},
  };
  for (const auto& [name, text] : cases) {
    const std::string prior = write(name, text);
    expectFailure({"register", cloud, cloud, "--prior", prior, "-o", inFolder("out")}, 3, {prior});
  }
  expectFailure({"register", cloud, cloud, "--prior", inFolder("none"), "-o", inFolder("out")}, 3,
                {inFolder("none")});
}

TEST_F(BadInputTest, OffsetsThatAreNone) {
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(3.0)));
  const std::string offset = write("offset.xyz", "1 2\n");
  expectFailure({"register", cloud, cloud, "-o", inFolder("out")}, 3, {offset});
}

TEST_F(BadInputTest, OtherVerbsSayItTheSameWay) {
  const std::string cloud = write("cloud.ply", plyBytes(bumpySquare(3.0)));
  const std::string none = inFolder("none");
  expectFailure({"info", none}, 3, {none});
  expectFailure({"import", none, none, "-o", inFolder("deep/cloud.ply")}, 3, {none});
  expectFailure({"evaluate", none, cloud, "--truth", none, "-o", inFolder("errors.json")}, 3,
                {none});
  const std::string truth = write("truth.txt", "1 2 3\n");
  const std::string unit = write("unit.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expectFailure({"evaluate", unit, cloud, "--truth", truth}, 3, {truth});
  const std::string few = write("few.ply", plyBytes(bumpySquare(1.0)));
  expectFailure({"evaluate", unit, cloud, "--truth-points", few}, 3, {few});
}

}  // namespace
}  // namespace agricolmap::test
