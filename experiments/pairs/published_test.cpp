#include "experiments/pairs/published.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "experiments/pairs/guess.hpp"
#include "experiments/pairs/pair_maker.hpp"

namespace agricolmap::experiments {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const Eigen::Vector3d kFieldCorner(464000.0, 5257000.0, 500.0);

/// Points at the corners of `length` × 2 m.
Cloud corners(const Eigen::Vector3d& origin, float length) {
  Cloud cloud;
  cloud.origin = origin;
  cloud.xyz = {{0.0F, 0.0F, 0.0F}, {length, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {length, 2.0F, 0.2F}};
  cloud.rgb.assign(4, {40, 90, 30});
  return cloud;
}

/// Lays the row's cloud into the middle of the drone's, with the scales of a robot's odometry.
Eigen::Affine3d rowTruth() {
  return Eigen::Translation3d(kFieldCorner + Eigen::Vector3d(10.0, 0.5, 0.0)) *
         Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()) * Eigen::Scaling(1.02, 0.97, 1.0);
}

/// A folder as docs/published-data.md describes it, with one crop of two rows.
class PublishedFolder : public test::TempDir {
 public:
  explicit PublishedFolder(const std::string& crop = "Sugar Beet, 10 m") : crop_(crop) {
    cloud("uav", corners(kFieldCorner, 20.0F));
    cloud("ugv_row1", corners({0.0, 0.0, 0.0}, 4.0F));
    cloud("ugv_row2", corners({0.0, 0.0, 0.0}, 6.0F));
    truth(1, rowTruth());
  }
  void cloud(const std::string& folder, const Cloud& cloud) const {
    fs::create_directories(path() / crop_ / folder);
    io::writePly(path() / crop_ / folder / "point_cloud.ply", cloud);
  }
  void truth(int row, const Eigen::Affine3d& affine) const {
    io::writeMatrix(truthFile(row), affine);
  }
  fs::path truthFile(int row) const {
    return path() / crop_ / fmt::format("ugv_row{}", row) / "ground_truth.txt";
  }

 private:
  std::string crop_;
};

TEST(Published, EachPairIsACaseOfRealClouds) {
  const PublishedFolder folder;
  const std::vector<Case> cases = publishedCases({folder.path()});
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[0].name, "Sugar Beet- 10 m/ugv_row1") << "a comma would part the fields of a row";
  EXPECT_EQ(kindOf(cases[0].source), "real");

  PairMaker maker("/nowhere");
  EXPECT_EQ(maker.unavailable(cases[0]), "");
  EXPECT_THAT(maker.unavailable(cases[1]), HasSubstr("ugv_row2 has no truth"));
  const Pair pair = maker.make(cases[0], 80001);
  EXPECT_EQ(pair.fixed->size(), 4U);
  EXPECT_TRUE(pair.fixed->hasColour());
  EXPECT_EQ(pair.moving.filePoint(1).x(), 4.0);
  EXPECT_TRUE(pair.guess.isApprox(rowTruth(), 1e-12)) << "exact, scales included";
  EXPECT_TRUE(pair.truth.best_affine.isApprox(rowTruth(), 1e-12));
  EXPECT_TRUE(pair.truth.points.empty());
}

TEST(Published, SeedsVaryTheGuessOnTheSameClouds) {
  const PublishedFolder folder;
  const std::vector<Case> cases = publishedCases({folder.path()});
  PairMaker maker("/nowhere");
  const Pair one = maker.make(cases[0], 1);
  const Pair two = maker.make(cases[0], 2);
  EXPECT_EQ(one.fixed, two.fixed) << "read once";
  EXPECT_EQ(one.moving.xyz, two.moving.xyz);
  const AddedError error{5.0, 5.0, 0.0, 0.0};
  const Eigen::Affine3d first = wrongGuess("translation", error, 1, one.moving, one.guess);
  const Eigen::Affine3d second = wrongGuess("translation", error, 2, two.moving, two.guess);
  EXPECT_NEAR((first.translation() - one.guess.translation()).norm(), 5.0, 1e-6);
  EXPECT_NEAR((second.translation() - two.guess.translation()).norm(), 5.0, 1e-6);
  EXPECT_GT((first.translation() - second.translation()).norm(), 0.1);
  EXPECT_TRUE(first.linear().isApprox(one.guess.linear(), 1e-9));
}

TEST(Published, OtherDataOfTheSameNamesIsToldApart) {
  const PublishedFolder folder;
  const PublishedFolder copy;
  const auto text = [](const PublishedFolder& one) {
    return publishedCases({one.path()}).front().text();
  };
  const std::string before = text(folder);
  EXPECT_EQ(text(copy), before) << "wherever it lies";
  copy.truth(1, Eigen::Translation3d(0.01, 0.0, 0.0) * rowTruth());
  EXPECT_NE(text(copy), before) << "another truth";
  copy.truth(1, rowTruth());
  EXPECT_EQ(text(copy), before);
  Cloud larger = corners({0.0, 0.0, 0.0}, 4.0F);
  larger.xyz.emplace_back(1.0F, 1.0F, 0.0F);
  larger.rgb.emplace_back();
  copy.cloud("ugv_row1", larger);
  EXPECT_NE(text(copy), before) << "another cloud";
}

