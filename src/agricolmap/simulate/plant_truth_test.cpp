// The plants of a simulated field, listed one by one.
#include "agricolmap/simulate/field/plant_truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/simulate/test_support.hpp"

namespace agricolmap::simulate {
namespace {

std::size_t cropCount(const std::vector<TruePlant>& plants) {
  return static_cast<std::size_t>(
      std::count_if(plants.begin(), plants.end(), [](const TruePlant& p) { return !p.weed(); }));
}

TEST(PlantTruth, StandsInRowsInTheUavFile) {
  SimulationOptions options = smallOptions();
  options.field.random_row_heading = false;
  options.field.row_heading_deg = 0.0;
  options.field.gaps = 0.0;
  const SimulatedField field(options);
  const std::vector<TruePlant> plants = field.plants();
  // 12 rows of 6 m with a plant every 19 cm.
  EXPECT_NEAR(static_cast<double>(cropCount(plants)), 12.0 * 6.0 / 0.19, 12.0);
  EXPECT_GT(plants.size(), cropCount(plants));
  const Box3 box = boundingBox(field.uav());
  std::map<std::int64_t, std::set<int>> across;
  for (const TruePlant& plant : plants) {
    const Eigen::Vector3d local = plant.stem - field.uav().origin;
    EXPECT_GT(local.x(), static_cast<double>(box.min.x()) - 0.05);
    EXPECT_LT(local.x(), static_cast<double>(box.max.x()) + 0.05);
    EXPECT_NEAR(local.z(), 0.0, 0.3);
    EXPECT_GT(plant.radius, 0.01);
    if (plant.weed()) {
      EXPECT_EQ(plant.row, TruePlant::kNoRow);
    } else {
      EXPECT_GT(plant.height, 0.02);
      EXPECT_LT(plant.height, 0.35);
      across[plant.row].insert(static_cast<int>(std::floor(local.y() / 0.1)));
    }
  }
  EXPECT_GE(across.size(), 12U);
  // Rows wobble by centimetres, no more.
  for (const auto& [row, tens] : across) EXPECT_LE(*tens.rbegin() - *tens.begin(), 3);
}

TEST(PlantTruth, TheDroneSeesGreenWhereItSaysPlantsAre) {
  const SimulationOptions options = smallOptions();
  const SimulatedField field(options);
  const std::vector<TruePlant> plants = field.plants();
  int near = 0;
  int green = 0;
  for (std::size_t i = 0; i < field.uav().size(); ++i) {
    const Eigen::Vector3d point = field.uav().filePoint(i);
    const bool beside = std::any_of(plants.begin(), plants.end(), [&](const TruePlant& plant) {
      return !plant.weed() && (plant.stem - point).head<2>().norm() < 0.03;
    });
    if (!beside) continue;
    ++near;
    const Rgb c = field.uav().rgb[i];
    green += 2 * c.g - c.r - c.b > 25 ? 1 : 0;
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(green, 0.85 * near);
}

TEST(PlantTruth, LeavesOutWhatTheFlightDoesNotFindYet) {
  SimulationOptions options = smallOptions();
  options.field.weeds = 20.0;
  const auto weeds = [&] {
    const std::vector<TruePlant> plants = SimulatedField(options).plants();
    return plants.size() - cropCount(plants);
  };
  const auto all = static_cast<double>(weeds());
  EXPECT_NEAR(all, 20.0 * 36.0, 500.0);
  options.views.weeds_new = 0.5;
  EXPECT_NEAR(static_cast<double>(weeds()), 0.5 * all, 0.15 * all);
}

TEST(PlantTruth, FollowsThePiecesOfAMosaic) {
  SimulationOptions options = smallOptions();
  const std::vector<TruePlant> plain = SimulatedField(options).plants();
  options.uav.mosaic.shift = 0.1;
  const std::vector<TruePlant> moved = SimulatedField(options).plants();
  ASSERT_EQ(moved.size(), plain.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    farthest = std::max(farthest, (moved[i].stem - plain[i].stem).norm());
  }
  EXPECT_GT(farthest, 0.02);
  EXPECT_LT(farthest, 0.6);
}

TEST(PlantTruth, PlantsGrowWithTheirSize) {
  SimulationOptions options = smallOptions(Crop::kMaize);
  const auto tallest = [&] {
    double height = 0.0;
    for (const TruePlant& plant : SimulatedField(options).plants()) {
      height = std::max(height, plant.height);
    }
    return height;
  };
  const double tall = tallest();
  options.field.plant_size = 0.5;
  EXPECT_NEAR(tallest(), 0.5 * tall, 0.05 * tall);
}

}  // namespace
}  // namespace agricolmap::simulate
