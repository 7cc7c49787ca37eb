#include "experiments/pairs/published_cases.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
    write(crop_ + "/uav/offset.xyz", "0 0 0\n");
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

TEST(PublishedCases, EachPairIsACaseOfRealClouds) {
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

TEST(PublishedCases, SeedsVaryTheGuessOnTheSameClouds) {
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

TEST(PublishedCases, OtherDataOfTheSameNamesIsToldApart) {
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

TEST(PublishedCases, WhatCannotBeComparedOnIsRefused) {
  const PublishedFolder folder;
  const PublishedFolder copy;
  test::expectError<InputError>([&] { publishedCases({folder / "nowhere"}); }, {"nowhere"});
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

}  // namespace
}  // namespace agricolmap::experiments
