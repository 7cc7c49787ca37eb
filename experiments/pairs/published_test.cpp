#include "experiments/pairs/published.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/io/text/number_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap::experiments {
namespace {

using test::TempDir;
namespace fs = std::filesystem;

constexpr const char* kTruth = "1 0 0 5 0 1 0 6 0 0 1 7 0.1 0.2\n";

/// A folder that only looks like one of the data set: its clouds are never read.
class Folder : public TempDir {
 public:
  void file(const std::string& name, const std::string& content) const {
    fs::create_directories((path() / name).parent_path());
    write(name, content);
  }
  void cloud(const std::string& folder, const std::string& offset = "1 2 3 0 0 90\n") const {
    file(folder + "/point_cloud.ply", "ply\n");
    if (!offset.empty()) file(folder + "/offset.xyz", offset);
  }
};

void fails(const Folder& folder, std::initializer_list<const char*> parts) {
  test::expectError<InputError>([&] { findPublishedPairs(folder.path()); }, parts);
}

/// The published form of a truth.
std::string publishedTruth(const Eigen::Affine3d& affine) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index col = 0; col < 4; ++col) text += io::exactText(affine(row, col)) + ' ';
  }
  return text + "0.02 -0.03\n";
}

TEST(Published, ASimulatedPairInThatLayout) {
  simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
  options.field.width = options.field.height = 6.0;
  options.ugv.length = 3.0;
  options.seed = 7;
  const simulate::SimulatedPair made = simulate::simulatePair(options);
  const Folder folder;
  fs::create_directories(folder / "Sugar Beet 10m/UAV");
  fs::create_directories(folder / "Sugar Beet 10m/UGV_row1");
  io::writePly(folder / "Sugar Beet 10m/UAV/point_cloud.ply", made.uav);
  io::writePly(folder / "Sugar Beet 10m/UGV_row1/point_cloud.ply", made.ugv);
  io::writeOffset(folder / "Sugar Beet 10m/UAV/offset.xyz", Eigen::Affine3d::Identity());
  io::writeOffset(folder / "Sugar Beet 10m/UGV_row1/offset.xyz", made.prior);
  folder.file("Sugar Beet 10m/UGV_row1/affine_ground_truth.txt", publishedTruth(made.best_affine));

  const std::vector<PublishedPair> pairs = findPublishedPairs(folder.path());
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].crop, "Sugar Beet 10m");
  EXPECT_EQ(pairs[0].row, "UGV_row1");
  ASSERT_TRUE(pairs[0].world_from_fixed && pairs[0].world_from_moving);
  EXPECT_TRUE((*pairs[0].world_from_moving).isApprox(made.prior, 1e-9));
  ASSERT_TRUE(pairs[0].true_fixed_from_moving);
  // The truth lays the row's cloud, as read, where it belongs.
  const Cloud moving = io::readCloud(pairs[0].moving_cloud);
  EXPECT_EQ(io::readCloud(pairs[0].fixed_cloud).size(), made.uav.size());
  const evaluate::RegistrationErrors errors = evaluate::evaluateTransform(
      *pairs[0].true_fixed_from_moving, {made.best_affine, made.truth}, moving);
  EXPECT_LT(errors.rms, 0.03);
}

