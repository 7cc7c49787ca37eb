// What changed between maps, and many strips in one go, by the public headers alone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <agricolmap/batch.hpp>
#include <agricolmap/change.hpp>
#include <agricolmap/error.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace agricolmap {
namespace {

const std::filesystem::path kPairs = AGRICOLMAP_PAIRS;

/// A map of 4 m × 2 m whose surface is at `height`, 80 m above the file's zero; `rise`: of its
/// eastern half.
FieldMap levelMap(float height, float rise = 0.0F) {
  FieldMap map;
  map.rows = 20;
  map.cols = 40;
  map.cell_m = 0.1;
  map.file_from_cell =
      Eigen::Translation3d(500000.0, 5000000.0, 80.0) * Eigen::Scaling(map.cell_m, map.cell_m, 1.0);
  const std::size_t cells = 800;
  map.surface_m.assign(cells, height);
  for (std::size_t i = 0; i < cells; ++i) map.surface_m[i] += i % 40 >= 20 ? rise : 0.0F;
  map.plant_height_m = map.surface_m;
  map.cover.assign(cells, 1.0F);
  map.plane_error_m.assign(cells, 0.0F);
  map.height_error_m.assign(cells, 0.01F);
  map.source.assign(cells, 1);
  map.fixed = {"june.laz", 800, 0};
  map.crs = {"WGS 84 / UTM zone 32N", "PROJCRS[32]"};
  return map;
}

Plot plotAt(const std::string& name, double west) {
  const Eigen::Vector2d a(500000.0 + west, 5000000.0);
  return {name,
          {a, a + Eigen::Vector2d(1.0, 0.0), a + Eigen::Vector2d(1.0, 1.0),
           a + Eigen::Vector2d(0.0, 1.0)}};
}

TEST(DiffMaps, FindsWhatRoseOfTheFieldAndOfPlots) {
  DiffSettings settings;
  settings.plots = {plotAt("west", 0.5), plotAt("east", 2.5)};
  settings.grid_m = 1.0;
  const FieldChange found = diffMaps(levelMap(0.1F), levelMap(0.1F, 0.2F), settings);
  EXPECT_EQ(found.rows, 20);
  EXPECT_EQ(found.compared.cells, 800U);
  EXPECT_EQ(found.rise.cells, 400U);
  EXPECT_NEAR(found.rise.volume_m3, 0.2 * 4.0, 1e-5);
  EXPECT_LT(found.rise.volume_low_m3, found.rise.volume_m3);
  EXPECT_EQ(found.fall.cells, 0U);
  EXPECT_NEAR(found.detection_m[0], 1.96 * std::sqrt(2.0) * 0.01, 1e-6);
  EXPECT_EQ(found.significant[39], 1);
  ASSERT_EQ(found.plots.size(), 2U);
  EXPECT_FALSE(found.plots[0].more_than_errors);
  EXPECT_TRUE(found.plots[1].more_than_errors);
  EXPECT_NEAR(found.plots[1].plant_height->after - found.plots[1].plant_height->before, 0.2, 1e-6);
  EXPECT_EQ(found.squares.size(), 8U);
  ASSERT_TRUE(found.bare_ground);
  EXPECT_EQ(found.bare_ground->cells, 0U);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(DiffMaps, ReckonsWithWhatMapsStandOn) {
  FieldMap after = levelMap(0.1F);
  after.file_from_cell.translation().z() = 80.5;
  EXPECT_NEAR(diffMaps(levelMap(0.1F), after).compared.mean_m, 0.5, 1e-5);
  after = levelMap(0.1F);
  after.fixed.points = 7;
  EXPECT_EQ(diffMaps(levelMap(0.1F), after).warnings.size(), 1U);
  DiffSettings settings;
  settings.frame_error = MapError{.height_m = 0.05, .plane_m = 0.0};
  const FieldChange found = diffMaps(levelMap(0.1F), after, settings);
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_NEAR(found.median_detection_m, 1.96 * std::sqrt(2e-4 + 0.05 * 0.05), 1e-6);
}

TEST(DiffMaps, OfMapsWithoutHeightsComparesCovers) {
  FieldMap before = levelMap(0.0F), after = levelMap(0.0F);
  for (FieldMap* map : {&before, &after}) {
    map->has_heights = false;
    map->surface_m.assign(800, std::numeric_limits<float>::quiet_NaN());
  }
  std::ranges::fill(after.cover, 0.25F);
  const FieldChange found = diffMaps(before, after);
  EXPECT_FALSE(found.has_heights);
  EXPECT_NEAR(found.cover->after - found.cover->before, -0.75, 1e-6);
  EXPECT_TRUE(found.plant_height_change_m.empty());
  EXPECT_EQ(found.compared.cells, 0U);
}

TEST(DiffMaps, RefusesWhatMakesNoSense) {
  const FieldMap map = levelMap(0.1F);
  FieldMap other = map;
  other.crs = {"WGS 84 / UTM zone 33N", "PROJCRS[33]"};
  EXPECT_THROW(diffMaps(map, other), InputError);
  other = map;
  other.file_from_cell.translation().x() += 100.0;
  EXPECT_THROW(diffMaps(map, other), InputError);
  other = map;
  other.height_error_m.pop_back();
  EXPECT_THROW(diffMaps(map, other), UsageError);
  EXPECT_THROW(diffMaps(map, FieldMap()), UsageError);
  DiffSettings settings;
  settings.error_a = MapError{.height_m = -1.0, .plane_m = 0.0};
  EXPECT_THROW(diffMaps(map, map, settings), UsageError);
  settings = {};
  settings.plots = {plotAt("far", 100.0)};
  EXPECT_THROW(diffMaps(map, map, settings), InputError);
  settings.plots = {plotAt("torn", 0.5)};
  settings.plots[0].corners[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(diffMaps(map, map, settings), UsageError);
}

TEST(DiffMaps, SaysWhatItTakesOfCoordinateSystems) {
  const FieldMap map = levelMap(0.1F);
  FieldMap other = map;
  other.crs.wkt = "PROJCRS[32, in other words]";
  DiffSettings settings;
  EXPECT_EQ(diffMaps(map, other, settings).warnings.size(), 1U);
  settings.same_crs = true;
  EXPECT_TRUE(diffMaps(map, other, settings).warnings.empty());
  settings.same_crs = false;
  other.crs = {};
  EXPECT_EQ(diffMaps(map, other, settings).warnings.size(), 1U);
  EXPECT_TRUE(diffMaps(other, other, settings).warnings.empty());
}

TEST(RegisterBatch, MakesAFolderOfEachStrip) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("library_batch_" + std::to_string(::getpid()));
  const auto file = [](const char* name) { return (kPairs / "same_field" / name).string(); };
  BatchSettings settings;
  settings.pictures = false;
  settings.text = "maps: [{id: field, file: " + file("uav/point_cloud.ply") +
                  "}]\nstrips: [{id: a, file: " + file("ugv/point_cloud.ply") +
                  ", prior: " + file("prior.txt") + "}]\n";
  std::vector<std::string> told;
  const auto strips =
      registerBatch("manifest", folder, settings, {},
                    [&](const BatchStrip& strip, std::size_t done, std::size_t todo) {
                      told.push_back(strip.id + std::to_string(done) + std::to_string(todo));
                    });
  ASSERT_EQ(strips.size(), 1U);
  EXPECT_EQ(strips[0].status, Registration::Status::kAccepted);
  EXPECT_EQ(told, std::vector<std::string>{"a11"});
  EXPECT_TRUE(std::filesystem::exists(folder / "a/transform.txt"));
  EXPECT_TRUE(std::filesystem::exists(folder / "summary.csv"));
  EXPECT_THROW(registerBatch("manifest", folder, settings), OutputError);
  settings.resume = true;
  EXPECT_TRUE(registerBatch("manifest", folder, settings)[0].kept);
  settings.resume = false;
  settings.overwrite = true;
  // A listener's own failure is its caller's.
  const auto fails = [](const BatchStrip&, std::size_t, std::size_t) -> void {
    throw std::domain_error("enough");
  };
  EXPECT_THROW(registerBatch("manifest", folder, settings, {}, fails), std::domain_error);
  EXPECT_TRUE(std::filesystem::exists(folder / "a/transform.txt"));
  settings.shard = 3;
  EXPECT_THROW(registerBatch("manifest", folder, settings), UsageError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace agricolmap