TEST(Published, WhatCannotBeComparedOnIsRefused) {
  const PublishedFolder folder;
  const PublishedFolder copy;
  test::expectError<InputError>(
      [&] {
        publishedCases({folder.path(), copy.path()});
      },
      {"both are the pair 'Sugar Beet- 10 m/ugv_row1'", copy.path().c_str(), "one folder"});

  PairMaker maker("/nowhere");
  folder.truth(1, rowTruth().inverse());
  test::expectError<InputError>([&] { maker.make(publishedCases({folder.path()}).front(), 1); },
                                {"ugv_row1/ground_truth.txt: lays the row's middle",
                                 "beside the drone's map", "x 464000.00 to 464020.00"});
}

/// A folder that only looks like one of the data set: its clouds are never read.
class Layout : public test::TempDir {
 public:
  void file(const std::string& name, const std::string& content) const {
    fs::create_directories((path() / name).parent_path());
    write(name, content);
  }
  void cloud(const std::string& folder) const { file(folder + "/point_cloud.ply", "ply\n"); }
};

void fails(const Layout& folder, std::initializer_list<const char*> parts) {
  test::expectError<InputError>([&] { publishedCases({folder.path()}); }, parts);
}

constexpr const char* kTruth = "1 0 0 5 0 1 0 6 0 0 1 7 0.1 0.2\n";

TEST(Published, CropsAndRowsInOrderOfTheirNames) {
  const Layout folder;
  for (const char* name : {"Wheat/Aerial", "Wheat/Row_2", "Wheat/ground1", "soy/mavic-uav",
                           "soy/mavic-ugv", "soy/.trash-ugv", "soy/something else"}) {
    folder.cloud(name);
  }
  folder.file("Wheat/Row_2/GroundTruth.TXT", kTruth);
  // Of an only row also one folder up.
  folder.file("soy/affine.txt", "1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  folder.file("Wheat/truth.txt", kTruth);
  folder.file("soy/mavic-ugv/readme.txt", "not a number");
  const std::vector<Case> cases = publishedCases({folder.path() / ""});
  ASSERT_EQ(cases.size(), 3U);
  EXPECT_EQ(cases[0].name, "Wheat/Row_2");
  EXPECT_EQ(cases[0].published->fixed_cloud, folder / "Wheat/Aerial/point_cloud.ply");
  EXPECT_EQ(cases[0].published->true_fixed_from_moving->translation(), Eigen::Vector3d(5, 6, 7));
  EXPECT_EQ(cases[1].name, "Wheat/ground1");
  EXPECT_FALSE(cases[1].published->truth_file);
  EXPECT_EQ(cases[2].name, "soy/mavic-ugv");
  EXPECT_EQ(cases[2].published->true_fixed_from_moving->translation(), Eigen::Vector3d(1, 2, 3));
  // A crop may be named itself.
  EXPECT_EQ(publishedCases({folder / "soy/"}).at(0).name, "soy/mavic-ugv");
}

TEST(Published, WhatIsNotThatLayoutIsRefused) {
  const Layout folder;
  test::expectError<InputError>([&] { publishedCases({folder / "nowhere"}); }, {"nowhere"});
  fails(folder, {"no pair of clouds", "'ugv_row1'"});
  folder.cloud("too/deep/a/crop/uav");
  fails(folder, {"no pair of clouds"});
  folder.cloud("beet/ugv_row1");
  fails(folder, {"beet: has 0 clouds of drones () and 1 of rows (ugv_row1)"});
  folder.cloud("beet/uav_10m");
  EXPECT_EQ(publishedCases({folder.path()}).size(), 1U);
  folder.cloud("beet/uav_20m");
  fails(folder, {"beet: has 2 clouds of drones (uav_10m, uav_20m) and 1 of rows"});
  const Layout lonely;
  lonely.cloud("beet/uav");
  fails(lonely, {"has 1 clouds of drones (uav) and 0 of rows"});
}

TEST(Published, TruthsOfTheWrongShape) {
  const Layout folder;
  folder.cloud("beet/uav");
  folder.cloud("beet/ugv_row1");
  folder.file("beet/ugv_row1/ground_truth.txt", "1 2 3\n");
  fails(folder, {"ugv_row1/ground_truth.txt", "3 numbers", "(16)", "(14)"});
  folder.file("beet/ugv_row1/ground_truth.txt", "1 0 0 5 0 1 0 six 0 0 1 7 0.1 0.2\n");
  fails(folder, {"ground_truth.txt", "line 1", "'six'"});
  folder.file("beet/ugv_row1/ground_truth.txt", kTruth);
  folder.file("beet/ugv_row1/affine.txt", kTruth);
  fails(folder, {"ugv_row1: 2 files may be the truth", "affine.txt, ground_truth.txt"});
}

}  // namespace
}  // namespace agricolmap::experiments
