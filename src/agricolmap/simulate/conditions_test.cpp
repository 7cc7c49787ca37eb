// What flights have and the presets have not: lean, ripening, trials, ground cover, stones, pieces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/simulate/assemble.hpp"
#include "agricolmap/simulate/field/mosaic_pieces.hpp"
#include "agricolmap/simulate/test_support.hpp"

namespace agricolmap::simulate {
namespace {

std::vector<Plant> plantsOf(const SimulationOptions& options) {
  const FieldModel field(options.crop, options.field, 5);
  return field.plantsIn(makeWindow({0.0, 0.0}, 0.0, 20.0, 20.0, 0.1), 1.0);
}

/// Only the crop, its rows running east from y = 10 m.
SimulationOptions bareOptions(Crop crop) {
  SimulationOptions options = cropPreset(crop);
  options.field.random_row_heading = false;
  options.field.weeds = options.field.straw = options.field.gaps = 0.0;
  return options;
}

/// Soil alone, as nearly as there is such a field.
SimulationOptions soilOptions() {
  SimulationOptions options = smallOptions();
  options.field.weeds = 0.0;
  options.field.plant_size = 0.1;
  return options;
}

TEST(Lean, GrowsWithHeightAndIsTheSameForAllPlants) {
  ViewOptions views;
  views.wind = 0.0;
  views.lean_deg = 10.0;
  const Visit flight = flightOf(views, 3);
  const Visit drive = driveOf(views, 4);
  EXPECT_NEAR(flight.lean.norm(), std::tan(radians(10.0)), 1e-12);
  EXPECT_GT((flight.lean - drive.lean).norm(), 1e-3);
  double lowest = 1e9;
  double highest = 0.0;
  for (Plant plant : plantsOf(bareOptions(Crop::kMaize))) {
    const Foliage foliage = growFoliage(plant, flight);
    for (int i = 0; i < foliage.count; ++i) {
      const Eigen::Vector2d shift =
          foliage.leaves[static_cast<std::size_t>(i)].shift.cast<double>();
      EXPECT_NEAR(shift.dot(flight.lean), shift.norm() * flight.lean.norm(), 1e-6);
      lowest = std::min(lowest, shift.norm() / flight.lean.norm());
      highest = std::max(highest, shift.norm() / flight.lean.norm());
    }
    plant.species = Species::kStone;
    EXPECT_LT(growFoliage(plant, flight).leaves[0].shift.norm(), 1e-6F);
  }
  // Leaves of maize above the soil [m].
  EXPECT_LT(lowest, 0.5);
  EXPECT_GT(highest, 0.9);
  EXPECT_LT(highest, 2.0);
}

TEST(Lean, ShiftsPlantsBetweenTheViews) {
  SimulationOptions options = smallOptions();
  options.views.leaf_unshared = 0.0;
  const double upright = correlation(options);
  options.views.lean_deg = 25.0;
  EXPECT_LT(correlation(options), upright - 0.1);
}

TEST(Ripening, TurnsLeavesYellowAndBrown) {
  SimulationOptions options = smallOptions(Crop::kSoybean);
  options.field.weeds = 0.0;
  options.views.ripening = 1.0;
  const SimulatedPair pair = simulatePair(options);
  // Yellow is green by Excess Green; its red is above its green.
  const auto redder = [](const Cloud& cloud) {
    double count = 0.0;
    for (const Rgb c : cloud.rgb) count += 2 * c.g - c.r - c.b > 25 && c.r > c.g ? 1.0 : 0.0;
    return count / static_cast<double>(cloud.size());
  };
  EXPECT_GT(greenShare(pair.uav), 0.2);
  EXPECT_LT(redder(pair.uav), 0.01);
  EXPECT_GT(redder(pair.ugv), 0.2);
  options.views.ripeness = 2.0;
  EXPECT_LT(greenShare(SimulatedField(options).uav()), 0.03);
}

TEST(Plots, HaveBareAlleysAndTheirOwnCrops) {
  SimulationOptions options = bareOptions(Crop::kSoybean);
  options.field.plots = {.length = 4.0, .alley = 1.0, .rows = 3, .gap_rows = 1, .mixed = 0.4};
  std::set<Species> species;
  std::set<int> along;
  std::set<int> rows;
  for (const Plant& plant : plantsOf(options)) {
    if (plant.position.x() < 0.0F || plant.position.x() >= 20.0F) continue;
    species.insert(plant.species);
    along.insert(static_cast<int>(plant.position.x() / 0.1F));
    rows.insert(static_cast<int>(std::floor((plant.position.y() - 10.0F) / 0.48F)));
  }
  EXPECT_EQ(species.size(), 4U);
  EXPECT_NEAR(static_cast<double>(along.size()), 160.0, 12.0);  // of 200
  for (const int row : rows) EXPECT_NE((row + 400) % 4, 3) << row;
}

TEST(Plots, DifferInSize) {
  SimulationOptions options = bareOptions(Crop::kSugarBeet10m);
  const auto spreadOf = [](const std::vector<Plant>& plants) {
    double sum = 0.0;
    double sum2 = 0.0;
    for (const Plant& plant : plants) {
      sum += std::log(static_cast<double>(plant.size));
      sum2 += std::pow(std::log(static_cast<double>(plant.size)), 2);
    }
    const auto n = static_cast<double>(plants.size());
    return std::sqrt(sum2 / n - sum * sum / (n * n));
  };
  const double even = spreadOf(plantsOf(options));
  options.field.plots = {.length = 3.0, .alley = 1.0, .rows = 2, .spread = 0.3};
  EXPECT_GT(spreadOf(plantsOf(options)), even + 0.05);
}

TEST(Satellite, SowsPlantsSideBySide) {
  SimulationOptions options = bareOptions(Crop::kSugarBeet10m);
  options.field.synchronous = true;
  options.field.plant_jitter = 0.02;
  const double spacing = options.field.plant_spacing;
  double sum2 = 0.0;
  const std::vector<Plant> plants = plantsOf(options);
  for (const Plant& plant : plants) {
    sum2 += std::pow(std::remainder(static_cast<double>(plant.position.x()) - 10.0, spacing), 2);
  }
  EXPECT_LT(std::sqrt(sum2 / static_cast<double>(plants.size())), 0.03 * spacing);
}

TEST(Soil, TextureOfItsOwnIsSharedByTheViews) {
  SimulationOptions options = soilOptions();
  options.views.leaf_unshared = 0.9;
  const double usual = correlation(options, &StripMap::grey);
  options.views.soil_kept = 1.0;
  EXPECT_GT(correlation(options, &StripMap::grey), usual + 0.05);
  options.views.soil_kept = 0.0;
  options.field.soil.stones = 40.0;
  EXPECT_GT(correlation(options, &StripMap::grey), usual + 0.05);
  options.field.soil.stones = 0.0;
  options.field.soil.tillage = 0.15;
  EXPECT_GT(correlation(options, &StripMap::grey), usual + 0.05);
}

TEST(Soil, ContrastMayDifferBetweenTheViews) {
  const auto deviation = [](const std::vector<Rgb>& colours) {
    double sum = 0.0;
    double sum2 = 0.0;
    for (const Rgb colour : colours) {
      sum += colour.g;
      sum2 += static_cast<double>(colour.g) * colour.g;
    }
    const auto n = static_cast<double>(colours.size());
    return std::sqrt(sum2 / n - sum * sum / (n * n));
  };
  SimulationOptions options = soilOptions();
  const SimulatedPair usual = simulatePair(options);
  options.views.soil_contrast = 2.0;
  const SimulatedPair wet = simulatePair(options);
  EXPECT_EQ(wet.uav.rgb, usual.uav.rgb);
  EXPECT_GT(deviation(wet.ugv.rgb), 1.2 * deviation(usual.ugv.rgb));
}

TEST(Soil, MayBeGreen) {
  SimulationOptions options = soilOptions();
  const double bare = greenShare(SimulatedField(options).uav());
  options.field.soil.cover = 0.5;
  const double half = greenShare(SimulatedField(options).uav());
  options.field.soil.cover = 1.0;
  EXPECT_LT(bare, 0.05);
  EXPECT_NEAR(half, 0.5, 0.2);
  EXPECT_GT(greenShare(SimulatedField(options).uav()), 0.95);
}

TEST(Visits, WeedsComeAndPlantsGo) {
  SimulationOptions options = smallOptions();
  options.field.gaps = 0.0;
  const SimulatedPair usual = simulatePair(options);
  options.views.plants_lost = 1.0;
  const SimulatedPair lost = simulatePair(options);
  EXPECT_EQ(lost.uav.rgb, usual.uav.rgb);
  EXPECT_LT(greenShare(lost.ugv), 0.2 * greenShare(usual.ugv));
  options.field.weeds = 60.0;
  options.views.weeds_new = 0.9;
  const SimulatedPair weedy = simulatePair(options);
  EXPECT_GT(greenShare(weedy.ugv), 5.0 * greenShare(lost.ugv));
  options.views.weeds_new = 0.0;
  EXPECT_GT(greenShare(SimulatedField(options).uav()), greenShare(weedy.uav) + 0.05);
}

TEST(Visits, PlantsGrowEachAsItLikes) {
  const std::vector<Plant> plants = plantsOf(bareOptions(Crop::kSugarBeet10m));
  VisitPlants even;
  VisitPlants uneven;
  uneven.growth_spread = 0.2;
  std::set<float> factors;
  for (const Plant& plant : plants) {
    const float factor =
        growFoliage(plant, uneven).leaves[0].length / growFoliage(plant, even).leaves[0].length;
    EXPECT_LE(static_cast<double>(factor), uneven.reach() + 1e-5);
    factors.insert(factor);
  }
  EXPECT_GT(factors.size(), plants.size() / 2);
  EXPECT_GT(*factors.rbegin(), 1.3F);
  EXPECT_LT(*factors.begin(), 0.75F);
}

TEST(Mosaic, OfOnePieceIsAsItWas) {
  const MosaicPieces one(MosaicOptions{}, {20.0, 20.0}, 3);
  EXPECT_FALSE(one.any());
  EXPECT_TRUE(one.displacement({4.0, 5.0}).isZero());
}

TEST(Mosaic, PiecesAreOffByWhatWasAsked) {
  MosaicOptions options;
  options.shift = 0.05;
  const MosaicPieces pieces(options, {200.0, 200.0}, 3);
  double sum2 = 0.0;
  std::set<double> shifts;
  for (double x = -5.0; x < 205.0; x += 1.0) {
    for (double y = -5.0; y < 205.0; y += 1.0) {
      const Eigen::Vector2d off = pieces.displacement({x, y});
      shifts.insert(off.x());
      sum2 += off.squaredNorm() / (2.0 * 210.0 * 210.0);
    }
  }
  EXPECT_NEAR(std::sqrt(sum2), 0.05, 0.008);
  EXPECT_NEAR(static_cast<double>(shifts.size()), std::pow(200.0 / options.piece, 2), 200.0);
}

TEST(Mosaic, TruthIsWhereThePiecesShowIt) {
  SimulationOptions options = smallOptions();
  options.ugv.drift = 0.0;
  options.views.leaf_unshared = 0.0;
  const SimulatedPair whole = simulatePair(options);
  options.uav.mosaic.piece = 2.0;
  options.uav.mosaic.shift = 0.10;
  const SimulatedPair pieced = simulatePair(options);
  EXPECT_EQ(pieced.ugv.xyz, whole.ugv.xyz);
  EXPECT_GT(rms(pieced, pieced.nominal), 0.05);
  EXPECT_GT(correlation(pieced, options), correlation(whole, options) - 0.1);
  SimulatedPair wrong = pieced;
  wrong.truth = whole.truth;
  EXPECT_LT(correlation(wrong, options), correlation(pieced, options) - 0.2);
}

TEST(Mosaic, PiecesMayBeSoftDoubledOrBright) {
  SimulationOptions options = smallOptions();
  options.uav.colour.noise = 0.0;
  const auto contrastOf = [&]() {
    const SimulatedPair pair = simulatePair(options);
    const StripMap map = mapFromAbove(pair, options);
    double sum = 0.0;
    for (int r = 0; r < map.rows; ++r) {
      for (int c = 1; c < map.cols; ++c) {
        if (map.count(r, c) == 0.0F || map.count(r, c - 1) == 0.0F) continue;
        sum += std::pow(static_cast<double>(map.grey(r, c) - map.grey(r, c - 1)), 2);
      }
    }
    return sum;
  };
  const double sharp = contrastOf();
  options.uav.mosaic.blur = 6.0;
  EXPECT_LT(contrastOf(), 0.85 * sharp);
  options.uav.mosaic.blur = 0.0;
  options.uav.mosaic.doubled = 1.0;
  options.uav.mosaic.doubled_shift = 0.15;
  EXPECT_LT(contrastOf(), 0.9 * sharp);
  options.uav.mosaic.doubled = 0.0;
  options.uav.mosaic.exposure = 0.3;
  options.uav.mosaic.piece = 3.0;
  const MosaicPieces pieces(options.uav.mosaic, {6.0, 6.0}, 1);
  EXPECT_NE(pieces.at({0.5, 0.5}).exposure, pieces.at({5.5, 5.5}).exposure);
}

}  // namespace
}  // namespace agricolmap::simulate
