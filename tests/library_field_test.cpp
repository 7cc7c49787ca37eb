// Maps of a field and what stands on it, by the public headers and the shared libraries alone.
#include <gtest/gtest.h>

#include <agricolmap/error.hpp>
#include <agricolmap/field.hpp>
#include <agricolmap/io.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace agricolmap {
namespace {

const std::filesystem::path kStrips = std::filesystem::path(AGRICOLMAP_PAIRS) / "strips";

struct Field {
  Cloud drone = readCloud(kStrips / "uav/point_cloud.ply");
  LaidStrip strip;

  Field() {
    const Cloud robot = readCloud(kStrips / "ugv/point_cloud.ply");
    const Registration result = registerClouds(drone, robot, readMatrix(kStrips / "prior.txt"));
    EXPECT_TRUE(result.accepted());
    strip = laidStrip("monday", robot, result, 20260531);
  }
};

TEST(FuseClouds, GivesAStripItsPlaceInTheMap) {
  const Field field;
  EXPECT_LT(field.strip.plane_error_m, 0.05);
  EXPECT_LT(field.strip.height_error_m, 0.1);
  std::vector<std::string> steps;
  Control control;
  control.on_stage = [&](std::string_view step) { steps.emplace_back(step); };
  const FieldMap map = fuseClouds(field.drone, {field.strip}, {{"seam", "0.4"}}, control);
  const auto cells = static_cast<std::size_t>(map.rows) * static_cast<std::size_t>(map.cols);
  ASSERT_EQ(map.surface_m.size(), cells);
  ASSERT_EQ(map.strips.size(), 1U);
  const auto owned = std::count(map.source.begin(), map.source.end(), map.strips[0].source);
  EXPECT_GT(map.strips[0].owned_m2, 5.0);
  EXPECT_NEAR(static_cast<double>(owned) * map.cell_m * map.cell_m, map.strips[0].owned_m2, 1e-6);
  EXPECT_TRUE(map.has_heights);
  EXPECT_FALSE(steps.empty());
}

TEST(FuseClouds, RefusesWhatMakesNoSense) {
  const std::vector<Eigen::Vector3d> points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  const Cloud cloud = makeCloud(points);
  LaidStrip strip;
  strip.name = "monday";
  EXPECT_THROW(fuseClouds(cloud, {}), UsageError);
  EXPECT_THROW(fuseClouds(cloud, {strip}), UsageError);
  strip.cloud = std::make_shared<const Cloud>(cloud);
  EXPECT_THROW(fuseClouds(cloud, {strip, strip}), UsageError);
  EXPECT_THROW(fuseClouds(cloud, {strip}, {{"seem", "1"}}), UsageError);
  strip.plane_error_m = -1.0;
  EXPECT_THROW(fuseClouds(cloud, {strip}), UsageError);
  EXPECT_FALSE(fuseOptions().empty());
}

/// Plants 0.2 m apart in rows 0.5 m apart, 10 cm high.
Cloud drawnField() {
  std::vector<Eigen::Vector3d> points;
  std::vector<Rgb> colours;
  for (int row = 0; row < 400; ++row) {
    for (int col = 0; col < 600; ++col) {
      const Eigen::Vector2d at(0.01 * (col + 0.5), 0.01 * (row + 0.5));
      const double along = std::fmod(at.x(), 0.2) - 0.1;
      const double across = std::fmod(at.y(), 0.5) - 0.25;
      const bool green = std::hypot(along, across) < 0.045;
      const auto noise = static_cast<std::uint8_t>((7 * row + 3 * col) % 11);
      points.emplace_back(at.x() + 500000.0, at.y() + 5000000.0, green ? 80.1 : 80.0);
      colours.push_back(green ? Rgb{40, 160, 40} : Rgb{110, 95, 80});
      colours.back().r += noise;
      colours.back().b += noise;
    }
  }
  return makeCloud(points, colours, "field");
}

TEST(CropFacts, CountPlantsOfAFieldAndOfPlots) {
  const Cloud cloud = drawnField();
  const Eigen::Vector2d corner(500000.0, 5000000.0);
  const Plot plot{"corner",
                  {corner, corner + Eigen::Vector2d(3.0, 0.0), corner + Eigen::Vector2d(3.0, 1.0),
                   corner + Eigen::Vector2d(0.0, 1.0)}};
  const CropFacts facts = cropFacts(cloud, {}, {plot});
  EXPECT_TRUE(facts.countable);
  EXPECT_NEAR(facts.row_spacing_m, 0.5, 0.01);
  EXPECT_EQ(facts.rows.size(), 8U);
  EXPECT_EQ(facts.total.counted, 240U);
  ASSERT_EQ(facts.plants.size(), 240U);
  for (const CropFacts::Plant& plant : facts.plants) {
    EXPECT_NEAR(std::fmod(plant.place_m.x() - corner.x(), 0.2), 0.1, 0.02);
    EXPECT_NEAR(std::fmod(plant.place_m.y() - corner.y(), 0.5), 0.25, 0.02);
    EXPECT_NEAR(plant.height_m, 0.1, 0.01);
  }
  ASSERT_EQ(facts.plots.size(), 1U);
  EXPECT_NEAR(facts.plots[0].area_m2, 3.0, 0.1);
  EXPECT_EQ(facts.plots[0].counted, 30U);
  Plot elsewhere = plot;
  for (Eigen::Vector2d& corner : elsewhere.corners) corner.x() += 1000.0;
  EXPECT_THROW(cropFacts(cloud, {}, {elsewhere}), InputError);
  EXPECT_THROW(cropFacts(cloud, {}, {{"line", {corner, corner}}}), UsageError);
  EXPECT_THROW(cropFacts(FieldMap()), UsageError);
  EXPECT_FALSE(factsOptions().empty());
  std::stop_source stop;
  stop.request_stop();
  Control stopped;
  stopped.stop = stop.get_token();
  EXPECT_THROW(cropFacts(cloud, {}, {}, stopped), Interrupted);
}

}  // namespace
}  // namespace agricolmap
