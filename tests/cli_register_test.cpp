// What `agricolmap register` does with clouds that it can use.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

class RegisterTest : public CliTest {
 protected:
  using Turn = std::array<std::array<double, 3>, 3>;
  static std::array<double, 3> product(const Turn& turn, const std::array<double, 3>& p) {
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) result[i] += turn[i][k] * p[k];
    }
    return result;
  }
  /// The numbers of a matrix file, without its comments.
  static std::array<double, 16> matrixOf(const std::string& path) {
    std::istringstream lines(contentOf(path));
    std::array<double, 16> matrix{};
    std::size_t next = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('#')) continue;
      std::istringstream words(line);
      while (next < matrix.size() && words >> matrix[next]) ++next;
    }
    return matrix;
  }
  /// The text of `matrix` behind a turn about zero, or behind its inverse.
  static std::string times(const std::array<double, 16>& matrix, const Turn& turn, bool inverse) {
    std::ostringstream text;
    text.precision(17);
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t col = 0; col < 3; ++col) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
          sum += matrix[4 * row + k] * (inverse ? turn[col][k] : turn[k][col]);
        }
        text << sum << ' ';
      }
      text << matrix[4 * row + 3] << '\n';
    }
    return text.str();
  }
};

TEST_F(RegisterTest, FindsTheTruthAndWritesEveryFile) {
  const PairFiles files = pair();
  const ProgramResult result = runAgricolmap(
      {"register", files.uav(), files.ugv(), "-o", inFolder("out"), "--deform", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.rfind("accepted", 0), 0U) << result.out;
  EXPECT_EQ(entries("out"),
            (std::set<std::string>{"aligned.ply", "blocks.png", "exg_maps.png", "flow.png",
                                   "overlay_after.png", "overlay_before.png", "registration.json",
                                   "report.html", "transform.txt"}));
  const nlohmann::json errors = errorsOf(inFolder("out/transform.txt"), files);
  EXPECT_TRUE(errors.at("success").get<bool>()) << errors.dump();
  EXPECT_LT(errors.at("rms_m").get<double>(), 0.03);
  const nlohmann::json report = jsonOf(inFolder("out/registration.json"));
  EXPECT_EQ(report.at("status"), "accepted");

  // The aligned cloud is the moving cloud, moved by what transform.txt says.
  const auto moving = pointsOfPly(contentOf(files.ugv()));
  const auto aligned = pointsOfPly(contentOf(inFolder("out/aligned.ply")));
  ASSERT_EQ(aligned.size(), moving.size());
  const auto& matrix = report.at("transform").at("matrix");
  for (const std::size_t i : {std::size_t{0}, moving.size() / 2, moving.size() - 1}) {
    for (std::size_t row = 0; row < 3; ++row) {
      double expected = matrix[row][3].get<double>();
      for (std::size_t col = 0; col < 3; ++col) {
        expected += matrix[row][col].get<double>() * moving[i].xyz[col];
      }
      EXPECT_NEAR(aligned[i].xyz[row], expected, 1e-4);
    }
    EXPECT_EQ(aligned[i].rgb, moving[i].rgb);
  }
}

// Sensors write clouds in their own axes: z ahead, y down. The guess says so.
TEST_F(RegisterTest, AGivenAttitudeWorksAtAnyAngle) {
  const PairFiles files = pair();
  using Rows = std::array<std::array<double, 3>, 3>;
  for (const Rows& turn : {Rows{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}},   // y upright
                           Rows{{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}},   // x upright
                           Rows{{{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}}},  // x upright, y and z swapped
                           Rows{{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}}) {  // upside down
    std::vector<PlyPoint> points = pointsOfPly(contentOf(files.ugv()));
    for (PlyPoint& point : points) point.xyz = product(turn, point.xyz);
    const std::string turned = write("turned.ply", plyBytes(points));
    const std::string prior = write("turned.txt", times(matrixOf(files.prior()), turn, true));
    const ProgramResult result =
        runAgricolmap({"register", files.uav(), turned, "--prior", prior, "-o", inFolder("out"),
                       "--no-pictures", "--overwrite"});
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
    // Back in the axes of the file that the truth is for.
    const std::string back =
        write("back.txt", times(matrixOf(inFolder("out/transform.txt")), turn, false));
    EXPECT_LT(errorsOf(back, files).at("rms_m").get<double>(), 0.03);
  }
}

TEST_F(RegisterTest, GivesTheSameBytesOnOneThreadAndTwo) {
  const PairFiles files = pair();
  for (const std::string threads : {"1", "2"}) {
    const ProgramResult result =
        runAgricolmap({"register", files.uav(), files.ugv(), "-o", inFolder("out" + threads),
                       "--threads", threads, "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
  }
  for (const char* name : {"transform.txt", "aligned.ply", "overlay_after.png", "flow.png"}) {
    EXPECT_EQ(contentOf(inFolder("out1/") + name) == contentOf(inFolder("out2/") + name), true)
        << name;
  }
}

TEST_F(RegisterTest, TakesThePriorFromAFileOrFromOffsets) {
  const PairFiles files = pair();
  // Away from its offset.xyz a cloud stands where its coordinates say.
  std::filesystem::copy_file(files.uav(), inFolder("uav.ply"));
  std::filesystem::copy_file(files.ugv(), inFolder("ugv.ply"));
  ASSERT_EQ(runAgricolmap({"register", inFolder("uav.ply"), inFolder("ugv.ply"), "--prior",
                           files.prior(), "-o", inFolder("by_file"), "--no-pictures"})
                .exit_code,
            0);
  EXPECT_EQ(jsonOf(inFolder("by_file/registration.json")).dump().find("offset.xyz"),
            std::string::npos);
  EXPECT_EQ(entries("by_file"), (std::set<std::string>{"aligned.ply", "registration.json",
                                                       "report.html", "transform.txt"}));
  EXPECT_TRUE(errorsOf(inFolder("by_file/transform.txt"), files).at("success").get<bool>());

  // One offset per cloud, named after it, says the same.
  write("uav.offset.xyz", contentOf(files.folder / "uav/offset.xyz"));
  write("ugv.offset.xyz", contentOf(files.folder / "ugv/offset.xyz"));
  ASSERT_EQ(runAgricolmap({"register", inFolder("uav.ply"), inFolder("ugv.ply"), "-o",
                           inFolder("by_offset"), "--no-pictures"})
                .exit_code,
            0);
  EXPECT_TRUE(errorsOf(inFolder("by_offset/transform.txt"), files).at("success").get<bool>());
}

TEST_F(RegisterTest, TakesCoordinatesAsTheyStandWithoutAPrior) {
  const PairFiles files = pair("georeferenced");
  std::filesystem::copy_file(files.uav(), inFolder("uav.ply"));
  std::filesystem::copy_file(files.ugv(), inFolder("ugv.ply"));
  const ProgramResult result = runAgricolmap({"register", inFolder("uav.ply"), inFolder("ugv.ply"),
                                              "-o", inFolder("out"), "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(errorsOf(inFolder("out/transform.txt"), files).at("success").get<bool>());
}

TEST_F(RegisterTest, FindsTheStripWithoutAnyPrior) {
  const PairFiles files = pair();
  // Away from their offsets the clouds stand in coordinates of their own, kilometres apart.
  std::filesystem::copy_file(files.uav(), inFolder("uav.ply"));
  std::filesystem::copy_file(files.ugv(), inFolder("ugv.ply"));
  const ProgramResult result =
      runAgricolmap({"register", inFolder("uav.ply"), inFolder("ugv.ply"), "--prior-sigma", "none",
                     "-o", inFolder("out"), "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_TRUE(errorsOf(inFolder("out/transform.txt"), files).at("success").get<bool>());
}

TEST_F(RegisterTest, ThePriorsUncertaintyIsObeyed) {
  const PairFiles files = pair();
  const ProgramResult result = runAgricolmap({"register", files.uav(), files.ugv(), "--prior-sigma",
                                              "2,4.5,10", "-o", inFolder("out"), "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const nlohmann::json prior = jsonOf(inFolder("out/registration.json")).at("options").at("prior");
  EXPECT_DOUBLE_EQ(prior.at("translation").get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(prior.at("heading_deg").get<double>(), 4.5);
  EXPECT_DOUBLE_EQ(prior.at("scale").get<double>(), 0.1);
}

TEST_F(RegisterTest, RejectsTheStripOfAnotherField) {
  const PairFiles files = pair("other_field");
  const ProgramResult result =
      runAgricolmap({"register", files.uav(), files.ugv(), "-o", inFolder("out")});
  EXPECT_EQ(result.exit_code, 10) << result.err;
  EXPECT_EQ(result.out.rfind("rejected", 0), 0U) << result.out;
  const std::set<std::string> written = entries("out");
  EXPECT_TRUE(written.contains("registration.json"));
  EXPECT_FALSE(written.contains("transform.txt"));
  EXPECT_FALSE(written.contains("aligned.ply"));
  const nlohmann::json report = jsonOf(inFolder("out/registration.json"));
  EXPECT_EQ(report.at("status"), "rejected");
  EXPECT_FALSE(report.at("reasons").empty());
}

TEST_F(RegisterTest, KeepsARejectedTransformOnRequest) {
  const PairFiles files = pair("other_field");
  const ProgramResult result = runAgricolmap({"register", files.uav(), files.ugv(), "-o",
                                              inFolder("out"), "--no-pictures", "--keep-rejected"});
  EXPECT_EQ(result.exit_code, 10) << result.err;
  EXPECT_EQ(entries("out"), (std::set<std::string>{"aligned.ply", "registration.json",
                                                   "report.html", "transform.txt"}));
}

TEST_F(RegisterTest, LeavesOutPointsThatAreNotFinite) {
  const PairFiles files = pair();
  std::vector<PlyPoint> points = pointsOfPly(contentOf(files.ugv()));
  std::size_t spoilt = 0;
  for (std::size_t i = 0; i < points.size(); i += 500, ++spoilt) {
    points[i].xyz[i % 3] = (i / 500) % 2 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                              : std::numeric_limits<double>::infinity();
  }
  const std::string ugv = write("ugv.ply", plyBytes(points));
  const ProgramResult result =
      runAgricolmap({"register", files.uav(), ugv, "--prior", files.prior(), "-o", inFolder("out"),
                     "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(ugv), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(std::to_string(spoilt) + " points"), std::string::npos) << result.err;
  const nlohmann::json warnings = jsonOf(inFolder("out/registration.json")).at("warnings");
  ASSERT_EQ(warnings.size(), 1U) << warnings;
  EXPECT_NE(result.err.find(warnings[0].get<std::string>()), std::string::npos) << warnings;
  EXPECT_TRUE(errorsOf(inFolder("out/transform.txt"), files).at("success").get<bool>());
}

// Kept about it, the others would come in steps of half a metre.
TEST_F(RegisterTest, APlaceholderAtTheHeadOfAUtmCloudChangesNothing) {
  const PairFiles files = pair("georeferenced");
  const auto with_zero = [&](const std::string& path, const std::string& name) {
    std::vector<PlyPoint> points(1);
    for (const PlyPoint& point : pointsOfPly(contentOf(path))) points.push_back(point);
    return write(name, plyBytes(points));
  };
  const std::string clean[] = {files.uav(), files.ugv()};
  const std::string spoilt[] = {with_zero(files.uav(), "uav.ply"),
                                with_zero(files.ugv(), "ugv.ply")};
  const auto run = [&](const std::string& uav, const std::string& ugv, const std::string& out) {
    const ProgramResult result = runAgricolmap(
        {"register", uav, ugv, "--prior", files.prior(), "-o", inFolder(out), "--no-pictures"});
    EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
    return result;
  };
  run(clean[0], clean[1], "clean");
  EXPECT_NE(run(spoilt[0], clean[1], "uav").err.find("1 points were left out"), std::string::npos);
  EXPECT_NE(run(clean[0], spoilt[1], "ugv").err.find("1 points were left out"), std::string::npos);
  const std::string transform = contentOf(inFolder("clean/transform.txt"));
  EXPECT_EQ(contentOf(inFolder("uav/transform.txt")), transform);
  EXPECT_EQ(contentOf(inFolder("ugv/transform.txt")), transform);
  EXPECT_EQ(jsonOf(inFolder("ugv/registration.json")).at("moving").at("dropped_points"), 1);
}

// Beside the strip, where its bounds, its middle and the grid would go by them.
TEST_F(RegisterTest, FlyingPointsBesideTheStripChangeNothing) {
  const PairFiles files = pair();
  std::vector<PlyPoint> points = pointsOfPly(contentOf(files.ugv()));
  const PlyPoint middle = points[points.size() / 2];
  for (int i = 0; i < 20; ++i) {
    const double distance = 20.0 + 37.0 * i / 19.0;
    points.push_back({{middle.xyz[0] + distance * std::cos(0.9 * i),
                       middle.xyz[1] + distance * std::sin(0.9 * i), middle.xyz[2] + 1.5},
                      {120, 130, 90}});
  }
  const std::string ugv = write("ugv.ply", plyBytes(points));
  const ProgramResult result =
      runAgricolmap({"register", files.uav(), ugv, "--prior", files.prior(), "-o", inFolder("out"),
                     "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const nlohmann::json report = jsonOf(inFolder("out/registration.json"));
  EXPECT_EQ(report.at("moving").at("stray_points"), 20);
  EXPECT_EQ(report.at("moving").at("map").at("points").get<std::size_t>() + 20, points.size());
  EXPECT_EQ(report.at("fixed").at("stray_points"), 0);
  const nlohmann::json errors = errorsOf(inFolder("out/transform.txt"), files);
  EXPECT_TRUE(errors.at("success").get<bool>()) << errors.dump();
  EXPECT_LT(errors.at("rms_m").get<double>(), 0.03);
}

TEST_F(RegisterTest, UsesHeightsAloneWhenAsked) {
  const PairFiles files = pair();
  const std::string ugv =
      write("grey.ply", plyBytes(pointsOfPly(contentOf(files.ugv())), /*colours=*/false));
  const ProgramResult result =
      runAgricolmap({"register", files.uav(), ugv, "--prior", files.prior(), "--geometry-only",
                     "-o", inFolder("out")});
  // Heights of young beets may not be enough; an answer that is accepted must be right.
  ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 10) << result.err;
  if (result.exit_code == 0) {
    EXPECT_TRUE(errorsOf(inFolder("out/transform.txt"), files).at("success").get<bool>());
  }
  // The report says what was compared.
  const nlohmann::json report = jsonOf(inFolder("out/registration.json"));
  EXPECT_EQ(report.at("options").at("signal").at("term"), "height");
}

}  // namespace
}  // namespace agricolmap::test
