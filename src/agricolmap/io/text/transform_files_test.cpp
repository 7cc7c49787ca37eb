
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::TempDir;

TEST(OffsetFile, FollowsTheDocumentedConvention) {
  const TempDir dir;
  const auto apply = [&](const std::string& text, const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return readOffset(dir.write("offset.xyz", text)) * p;
  };
  EXPECT_TRUE(apply("# home\n500000.5 5000000 300 # m\n", {1, 2, 3})
                  .isApprox(Eigen::Vector3d(500001.5, 5000002, 303)));
  EXPECT_TRUE(apply("0 0 0 0 0 90\n", {1, 0, 0}).isApprox(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_TRUE(apply("0 0 0 0 90 0\n", {1, 0, 0}).isApprox(Eigen::Vector3d(0, 0, -1), 1e-12));
  EXPECT_TRUE(apply("0 0 0 90 0 0\n", {0, 1, 0}).isApprox(Eigen::Vector3d(0, 0, 1), 1e-12));
  // Roll first, yaw last: y -> z -> x (pitch) -> y (yaw).
  EXPECT_TRUE(apply("1, 1, 1, 90, 90, 90", {0, 1, 0}).isApprox(Eigen::Vector3d(1, 2, 1), 1e-12));
}

TEST(OffsetFile, RefusesMalformedFilesWithTheLine) {
  const TempDir dir;
  const auto refused = [&](const std::string& text, std::initializer_list<const char*> parts) {
    expectError<InputError>([&] { readOffset(dir.write("offset.xyz", text)); }, parts);
  };
  refused("1 2\n", {"line 1", "2 numbers"});
  refused("# a\n1 2 3 4\n", {"line 2", "4 numbers"});
  refused("1 2 north\n", {"line 1", "'north'"});
  refused("1 2 nan\n", {"line 1", "not finite"});
  refused("1 2 3\n4 5 6\n", {"line 2", "one line"});
  refused("# only a comment\n", {"0 numbers"});
  refused("", {"empty"});
  refused(std::string(100000, '1'), {"too long"});
}

TEST(OffsetFile, IsFoundBesideItsCloud) {
  const TempDir dir;
  EXPECT_FALSE(readOffsetBeside(dir / "field.ply").has_value());
  dir.write("offset.xyz", "1 0 0");
  EXPECT_EQ(readOffsetBeside(dir / "field.ply")->translation().x(), 1.0);
  dir.write("field.offset.xyz", "2 0 0");
  EXPECT_EQ(readOffsetBeside(dir / "field.ply")->translation().x(), 2.0);
  EXPECT_EQ(readOffsetBeside(dir / "other.ply")->translation().x(), 1.0);
}

TEST(OffsetFile, RoundTrips) {
  const TempDir dir;
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const double pitch = i == 0 ? 90.0 : i == 1 ? -90.0 : random.uniform(-90, 90);
    Eigen::Affine3d offset(Eigen::Translation3d(5e5 + random.uniform(), 5e6, 300.1));
    offset.rotate(Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(radians(pitch), Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d::UnitX()));
    writeOffset(dir / "offset.xyz", offset);
    const Eigen::Affine3d back = readOffset(dir / "offset.xyz");
    EXPECT_EQ(back.translation(), offset.translation());
    EXPECT_LT((back.linear() - offset.linear()).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_THROW(writeOffset(dir / "x", Eigen::Affine3d(Eigen::Scaling(1.1))), UsageError);
  expectError<OutputError>([&] { writeOffset("/dev/full", Eigen::Affine3d::Identity()); },
                           {"No space"});
}

TEST(MatrixFile, RoundTripsToTheBit) {
  const TempDir dir;
  Random random(4);
  Eigen::Affine3d m = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 4; ++col) m.matrix()(row, col) = random.normal() * (col == 3 ? 1e6 : 1);
  }
  writeMatrix(dir / "m.txt", m, "fixed_from_moving\nmetres");
  EXPECT_EQ(readMatrix(dir / "m.txt").matrix(), m.matrix());
  EXPECT_EQ(readTransform(dir / "m.txt").matrix(), m.matrix());
}

TEST(MatrixFile, BeginsWithItsNumbersAsOtherProgramsWantIt) {
  const TempDir dir;
  writeMatrix(dir / "m.txt", Eigen::Affine3d::Identity(), "fixed_from_moving\nmetres");
  EXPECT_EQ(test::contentOf(dir / "m.txt"),
            "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n# fixed_from_moving\n# metres\n");
}

TEST(MatrixFile, ToleratesBracketsAndChecksTheNumbers) {
  const TempDir dir;
  const auto read = [&](const std::string& text) { return readMatrix(dir.write("m.txt", text)); };
  EXPECT_EQ(read("[[1, 0, 0, 5],\r\n [0,2,0,6], # c\n [0,0,3,7], [0,0,0,1]]").translation(),
            Eigen::Vector3d(5, 6, 7));
  const auto refused = [&](const std::string& text, std::initializer_list<const char*> parts) {
    expectError<InputError>([&] { read(text); }, parts);
  };
  refused("1 0 0 0  0 1 0 0  0 0 1 0", {"12 numbers"});
  refused("1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1", {"last row", "5 6 7 1"});
  refused("1 0 0 0  0 1 0 0  0 0 0 0  0 0 0 1", {"determinant"});
  refused("1 0 0 0  0 inf 0 0  0 0 1 0  0 0 0 1", {"not finite"});
  refused("1 0 0 0  0 1e300 0 0  0 0 1e300 0  0 0 0 1", {"determinant"});
}

TEST(MatrixFile, ReadsThePublishedTruth) {
  const TempDir dir;
  const auto file = dir.write("truth.txt", "1 2 3 4 0 1 0 5 0 0 1 6 0.1 -0.05\n");
  const Eigen::Affine3d truth = readTransform(file);
  EXPECT_EQ(truth(0, 1), 2.0);
  EXPECT_EQ(truth.translation(), Eigen::Vector3d(4, 5, 6));
  expectError<InputError>([&] { readTransform(dir.write("t", "1 2 3")); }, {"3 numbers"});
}

TEST(MatrixFile, ReadsWhatPdalWrites) {
  const TempDir dir;
  const auto at = [&](const std::string& text) {
    return readMatrix(dir.write("m.json", text))(0, 3);
  };
  const std::string rows = "0 -1 0 7 1 0 0 8 0 0 1 9 0 0 0 1";
  EXPECT_EQ(
      at("{\"pipeline\": [{\"type\": \"filters.transformation\", \"matrix\": \"" + rows + "\"}]}"),
      7.0);
  EXPECT_EQ(at("[\"in.las\", {\"matrix\" : [[0,-1,0,7],[1,0,0,8],[0,0,1,9],[0,0,0,1]]}]"), 7.0);
  EXPECT_EQ(at("{\"stages\": {\"filters.icp\": {\"centroid\": \"1 2 3\", \"composed\": \" 0 -1 0 "
               "7\\n1 0 0 8\\n0 0 1 9\\n0 0 0 1\", \"transform\": \"1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 "
               "1\"}}}"),
            7.0);
  const auto refused = [&](const std::string& text, std::initializer_list<const char*> parts) {
    const auto path = dir.write("m.json", text);
    expectError<InputError>([&] { readMatrix(path); }, parts);
  };
  refused("{\"matrix\": \"" + rows + "\", \"b\": {\"matrix\": \"" + rows + "\"}}",
          {"m.json", "more than once"});
  refused("{\"matrix\": \"1 2 3\"}", {"m.json", "3 numbers"});
  refused("{\"matrix\": ", {"m.json"});
  refused("{\"type\": \"readers.las\"}", {"m.json", "JSON"});
}

TEST(OffsetFile, ReadsWhatOpenDroneMapWrites) {
  const TempDir dir;
  const auto file =
      dir.write("coords.txt", "WGS84 UTM 32N\n500000 5400000\n1.5 2.5 100\n2 3 100\n");
  EXPECT_EQ(readOffset(file).translation(), Eigen::Vector3d(500000, 5400000, 0));
  const auto damaged = dir.write("coords.txt", "WGS84 UTM 32N\n500000\n");
  expectError<InputError>([&] { readOffset(damaged); }, {"coords.txt", "line 2"});
}

TEST(OffsetFile, OthersThatArePassedByAreNamed) {
  const TempDir dir;
  const auto cloud = dir.write("field.ply", "");
  EXPECT_TRUE(offsetsPassedBy(cloud).empty());
  const std::vector<std::string> expected{dir.write("coords.txt", ""),
                                          dir.write("field_offset.xyz", ""),
                                          dir.write("other.offset.xyz", "")};
  dir.write("notes.txt", "");
  // That of a cloud beside it is no mistake.
  dir.write("robot.offset.xyz", "1 2 3\n");
  dir.write("robot.laz", "");
  EXPECT_EQ(offsetsPassedBy(cloud), expected);
  dir.write("field.offset.xyz", "1 2 3\n");
  EXPECT_TRUE(offsetsPassedBy(cloud).empty());
  EXPECT_TRUE(offsetsPassedBy("/nowhere/field.ply").empty());
}

}  // namespace
}  // namespace agricolmap::io
