// Clouds of other formats and coordinate systems than PLY in metres, as a user meets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

/// UTM zone 32, in feet.
constexpr const char* kFeet = "+proj=utm +zone=32 +datum=WGS84 +units=us-ft +no_defs";

class FormatsTest : public CliTest {
 protected:
  ProgramResult registerPair(const std::string& fixed, const std::string& moving,
                             std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"register", fixed, moving, "--no-pictures", "-o", inFolder("out")});
    more.emplace_back("--overwrite");
    return run(more);
  }
  double rms() const {
    return errorsOf(inFolder("out/transform.txt"), pair("georeferenced")).at("rms_m").get<double>();
  }
};

TEST_F(FormatsTest, LasIsRegisteredAsPly) {
  const PairFiles files = pair("georeferenced");
  const std::string uav = converted(files.uav(), "uav.las", {"--crs", "EPSG:32632"});
  const std::string ugv = converted(files.ugv(), "ugv.las", {"--crs", "EPSG:32632"});
  const ProgramResult result = registerPair(uav, ugv);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(entries("out"), (std::set<std::string>{"aligned.las", "registration.json",
                                                   "report.html", "transform.txt"}));
  EXPECT_LT(rms(), 0.03);
  EXPECT_NE(contentOf(inFolder("out/transform.txt"))
                .find("# p_fixed = M * p_moving, metres in "
                      "WGS 84 / UTM zone 32N"),
            std::string::npos);
  const nlohmann::json report = jsonOf(inFolder("out/registration.json"));
  EXPECT_EQ(report.at("fixed").at("crs").at("name"), "WGS 84 / UTM zone 32N");
  EXPECT_EQ(report.at("moving").at("points"), pointsOfPly(contentOf(files.ugv())).size());

  // The aligned cloud lies where transform.txt says, in the system of the fixed one.
  const ProgramResult info = run({"info", inFolder("out/aligned.las")});
  EXPECT_NE(info.out.find("system     WGS 84 / UTM zone 32N\n"), std::string::npos) << info.out;
  const auto moving = pointsOfPly(contentOf(files.ugv()));
  const auto aligned =
      pointsOfPly(contentOf(converted(inFolder("out/aligned.las"), "aligned.ply")));
  ASSERT_EQ(aligned.size(), moving.size());
  const auto& matrix = report.at("transform").at("matrix");
  for (const std::size_t i : {std::size_t{0}, moving.size() - 1}) {
    for (std::size_t row = 0; row < 3; ++row) {
      double expected = matrix[row][3].get<double>();
      for (std::size_t col = 0; col < 3; ++col) {
        expected += matrix[row][col].get<double>() * moving[i].xyz[col];
      }
      EXPECT_NEAR(aligned[i].xyz[row], expected, 0.0012);
    }
    EXPECT_EQ(aligned[i].rgb, moving[i].rgb);
  }
}

TEST_F(FormatsTest, AlignedCloudsComeInTheFormatThatIsAskedFor) {
  const PairFiles files = pair("georeferenced");
  registerPair(files.uav(), files.ugv(), {"--aligned-format", "pcd"});
  EXPECT_EQ(entries("out"), (std::set<std::string>{"aligned.pcd", "registration.json",
                                                   "report.html", "transform.txt"}));
  registerPair(files.uav(), files.ugv(), {"--aligned-format", "las"});
  EXPECT_EQ(
      entries("out"),  // the older one is gone
      (std::set<std::string>{"aligned.las", "registration.json", "report.html", "transform.txt"}));
  expectFailure(
      {"register", files.uav(), files.ugv(), "-o", inFolder("other"), "--aligned-format", "e57"}, 2,
      {"--aligned-format e57"});
}

TEST_F(FormatsTest, MovingIsBroughtToTheSystemOfFixed) {
  const PairFiles files = pair("georeferenced");
  const std::string uav = converted(files.uav(), "uav.las", {"--crs", "EPSG:32632"});
  const std::string ugv =
      converted(files.ugv(), "ugv.las", {"--crs", "EPSG:32632", "--to-crs", "EPSG:32633"});
  const ProgramResult result = registerPair(uav, ugv);
  EXPECT_NE(result.err.find("reprojected from WGS 84 / UTM zone 33N to WGS 84 / UTM zone 32N"),
            std::string::npos)
      << result.err;
  EXPECT_LT(rms(), 0.03);
  EXPECT_NE(contentOf(inFolder("out/transform.txt")).find("to which MOVING was reprojected"),
            std::string::npos);
}

