// What is said of a whole field, of squares and of plots.
#include "agricolmap/crop/facts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/crop/test_crop.hpp"

namespace agricolmap::crop {
namespace {

TestField sownField() {
  TestField field;
  field.sow([](double) { return 0.0; }, 0.0, [](int row, int k) { return row == 1 && k == 2; });
  return field;
}

TEST(Facts, OfAFieldOfKnownPlants) {
  TestField field = sownField();
  // Two weeds of 6 cm across between rows, one within a row's reach is the crop's own leaf.
  field.disc({2.05, 2.75}, 0.03, 0.02);
  field.disc({5.05, 5.25}, 0.03, 0.02);
  const auto planted = static_cast<double>(field.plants.size());
  const FieldFacts facts = factsOf(field.view(), {0.0, 0.0}, {}, {});
  ASSERT_TRUE(facts.countable);
  EXPECT_NEAR(facts.total.plants, planted, 0.02 * planted);
  EXPECT_LE(facts.total.plants_low, planted);
  EXPECT_GE(facts.total.plants_high, planted);
  EXPECT_EQ(facts.total.gaps, 1U);
  EXPECT_EQ(facts.weeds.patches.size(), 2U);
  EXPECT_EQ(facts.total.patches, 2U);
  EXPECT_NEAR(facts.total.weeds * facts.total.between, 2.0 * 3.14 * 0.03 * 0.03, 0.002);
  EXPECT_NEAR(facts.total.area, 64.0, 0.1);
  EXPECT_NEAR(facts.total.cover, planted * 3.14 * 0.05 * 0.05 / 64.0, 0.01);
  EXPECT_NEAR(facts.total.height.middle, 0.1, 0.01);
  double by_rows = 0.0;
  for (const StandFacts& row : facts.per_row) by_rows += row.plants;
  EXPECT_NEAR(by_rows, facts.total.plants, 1.0);
  double by_squares = 0.0;
  for (const GridSquare& square : facts.grid) by_squares += square.facts.plants;
  EXPECT_NEAR(by_squares, facts.total.plants, 1.0);
}

TEST(Facts, OfPlotsAndOfSquaresOnRoundCoordinates) {
  const TestField field = sownField();
  const std::vector<Plot> plots = {{"west", {{0.0, 0.0}, {4.0, 0.0}, {4.0, 8.0}, {0.0, 8.0}}},
                                   {"none", {{20.0, 0.0}, {24.0, 0.0}, {24.0, 8.0}}}};
  FactsOptions options;
  options.grid = 2.0;
  const FieldFacts facts = factsOf(field.view(), {1001.0, 500.0}, plots, options);
  ASSERT_EQ(facts.per_plot.size(), 2U);
  const auto west =
      static_cast<double>(std::count_if(field.plants.begin(), field.plants.end(),
                                        [](const Eigen::Vector2d& p) { return p.x() < 4.0; }));
  EXPECT_NEAR(facts.per_plot[0].plants, west, 0.03 * west);
  EXPECT_NEAR(facts.per_plot[0].area, 32.0, 0.1);
  EXPECT_EQ(facts.per_plot[1].area, 0.0);
  EXPECT_TRUE(std::isnan(facts.per_plot[1].height.middle));
  // From 1000 to 1010 east and 500 to 508 north.
  EXPECT_EQ(facts.grid.size(), 5U * 4U);
  for (const GridSquare& square : facts.grid) {
    EXPECT_NEAR(std::remainder(square.corner.x() + 1001.0, 2.0), 0.0, 1e-9);
  }
}

TEST(Facts, OfBareSoilAreNone) {
  const TestField field;
  const FieldFacts facts = factsOf(field.view(), {0.0, 0.0}, {}, {});
  EXPECT_FALSE(facts.greenness.known());
  EXPECT_TRUE(facts.rows.rows.empty());
}

TEST(Facts, OfAViewWithoutHeightsThereAreNone) {
  TestField field = sownField();
  field.height = Raster<float>();
  const FieldFacts facts = factsOf(field.view(), {0.0, 0.0}, {}, {});
  EXPECT_TRUE(facts.countable);
  EXPECT_TRUE(std::isnan(facts.total.height.middle));
}

/// A field whose rows run from west to east, of which nothing is shown south of `y`; how many of
/// its plants stand on what is shown.
struct CutField {
  explicit CutField(double y) : field(sownField()) {
    const int cut = static_cast<int>(std::lround(y / field.frame.cell));
    for (int r = 0; r < cut; ++r) {
      for (int c = 0; c < field.frame.cols; ++c) {
        field.exg(r, c) = std::numeric_limits<float>::quiet_NaN();
      }
    }
    for (const Eigen::Vector2d& plant : field.plants) shown += plant.y() > y ? 1.0 : 0.0;
  }
  FieldFacts facts() const { return factsOf(field.view(), {0.0, 0.0}, {}, {}); }

  TestField field;
  double shown = 0.0;
};

// Rows lie on multiples of half a metre, plants are 10 cm across and about 40 are in a row.

TEST(Facts, ABorderBetweenRowsLeavesNoDoubt) {
  const CutField cut(2.25);
  const FieldFacts facts = cut.facts();
  ASSERT_TRUE(facts.countable);
  EXPECT_LE(facts.total.plants_low, cut.shown);
  EXPECT_GE(facts.total.plants_high, cut.shown);
  EXPECT_LT(facts.total.plants_high - facts.total.plants_low, 20.0);
}

TEST(Facts, ARowOfWhichLeavesAloneAreShownMayBeOnTheMap) {
  // Leaves of the row at 2.0 m reach 1 to 2 cm over the border: no row is found there.
  const CutField cut(2.035), between(2.25);
  const FieldFacts facts = cut.facts();
  ASSERT_TRUE(facts.countable);
  ASSERT_EQ(facts.rows.rows.size(), between.facts().rows.rows.size());
  EXPECT_NEAR(facts.total.plants, between.shown, 6.0);
  EXPECT_LE(facts.total.plants_low, cut.shown);
  EXPECT_GE(facts.total.plants_high, cut.shown + 35.0);
}

TEST(Facts, ARowThatRunsAlongTheBorderIsInDoubtBothWays) {
  // Of the row at 2.0 m two thirds are shown: it is found, and nobody knows where its stems are.
  const CutField cut(1.985), between(2.25);
  const FieldFacts facts = cut.facts();
  ASSERT_TRUE(facts.countable);
  ASSERT_EQ(facts.rows.rows.size(), between.facts().rows.rows.size() + 1);
  EXPECT_LE(facts.total.plants_low, between.shown);
  EXPECT_GE(facts.total.plants_high, between.shown + 36.0);
  std::size_t doubtful = 0;
  for (const StandFacts& row : facts.per_row) {
    doubtful += row.plants_high - row.plants_low > 20.0 ? 1U : 0U;
  }
  EXPECT_EQ(doubtful, 1U);
}

}  // namespace
}  // namespace agricolmap::crop
