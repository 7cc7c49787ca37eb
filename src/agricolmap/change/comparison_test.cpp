#include "agricolmap/change/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace agricolmap::change {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
const GridFrame kGrid{{0.0, 0.0}, 0.1, 2, 4};

MapLayers layersWith(float height, float cover) {
  MapLayers layers;
  layers.heights = {Raster<float>(2, 4, height), Raster<float>(2, 4, 0.0F),
                    Raster<float>(2, 4, 0.01F), Raster<std::uint16_t>(2, 4, 1)};
  layers.plant_height = Raster<float>(2, 4, height);
  layers.cover = Raster<float>(2, 4, cover);
  return layers;
}

TEST(CompareMaps, SummarisesLayersWhereBothMapsHavePlants) {
  MapLayers before = layersWith(0.1F, 1.0F);
  MapLayers after = layersWith(0.3F, 1.0F);
  (*before.cover)[0] = 0.4F;         // no plants there
  (*after.plant_height)[0] = 9.0F;   // so that this is no plant's height
  (*after.plant_height)[1] = kNone;  // and this one is not known
  const Comparison found = compareMaps(before, after, 0.1, {}, false);
  ASSERT_TRUE(found.plant_height && found.cover);
  EXPECT_EQ(found.plant_height->cells, 6U);
  EXPECT_FLOAT_EQ(static_cast<float>(found.plant_height->after), 0.3F);
  EXPECT_EQ(found.cover->cells, 8U);
  EXPECT_NEAR(found.cover->before, (7.0 + 0.4) / 8.0, 1e-6);
  EXPECT_EQ(found.comparedCells(), 8U);
  EXPECT_NEAR(found.totals.rise.mean(), 0.2, 1e-6);
  EXPECT_TRUE(bareGroundWarning(found.totals).empty());  // there is none
}

TEST(CompareMaps, OfFlatMapsKnowsCoversAlone) {
  MapLayers before{noHeights(kGrid)};
  MapLayers after = before;
  before.cover = Raster<float>(2, 4, 0.2F);
  after.cover = Raster<float>(2, 4, 0.6F);
  (*after.cover)[3] = kNone;
  const Comparison found = compareMaps(before, after, 0.1, {}, true);
  EXPECT_FALSE(found.plant_height);
  EXPECT_EQ(found.totals.compared.cells, 0U);
  EXPECT_EQ(found.comparedCells(), 7U);
  EXPECT_NEAR(found.cover->after - found.cover->before, 0.4, 1e-6);
}

TEST(BareGroundWarning, SpeaksOfGroundThatMovedByMoreThanItsErrors) {
  const auto warningAt = [](float height) {
    return bareGroundWarning(
        compareMaps(layersWith(0.0F, 0.0F), layersWith(height, 0.0F), 0.1, {}, false).totals);
  };
  EXPECT_TRUE(warningAt(0.02F).empty());  // 1.96 · √2 · 1 cm is more
  EXPECT_NE(warningAt(0.04F).find("bare ground changed by 4.0 cm"), std::string::npos);
}

TEST(PartChanges, TellsPartsApartAndWhatIsNotKnown) {
  Raster<std::int32_t> zones(2, 4, -1);
  zones(0, 0) = zones(1, 0) = 0;
  zones(0, 1) = 1;
  MapLayers before = layersWith(0.1F, 1.0F);
  MapLayers after = layersWith(0.3F, 1.0F);
  after.heights.surface(0, 1) = kNone;
  (*after.cover)(0, 1) = kNone;
  (*before.cover)(1, 0) = 0.1F;  // soil, whose height is no plant's
  (*before.plant_height)(1, 0) = (*after.plant_height)(1, 0) = 0.0F;
  const Comparison found = compareMaps(before, after, 0.1, {}, false);
  const std::vector<PartChange> parts = partChanges(found, zones, 3);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_NEAR(parts[0].area, 0.02, 1e-12);
  EXPECT_TRUE(parts[0].moreThanErrors());
  EXPECT_NEAR(parts[0].level(), 1.96 * std::sqrt(2.0) * 0.01, 1e-6);
  EXPECT_NEAR(parts[0].cover.before, 0.55, 1e-6);
  EXPECT_EQ(parts[0].plant_height.cells, 1U);
  EXPECT_NEAR(parts[0].plant_height.after, 0.3, 1e-6);
  EXPECT_EQ(parts[1].area, 0.0);
  EXPECT_TRUE(std::isnan(parts[1].cover.before));
  EXPECT_EQ(parts[2].heights.compared.cells, 0U);
}

}  // namespace
}  // namespace agricolmap::change