TEST_F(FormatsTest, FeetAreMetresInTheEnd) {
  const PairFiles files = pair("georeferenced");
  auto points = pointsOfPly(contentOf(files.ugv()));
  for (PlyPoint& point : points) {
    for (double& value : point.xyz) value *= 3937.0 / 1200.0;
  }
  const std::string feet = write("feet.ply", plyBytes(points));
  const std::string uav = converted(files.uav(), "uav.las", {"--crs", "EPSG:32632"});
  const ProgramResult result = registerPair(uav, feet, {"--moving-crs", kFeet});
  EXPECT_NE(result.err.find("brought to metres"), std::string::npos) << result.err;
  EXPECT_LT(rms(), 0.03);
}

TEST_F(FormatsTest, EvaluateBringsCloudsToWhereTheTransformLeads) {
  const PairFiles files = pair("georeferenced");
  const std::string uav = converted(files.uav(), "uav.las", {"--crs", "EPSG:32632"});
  const std::string ugv =
      converted(files.ugv(), "ugv.las", {"--crs", "EPSG:32632", "--to-crs", "EPSG:32633"});
  registerPair(uav, ugv);
  const std::string errors = inFolder("errors.json");
  const auto rmsOf = [&](const std::string& transform, const std::string& moving,
                         const std::string& said, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"evaluate", transform, moving, "--truth-points", files.truthPoints(),
                               "-o", errors, "--overwrite"});
    const ProgramResult result = run(more);
    EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
    return jsonOf(errors).at("rms_m").get<double>();
  };
  const std::string reprojected = "33N to WGS 84 / UTM zone 32N";
  EXPECT_LT(rmsOf(inFolder("out/transform.txt"), ugv, reprojected), 0.03);

  // Without the report beside it nobody says where it leads.
  const std::string alone = write("alone.txt", contentOf(inFolder("out/transform.txt")));
  EXPECT_LT(rmsOf(alone, ugv, reprojected, {"--crs", "EPSG:32632"}), 0.03);
  auto points = pointsOfPly(contentOf(files.ugv()));
  for (PlyPoint& point : points) {
    for (double& value : point.xyz) value *= 3937.0 / 1200.0;
  }
  const std::string feet = write("feet.ply", plyBytes(points));
  write("feet.prj", kFeet);
  const std::vector<std::string> evaluate{"evaluate", alone, feet, "--truth-points",
                                          files.truthPoints()};
  expectFailure(evaluate, 3, {"feet.ply", "no system of metres", "--crs"});
  EXPECT_LT(rmsOf(alone, feet, "brought to metres", {"--crs", "EPSG:32632"}), 0.03);
  expectFailure({"evaluate", alone, files.ugv(), "--truth-points", files.truthPoints(), "--crs",
                 "EPSG:32632"},
                2, {"--crs would do nothing"});
}

TEST_F(FormatsTest, AMatrixIsNoCloud) {
  const std::string matrix = write("matrix.txt", "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n");
  const std::string cloud = write("a.ply", plyBytes(bumpySquare(1.0)));
  const std::string what = "matrix.txt: not a point cloud: it is a 4x4 matrix";
  expectFailure({"convert", matrix, inFolder("matrix.las")}, 3, {what});
  expectFailure({"info", matrix}, 3, {what});
  expectFailure({"register", cloud, matrix, "-o", inFolder("out")}, 3, {what});
}

TEST_F(FormatsTest, ASystemThatIsMissingIsSaid) {
  const PairFiles files = pair("georeferenced");
  const ProgramResult result =
      registerPair(files.uav(), files.ugv(), {"--fixed-crs", "EPSG:32632"});
  EXPECT_NE(result.err.find("does not say its coordinate system; taken as that of"),
            std::string::npos)
      << result.err;
  EXPECT_LT(rms(), 0.03);
}

TEST_F(FormatsTest, DegreesAndWebMercatorAreRefused) {
  const PairFiles files = pair("georeferenced");
  const auto refused = [&](const std::string& crs, const std::vector<std::string>& parts) {
    expectFailure({"register", files.uav(), files.ugv(), "-o", inFolder("none"), "--fixed-crs", crs,
                   "--moving-crs", crs},
                  3, parts);
  };
  refused("EPSG:4326", {"degrees", "EPSG:326<zone>"});
  refused("EPSG:3857", {"Pseudo-Mercator", "on the ground", "EPSG:326<zone>"});
  expectFailure(
      {"register", files.uav(), files.ugv(), "-o", inFolder("none"), "--fixed-crs", "somewhere"}, 2,
      {"'somewhere' is no coordinate system"});
}

TEST_F(FormatsTest, ProjWithoutItsDatabaseIsAnError) {
  const std::string cloud = write("a.ply", plyBytes(bumpySquare(1.0)));
  ::setenv("PROJ_LIB", inFolder("nothing").c_str(), 1);
  const ProgramResult result = runAgricolmap(
      {"convert", cloud, inFolder("a.las"), "--crs", "+proj=utm +zone=32 +datum=WGS84 +units=m"});
  ::unsetenv("PROJ_LIB");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("proj.db"), std::string::npos) << result.err;
}

