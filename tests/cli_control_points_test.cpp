// The truth from hand-picked pairs: from a spreadsheet to `evaluate --truth`.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

const std::string kHeader = "name,moving_x,moving_y,moving_z,fixed_x,fixed_y,fixed_z,use\n";

class ControlPointsTest : public CliTest {
 protected:
  /// Points of the shared pair's strip as if picked to the millimetre, one wrong, some to check.
  static std::string table() {
    const PairFiles files = pair();
    const std::vector<PlyPoint> strip = pointsOfPly(contentOf(files.ugv()));
    const std::string places = bodyOf(contentOf(files.truthPoints()));
    if (places.size() != strip.size() * sizeof(PlyPoint::xyz)) {
      throw std::runtime_error("truth_points.ply is not what 'simulate' writes");
    }
    std::string text = "# picked by the simulator\n" + kHeader;
    constexpr std::size_t kPicks = 20;
    for (std::size_t i = 0; i < kPicks; ++i) {
      const std::size_t at = strip.size() / kPicks * i + 17 * i;
      const std::array<double, 3>& q = strip.at(at).xyz;
      std::array<double, 3> p{};
      std::memcpy(p.data(), places.data() + at * sizeof(p), sizeof(p));
      if (i == 6) p[0] += 0.25;
      std::array<char, 256> line{};
      std::snprintf(line.data(), line.size(), "plant %zu,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%s\n", i,
                    q[0], q[1], q[2], p[0], p[1], p[2], i % 4 == 1 ? "check" : "");
      text += line.data();
    }
    return text;
  }

 private:
  static std::string bodyOf(const std::string& ply) {
    const std::string end = "end_header\n";
    return ply.substr(ply.find(end) + end.size());
  }
};

TEST_F(ControlPointsTest, ItsTruthGoesIntoEvaluate) {
  const PairFiles files = pair();
  const std::string pairs = write("pairs.csv", table());
  const ProgramResult result = runAgricolmap({"control-points", pairs, "-o", inFolder("truth")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("RMSE left out"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("set aside: plant 6;"), std::string::npos) << result.err;
  EXPECT_EQ(entries("truth"),
            (std::set<std::string>{"control_points.json", "residuals.csv", "truth.txt"}));

  const nlohmann::json report = jsonOf(inFolder("truth/control_points.json"));
  EXPECT_EQ(report["format"], "agricolmap-control-points");
  EXPECT_EQ(report["outliers"], nlohmann::json({"plant 6"}));
  EXPECT_EQ(report["control"]["count"], 14);
  EXPECT_EQ(report["check"]["count"], 5);

  // Good for measuring: near the truth, and `evaluate` takes it.
  EXPECT_LT(errorsOf(inFolder("truth/truth.txt"), files)["rms_m"], 0.02);
  const ProgramResult measured =
      runAgricolmap({"evaluate", files.prior(), files.ugv(), "--truth", inFolder("truth/truth.txt"),
                     "-o", inFolder("guess.json")});
  ASSERT_EQ(measured.exit_code, 0) << measured.err;
  EXPECT_NEAR(jsonOf(inFolder("guess.json"))["rms_m"].get<double>(),
              errorsOf(files.prior(), files)["rms_m"].get<double>(), 0.02);
}

TEST_F(ControlPointsTest, WithoutAFolderItOnlyPrints) {
  const std::string pairs = write("pairs.csv", table());
  const ProgramResult result = runAgricolmap({"control-points", pairs});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("plant 19"), std::string::npos) << result.out;
  EXPECT_EQ(entries(), std::set<std::string>{"pairs.csv"});
  const ProgramResult quiet = runAgricolmap({"control-points", pairs, "--quiet"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(ControlPointsTest, WhatCannotBeUsedLeavesNothing) {
  const std::string out = inFolder("truth");
  expectFailure({"control-points", inFolder("nowhere.csv"), "-o", out}, 3, {"nowhere.csv"});
  const std::string text = write("text.csv", kHeader + "a,1,2,x,4,5,6,\n");
  expectFailure({"control-points", text, "-o", out}, 3, {text, "line 2", "moving_z"});
  const std::string few = write("few.csv", kHeader + "a,1,2,3,4,5,6,\nb,2,2,3,5,5,6,\n");
  expectFailure({"control-points", few, "-o", out}, 3, {few, "2 control pairs", "needs 4"});
  expectFailure({"control-points", few, "--model", "magic"}, 2, {"magic"});
  expectFailure({"control-points"}, 2, {"PAIRS"});
  const std::string good = write("good.csv", table());
  write("truth/truth.txt", "older");
  expectFailure({"control-points", good, "-o", out}, 4, {out, "--overwrite"});
  EXPECT_EQ(contentOf(inFolder("truth/truth.txt")), "older");
  EXPECT_EQ(runAgricolmap({"control-points", good, "-o", out, "--overwrite"}).exit_code, 0);
  EXPECT_NE(contentOf(inFolder("truth/truth.txt")), "older");
}

}  // namespace
}  // namespace agricolmap::test
