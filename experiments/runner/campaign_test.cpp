#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "agricolmap/core/error.hpp"
#include "runner/campaign.hpp"
#include "runner/child_process.hpp"

namespace agricolmap::experiments {
namespace {

class RunnerTest : public ::testing::Test {
 protected:
  RunnerTest() {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  std::filesystem::path folder_;
};

Cloud squareCloud() {
  Cloud cloud;
  cloud.origin = {464000.0, 5257000.0, 500.0};
  cloud.xyz = {{0.0F, 0.0F, 0.0F}, {4.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {4.0F, 2.0F, 0.2F}};
  return cloud;
}

Row lostRow(const std::string& dataset, double setting, int seed, bool right = false) {
  Row row;
  row.dataset = dataset;
  row.kind = "simulated";
  row.experiment = "translation";
  row.setting = setting;
  row.seed = seed;
  row.method = "icp-affine";
  row.status = right ? "accepted" : "failed";
  row.accepted = row.correct = right;
  return row;
}

TEST_F(RunnerTest, GuessIsWrongByExactlyTheSettingAtTheMiddle) {
  const Cloud cloud = squareCloud();
  const Cell cell{"joint", 1.0, 5.0, 0.2, 0.3};
  const Eigen::Affine3d exact(Eigen::Translation3d(10.0, -20.0, 1.0));
  const Eigen::Affine3d guess = wrongGuess(cell, 7, cloud, exact);
  const Eigen::Vector3d middle = cloud.origin + Eigen::Vector3d(2.0, 1.0, 0.05);
  EXPECT_NEAR((guess * middle - exact * middle).norm(), 5.0, 1e-6);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(guess.linear() * exact.linear().transpose()));
  EXPECT_NEAR(turn.angle(), 0.2, 1e-9);
  EXPECT_TRUE(wrongGuess(cell, 7, cloud, exact).isApprox(guess, 0.0)) << "keyed, not drawn in turn";
  EXPECT_FALSE(wrongGuess(cell, 8, cloud, exact).isApprox(guess));
}

TEST_F(RunnerTest, ScaleErrorKeepsTheMiddleAndFarCoordinates) {
  Cloud cloud = squareCloud();
  const Cell cell{"accuracy", 0.3, 0.05, 0.01, 0.3};
  const Eigen::Affine3d scaled = scaleError(cell, 3, cloud);
  const Eigen::Vector3d middle = cloud.origin + Eigen::Vector3d(2.0, 1.0, 0.05);
  EXPECT_NEAR((scaled * middle - middle).norm(), 0.0, 1e-6);
  EXPECT_NEAR(std::abs(scaled.linear()(0, 0) - 1.0), 0.3, 1e-12);
  EXPECT_NEAR(std::abs(scaled.linear()(1, 1) - 1.0), 0.3, 1e-12);
  const Eigen::Vector3d before = cloud.filePoint(1);
  transformCloud(cloud, scaled);
  EXPECT_NEAR((cloud.filePoint(1) - scaled * before).norm(), 0.0, 1e-6);
}

TEST_F(RunnerTest, PriorIsThePapersOrWider) {
  EXPECT_EQ((Cell{"translation", 5.0, 5.0, 0.0, 0.3}.priorText()), "5,11.5,30");
  EXPECT_EQ((Cell{"translation", 10.0, 10.0, 0.0, 0.0}.priorText()), "10,11.5,30");
  EXPECT_EQ((Cell{"heading", 0.4, 0.0, 0.4, 0.0}.priorText()), "5,23,30");
}

TEST_F(RunnerTest, UnknownNamesListTheKnownOnes) {
  EXPECT_THROW(curvesOf("rotation", false), UsageError);
  try {
    chooseDataSets({"barley"}, Views::kDevelop, false);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("winter-wheat"));
  }
}

TEST_F(RunnerTest, FinalRunHasSettingsThatDevelopmentNeverSaw) {
  const auto develop = viewRanges(Views::kDevelop, PairSource::kSimulated);
  const auto final = viewRanges(Views::kFinal, PairSource::kSimulated);
  ASSERT_EQ(develop.size(), final.size());
  for (std::size_t i = 0; i < develop.size(); ++i) {
    ASSERT_EQ(develop[i].path, final[i].path);
    for (const double value : develop[i].values) {
      EXPECT_THAT(final[i].values, ::testing::Not(::testing::Contains(value))) << final[i].path;
    }
  }
  for (const DataSet& set : allDataSets(Views::kFinal, false)) {
    EXPECT_NO_THROW(set.pairs.optionsFor(3)) << set.name << ": a path that no option has";
  }
}

TEST_F(RunnerTest, RowsComeBackAndOtherVersionsAreRefused) {
  const std::filesystem::path path = folder_ / "rows.csv";
  Row row = lostRow("soybean", 0.25, 80001);
  row.errors.rms = 0.125;
  row.run_s = 1.5;
  row.note = "no plants, at all\nhere";
  {
    RowTable table(path, "version 1");
    table.append(row);
    EXPECT_THROW(RowTable(path, "version 1"), OutputError) << "in use";
  }
  std::ofstream(path, std::ios::app) << "soybean,simulated,trans";  // cut off by a crash
  {
    const RowTable table(path, "version 1");
    ASSERT_EQ(table.rows().size(), 1U);
    const Row* found = table.find(row.key());
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->errors.rms, 0.125);
    EXPECT_EQ(found->run_s, 1.5);
    EXPECT_EQ(found->note, "no plants; at all here");
    EXPECT_TRUE(std::isnan(found->first.matches));
  }
  EXPECT_THROW(RowTable(path, "version 2"), InputError);
}

TEST_F(RunnerTest, GivesUpOnlyAfterThreeLostSettingsAndSixLostRuns) {
  const Curve curve = curvesOf("translation", false).front();
  std::vector<Row> rows;
  for (const double setting : {0.25, 0.5, 1.0}) rows.push_back(lostRow("soybean", setting, 1));
  const auto lost = [&](const std::string& dataset) {
    return hopeless(rows, curve, 6, dataset, "simulated", "icp-affine");
  };
  EXPECT_FALSE(lost("soybean")) << "three runs are an anecdote";
  for (const double setting : {0.25, 0.5, 1.0}) rows.push_back(lostRow("soybean", setting, 2));
  EXPECT_TRUE(lost("soybean"));
  EXPECT_FALSE(lost("winter-wheat")) << "never tried there";
  rows.push_back(lostRow("sugar-beet-10m", 1.0, 1, true));
  EXPECT_FALSE(lost("soybean"));
}

TEST_F(RunnerTest, RigidMethodsAreNotTriedWhereTheScaleErrorAloneIsTooMuch) {
  EXPECT_FALSE(cannotBeRight("go-icp", {"translation", 1.0, 1.0, 0.0, 0.0}));
  EXPECT_TRUE(cannotBeRight("go-icp", {"accuracy", 0.05, 0.05, 0.01, 0.05}));
  EXPECT_TRUE(cannotBeRight("fpfh-gicp", {"joint", 1.0, 5.0, 0.2, 0.3}));
  EXPECT_FALSE(cannotBeRight("go-icp-oracle-scale", {"accuracy", 0.05, 0.05, 0.01, 0.05}));
  EXPECT_FALSE(cannotBeRight("icp-affine", {"accuracy", 0.05, 0.05, 0.01, 0.05}));
}

TEST_F(RunnerTest, ChildEndsAtItsLimitOrByItself) {
  const ChildResult slow = runChild({"/bin/sleep", "20"}, 0.2, folder_ / "log");
  EXPECT_TRUE(slow.timed_out);
  EXPECT_LT(slow.wall_s, 5.0);
  const ChildResult quick = runChild({"/bin/sh", "-c", "echo so; exit 3"}, 10.0, folder_ / "log");
  EXPECT_FALSE(quick.timed_out);
  EXPECT_EQ(quick.exit_code, 3);
  std::string word;
  std::ifstream(folder_ / "log") >> word;
  EXPECT_EQ(word, "so");
  EXPECT_THROW(runChild({"/no/such/program"}, 1.0, folder_ / "log"), OutputError);
}

}  // namespace
}  // namespace agricolmap::experiments