TEST_F(FormatsTest, ConvertKeepsCoordinatesAndColours) {
  const std::string ply = write("a.ply", plyBytes(bumpySquare(1.0, 500000.0, 5400000.0)));
  const auto before = pointsOfPly(contentOf(ply));
  std::vector<std::string> formats{"las", "pcd"};
  const ProgramResult laz = runAgricolmap({"convert", ply, inFolder("b.laz"), "--quiet"});
  if (laz.exit_code == 0) {
    formats.emplace_back("laz");
  } else {
    EXPECT_NE(laz.err.find("liblaszip"), std::string::npos) << laz.err;
  }
  for (const std::string& format : formats) {
    const std::string there = converted(ply, "b." + format, {"--overwrite"});
    const std::string twice = converted(there, "c." + format);
    const auto back = pointsOfPly(contentOf(converted(twice, format + ".ply")));
    ASSERT_EQ(back.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(back[i].rgb, before[i].rgb);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(back[i].xyz[axis], before[i].xyz[axis], format == "pcd" ? 1e-6 : 0.000501);
      }
    }
  }
  expectFailure({"convert", ply, inFolder("a.e57")}, 2, {"a.e57", ".laz"});
  expectFailure({"convert", inFolder("none.las"), inFolder("b.xyz.ply")}, 3, {"none.las"});
  expectFailure({"convert", ply, inFolder("d.ply"), "--step", "2"}, 2, {"--step", "nothing"});
}

TEST_F(FormatsTest, AFewPointsFarOffAreNotTheSizeOfTheField) {
  std::vector<PlyPoint> points = bumpySquare(3.0);
  points.push_back({{2000.0, 1000.0, 3.0}, {1, 2, 3}});
  const ProgramResult far = run({"info", write("far.ply", plyBytes(points))});
  EXPECT_NE(far.out.find("extent     2000.00 x 1000.00"), std::string::npos) << far.out;
  EXPECT_NE(far.out.find("most of it 2.95 x 2.95 x "), std::string::npos) << far.out;
  EXPECT_NE(far.out.find("points per m2 of the area of most of it"), std::string::npos) << far.out;
  points.pop_back();
  const ProgramResult near_by = run({"info", write("near.ply", plyBytes(points))});
  EXPECT_EQ(near_by.out.find("most of it"), std::string::npos) << near_by.out;
  const std::string degrees =
      write("degrees.xyz", "9.1234567 47.2 400 1 2 3\n9.2 47.3 401 1 2 3\n");
  write("degrees.prj", "EPSG:4326");
  const ProgramResult global = run({"info", degrees});
  EXPECT_NE(global.out.find("x          9.1234567"), std::string::npos) << global.out;
  const std::vector<PlyPoint> sparse{{{0.0, 0.0, 0.0}, {1, 2, 3}}, {{10.0, 10.0, 1.0}, {1, 2, 3}}};
  const ProgramResult thin = run({"info", write("thin.ply", plyBytes(sparse))});
  EXPECT_NE(thin.out.find("density    0.02 points per m2"), std::string::npos) << thin.out;
}

TEST_F(FormatsTest, LinesOfTextAreRegistered) {
  const PairFiles files = pair("georeferenced");
  std::string text = "//X;Y;Z;R;G;B\n";
  for (const PlyPoint& point : pointsOfPly(contentOf(files.ugv()))) {
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(), "%.4f;%.4f;%.4f;%d;%d;%d\n", point.xyz[0], point.xyz[1],
                  point.xyz[2], point.rgb[0], point.rgb[1], point.rgb[2]);
    text += line.data();
  }
  std::replace(text.begin(), text.end(), '.', ',');
  registerPair(files.uav(), write("ugv.csv", text));
  EXPECT_LT(rms(), 0.03);
  expectFailure({"convert", files.ugv(), inFolder("ugv.xyz")}, 2, {"ugv.xyz", ".laz"});
}

TEST_F(FormatsTest, OffsetsThatArePassedByAreNamed) {
  const std::string cloud = write("field/field.ply", plyBytes(bumpySquare(3.0)));
  const std::string offset = write("field/field_offset.xyz", "500000 5400000 300\n");
  const ProgramResult info = run({"info", cloud});
  EXPECT_NE(info.out.find("passed by  " + offset), std::string::npos) << info.out;
  const ProgramResult result = runAgricolmap(
      {"register", cloud, cloud, "-o", inFolder("out"), "--no-pictures", "--overwrite"});
  EXPECT_NE(result.err.find(offset + " is passed by"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace agricolmap::test