TEST(Published, RowsAndCropsInOrderTruthsByTheirNumber) {
  const Folder folder;
  folder.cloud("set/wheat/aerial", "");
  for (const char* row : {"ground_row_12", "ground_row_1", "ground_row_2"}) {
    folder.cloud(fmt::format("set/wheat/{}", row));
  }
  folder.file("set/wheat/GroundTruth-Row01.txt", kTruth);
  folder.file("set/wheat/ground_row_12_affine.txt", "1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  folder.file("set/wheat/readme.txt", "not a number");
  folder.cloud("soy/mavic-uav");
  folder.cloud("soy/mavic-ugv");
  folder.file("soy/truth.txt", kTruth);
  folder.cloud("soy/.trash-ugv");
  folder.cloud("soy/something else");
  const std::vector<PublishedPair> pairs = findPublishedPairs(folder.path() / "");
  ASSERT_EQ(pairs.size(), 4U);
  EXPECT_EQ(pairs[0].crop, "set/wheat");
  EXPECT_EQ(pairs[0].row, "ground_row_1");
  EXPECT_EQ(pairs[0].truth_file, folder / "set/wheat/GroundTruth-Row01.txt");
  EXPECT_EQ(pairs[0].true_fixed_from_moving->translation(), Eigen::Vector3d(5, 6, 7));
  EXPECT_FALSE(pairs[0].world_from_fixed);
  EXPECT_EQ(pairs[1].row, "ground_row_12");
  EXPECT_EQ(pairs[1].true_fixed_from_moving->translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(pairs[2].row, "ground_row_2");
  EXPECT_FALSE(pairs[2].truth_file);
  EXPECT_FALSE(pairs[2].true_fixed_from_moving);
  EXPECT_EQ(pairs[3].crop, "soy");
  EXPECT_EQ(pairs[3].fixed_cloud, folder / "soy/mavic-uav/point_cloud.ply");
  EXPECT_EQ(pairs[3].moving_cloud, folder / "soy/mavic-ugv/point_cloud.ply");
  EXPECT_EQ(pairs[3].truth_file, folder / "soy/truth.txt");
}

TEST(Published, CropsSideBySideAreToldApartByName) {
  const Folder folder;
  for (const char* name : {"mavic-uav-soybean", "mavic-uav-beet", "mavic-ugv-soybean-row1",
                           "mavic-ugv-beet-row1", "mavic-ugv-beet-row2"}) {
    folder.cloud(name);
  }
  folder.file("mavic-ugv-beet-row1_truth.txt", kTruth);
  const std::vector<PublishedPair> pairs = findPublishedPairs(folder.path());
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[0].crop, "mavic-beet");
  EXPECT_EQ(pairs[1].row, "mavic-ugv-beet-row2");
  EXPECT_EQ(pairs[1].fixed_cloud, folder / "mavic-uav-beet/point_cloud.ply");
  EXPECT_EQ(pairs[2].crop, "mavic-soybean");
  EXPECT_TRUE(pairs[0].truth_file);
  EXPECT_FALSE(pairs[1].truth_file);
  EXPECT_FALSE(pairs[2].truth_file);
}

TEST(Published, ACropMayBeNamedItself) {
  const Folder folder;
  folder.cloud("wheat/uav");
  folder.cloud("wheat/ugv");
  EXPECT_EQ(findPublishedPairs(folder / "wheat").at(0).crop, "wheat");
  EXPECT_EQ(findPublishedPairs(folder / "wheat/").at(0).crop, "wheat");
}

TEST(Published, WhatIsNotThatLayoutIsRefused) {
  const Folder folder;
  test::expectError<InputError>([&] { findPublishedPairs(folder / "nowhere"); }, {"nowhere"});
  fails(folder, {"no pair of clouds", "'ugv_row1'"});
  folder.cloud("too/deep/a/crop/uav");
  folder.cloud("too/deep/a/crop/ugv");
  fails(folder, {"no pair of clouds"});
  folder.cloud("beet/ugv_row1");
  fails(folder, {"beet: has rows (ugv_row1) and no cloud of a drone"});
  folder.cloud("beet/uav_10m");
  EXPECT_EQ(findPublishedPairs(folder.path()).size(), 1U);
  folder.cloud("beet/uav_20m");
  fails(folder, {"beet: has 2 clouds of drones (uav_10m, uav_20m)", "folder of its own"});
}

TEST(Published, ADroneWithoutRows) {
  const Folder folder;
  folder.cloud("beet/uav");
  fails(folder, {"beet/uav: no row belongs"});
}

TEST(Published, TruthsAndOffsetsOfTheWrongShape) {
  const Folder folder;
  folder.cloud("beet/uav");
  folder.cloud("beet/ugv_row1");
  folder.file("beet/ugv_row1/ground_truth.txt", "1 2 3\n");
  fails(folder, {"ugv_row1/ground_truth.txt", "3 numbers", "(16)", "(14)"});
  folder.file("beet/ugv_row1/ground_truth.txt", "1 0 0 5 0 1 0 six 0 0 1 7 0.1 0.2\n");
  fails(folder, {"ground_truth.txt", "line 1", "'six'"});
  folder.file("beet/ugv_row1/ground_truth.txt", kTruth);
  folder.file("beet/ugv_row1/affine.txt", kTruth);
  fails(folder, {"2 files may be the truth of the row 'ugv_row1'", "affine.txt, ground_truth.txt"});
  fs::remove(folder / "beet/ugv_row1/affine.txt");
  folder.cloud("beet/ugv_row2", "1 2\n");
  fails(folder, {"beet/ugv_row2/offset.xyz", "2 numbers"});
  folder.cloud("beet/ugv_row2");
  folder.file("beet/ground_truth.txt", kTruth);
  fails(folder, {"beet/ground_truth.txt: does not say which row", "'ugv_row1_ground_truth.txt'"});
}

}  // namespace
}  // namespace agricolmap::experiments
