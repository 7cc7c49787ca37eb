// Squares, their means, classes and what they need, on a plane that is turned against north.
#include "agricolmap/prescribe/plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "agricolmap/core/error.hpp"
#include "agricolmap/prescribe/test_earth.hpp"

namespace agricolmap::prescribe {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// 40 m × 30 m; the west is 0.1, the east, from 20 m on, 0.3.
GridFrame testFrame(double cell = 0.25) {
  return {
      {500000.0, 5300000.0}, cell, static_cast<int>(30.0 / cell), static_cast<int>(40.0 / cell)};
}

Raster<float> halves(const GridFrame& frame) {
  Raster<float> values(frame.rows, frame.cols);
  for (int row = 0; row < frame.rows; ++row) {
    for (int col = 0; col < frame.cols; ++col) {
      values(row, col) = (col + 0.5) * frame.cell < 20.0 ? 0.1F : 0.3F;
    }
  }
  return values;
}

Plan planOfHalves(const GridFrame& frame, Lattice lattice, const Earth& earth) {
  Raster<float> means = squareMeans(frame, halves(frame), lattice, earth, 0.5);
  EXPECT_TRUE(trim(lattice, means));
  return planOf(std::move(lattice), std::move(means), {0.2}, {100.0, 40.0}, rateUnit("kg/ha"),
                earth);
}

TEST(Rates, AreWholeStepsOfTheDataDictionary) {
  EXPECT_EQ(taskValue(150.0, rateUnit("L/ha")), 1500000);  // 0.01 mm³/m²
  EXPECT_EQ(rateUnit("L/ha").ddi, 1);
  EXPECT_EQ(taskValue(120.0, rateUnit("kg/ha")), 12000);  // mg/m²
  EXPECT_EQ(rateUnit("kg/ha").ddi, 6);
  EXPECT_EQ(taskValue(90000.0, rateUnit("seeds/ha")), 9000);  // 0.001/m²
  EXPECT_EQ(taskValue(9.0, rateUnit("seeds/m2")), 9000);
  EXPECT_EQ(rateUnit("seeds/m2").ddi, 11);
  EXPECT_EQ(taskValue(20.0, rateUnit("m3/ha")), 200000000);
  EXPECT_EQ(taskValue(2.5, rateUnit("t/ha")), 250000);
  // 10 US gallons per acre are 93.54 l/ha, 100 pounds 112.09 kg/ha.
  EXPECT_EQ(taskValue(10.0, rateUnit("gal/ac")), 935396);
  EXPECT_EQ(taskValue(100.0, rateUnit("lb/ac")), 11209);
  EXPECT_EQ(taskValue(0.0, rateUnit("lb/ac")), 0);
  EXPECT_NEAR(taskRate(935396, rateUnit("gal/ac")), 10.0, 1e-5);
}

TEST(Rates, ThatCannotBeSaidAreRefused) {
  EXPECT_THROW(taskValue(12.0, rateUnit("g/ha")), UsageError);  // by 10
  EXPECT_EQ(taskValue(20.0, rateUnit("g/ha")), 2);
  EXPECT_THROW(taskValue(-1.0, rateUnit("kg/ha")), UsageError);
  EXPECT_THROW(taskValue(std::nan(""), rateUnit("kg/ha")), UsageError);
  EXPECT_THROW(taskValue(300.0, rateUnit("m3/ha")), UsageError);  // beyond 31 bits
  EXPECT_THROW(rateUnit("kg"), UsageError);
  EXPECT_NEAR(amountOn(2500.0, 120.0, rateUnit("kg/ha")), 30.0, 1e-9);
  EXPECT_NEAR(amountOn(4046.8564224, 10.0, rateUnit("gal/ac")), 10.0, 1e-9);
}

TEST(Squares, CoverTheFieldNorthUpWhateverTheMapsNorth) {
  for (const double turn : {0.0, 0.03, -0.4}) {
    const Earth earth = testEarth(turn);
    const GridFrame frame = testFrame();
    const Lattice lattice = degreeLattice(frame, earth, 3.0, 5.0);
    EXPECT_DOUBLE_EQ(lattice.axes(0, 1), 0.0);
    const Eigen::Vector2d side =
        (lattice.axes.diagonal().array() * metresPerDegree(48.0).array()).matrix();
    EXPECT_NEAR(side.x(), 3.0, 1e-3);
    EXPECT_NEAR(side.y(), 5.0, 1e-3);
    for (const double number : {lattice.corner.x(), lattice.corner.y(), lattice.axes(0, 0)}) {
      EXPECT_NEAR(number * 1e9, std::round(number * 1e9), 1e-4);
    }
    const Plan plan = planOfHalves(frame, lattice, earth);
    EXPECT_NEAR(plan.area, 1200.0, 100.0);
    EXPECT_NEAR(plan.classes[0].area, 600.0, 90.0);
  }
}

TEST(Squares, HaveTheAreaThatTheyHaveOnTheEllipsoid) {
  // At 48° a degree is 74.625 km of longitude, 111.190 km of latitude (by PROJ).
  const Eigen::Vector2d scale = metresPerDegree(48.0);
  EXPECT_NEAR(scale.x(), 74625.35, 0.1);
  EXPECT_NEAR(scale.y(), 111190.33, 0.1);
  const Earth earth = testEarth(0.1);
  const Lattice north = degreeLattice(testFrame(), earth, 3.0, 5.0);
  for (const double area : squareAreas(north, earth)) EXPECT_NEAR(area, 15.0, 0.01);
  const Lattice turned = turnedLattice(testFrame(), 0.5, 3.0, 5.0);
  for (const double area : squareAreas(turned, earth)) EXPECT_NEAR(area, 15.0, 0.01);
  const std::vector<Eigen::Vector2d> ring = {north.at(2, 1), north.at(2, 4), north.at(6, 4),
                                             north.at(6, 1)};
  const std::vector<Eigen::Vector2d> hole = {north.at(3, 2), north.at(4, 2), north.at(4, 3),
                                             north.at(3, 3)};
  EXPECT_NEAR(polygonArea(ring, {hole}), 11.0 * 15.0, 0.02);
}

TEST(Squares, OfAHeadingLieAlongIt) {
  const Earth earth = testEarth(0.02);
  const GridFrame frame = testFrame();
  const Lattice lattice = turnedLattice(frame, 0.5, 3.0, 6.0);
  EXPECT_NEAR((lattice.axes.col(0) - 6.0 * Eigen::Vector2d(std::cos(0.5), std::sin(0.5))).norm(),
              0.0, 1e-9);
  EXPECT_NEAR(lattice.axes.col(1).norm(), 3.0, 1e-9);
  const Plan plan = planOfHalves(frame, lattice, earth);
  EXPECT_NEAR(plan.area, 1200.0, 120.0);
  // The task file has the same in smaller cells north up.
  const TaskGrid grid = taskGridOf(plan, earth);
  EXPECT_TRUE(grid.lattice.in_degrees);
  EXPECT_NEAR(grid.amount, plan.amount, 0.01 * plan.amount);
  const Eigen::Affine2d place_from_file = placeFromFile(plan.lattice, earth);
  for (int row = 0; row < grid.code.rows(); ++row) {
    for (int col = 0; col < grid.code.cols(); ++col) {
      const Eigen::Vector2d at =
          earth.file_from_degrees({grid.lattice.at(row + 0.5, col + 0.5)}).front();
      const Eigen::Vector2d place = place_from_file * at;
      const auto r = static_cast<int>(std::floor(place.y()));
      const auto c = static_cast<int>(std::floor(place.x()));
      EXPECT_EQ(grid.code(row, col), plan.code.contains(r, c) ? plan.code(r, c) : 0);
    }
  }
}

TEST(Squares, AreMeansOfFineAndOfCoarseLayers) {
  const Earth earth = testEarth();
  const Lattice lattice = degreeLattice(testFrame(), earth, 3.0, 3.0);
  const Eigen::Vector2d divide = earth.degrees_from_file({{500020.0, 5300000.0}}).front();
  for (const double cell : {0.05, 0.25, 5.0}) {
    const GridFrame frame = testFrame(cell);
    const Raster<float> means = squareMeans(frame, halves(frame), lattice, earth, 0.9);
    for (int col = 0; col < lattice.cols; ++col) {
      const double mean = means(lattice.rows / 2, col);
      if (!std::isfinite(mean)) continue;
      // The column that the divide runs through has the mean of both, by their shares.
      const double west = std::clamp(lattice.placeOf(divide).x() - col, 0.0, 1.0);
      EXPECT_NEAR(mean, 0.3 - 0.2 * west, cell < 1.0 ? 0.02 : 0.03) << cell << ' ' << col;
    }
  }
}

TEST(Squares, GetNoRateWhereTooLittleIsKnown) {
  const Earth earth = testEarth();
  const GridFrame frame = testFrame();
  Raster<float> values = halves(frame);
  for (int row = 0; row < frame.rows; ++row) {
    for (int col = 60; col < 100; ++col) values(row, col) = kNone;  // 15 to 25 m
  }
  Lattice lattice = degreeLattice(frame, earth, 3.0, 3.0);
  Raster<float> means = squareMeans(frame, values, lattice, earth, 0.5);
  ASSERT_TRUE(trim(lattice, means));
  const Plan plan = planOf(lattice, means, {0.2}, {100.0, 40.0}, rateUnit("kg/ha"), earth);
  EXPECT_NEAR(plan.area, 900.0, 90.0);
  EXPECT_EQ(plan.code(5, 6), 0);
  Raster<float> nothing(4, 4, kNone);
  EXPECT_FALSE(trim(lattice, nothing));
}

TEST(Classes, PartAtTheBreaksAndNeedWhatTheirAreaNeeds) {
  const Earth earth = testEarth();
  Lattice lattice = degreeLattice(testFrame(), earth, 10.0, 10.0).part(0, 0, 1, 4);
  Raster<float> means(1, 4);
  means(0, 0) = 0.5F;
  means(0, 1) = 1.0F;  // on a break: above it
  means(0, 2) = kNone;
  means(0, 3) = 7.0F;
  const Plan plan = planOf(lattice, means, {1.0, 2.0}, {30.0, 20.0, 10.0}, rateUnit("L/ha"), earth);
  EXPECT_EQ(plan.code(0, 0), 1);
  EXPECT_EQ(plan.code(0, 1), 2);
  EXPECT_EQ(plan.code(0, 2), 0);
  EXPECT_EQ(plan.code(0, 3), 3);
  EXPECT_NEAR(plan.area, 300.0, 0.1);
  EXPECT_NEAR(plan.amount, 0.01 * (30.0 + 20.0 + 10.0), 1e-4);
  const RateUnit& unit = rateUnit("L/ha");
  EXPECT_THROW(planOf(lattice, means, {1.0}, {30.0}, unit, earth), UsageError);
  EXPECT_THROW(planOf(lattice, means, {2.0, 1.0}, {1.0, 2.0, 3.0}, unit, earth), UsageError);
  EXPECT_THROW(planOf(lattice, means, {}, {-3.0}, unit, earth), UsageError);
  EXPECT_EQ(planOf(lattice, means, {}, {3.0}, unit, earth).classes.size(), 1U);
}

TEST(Classes, OfEquallyManySquares) {
  Raster<float> means(1, 301);
  for (int i = 0; i < 300; ++i) means(0, i) = 0.001234F * static_cast<float>(i);
  means(0, 300) = kNone;
  const std::vector<double> breaks = quantileBreaks(means, 3);
  ASSERT_EQ(breaks.size(), 2U);
  EXPECT_EQ(breaks[0], 0.123);  // three digits: the class reads as it is
  EXPECT_EQ(breaks[1], 0.247);
  EXPECT_TRUE(quantileBreaks(means, 1).empty());
  for (float& value : means) value = 0.0F;
  EXPECT_THROW(quantileBreaks(means, 3), InputError);
}

TEST(Squares, TooManyAreRefused) {
  GridFrame frame = testFrame();
  frame.cell = 100.0;
  EXPECT_THROW(degreeLattice(frame, testEarth(), 0.1, 0.1), UsageError);
  EXPECT_THROW(turnedLattice(frame, 0.1, 0.1, 0.1), UsageError);
}

}  // namespace
}  // namespace agricolmap::prescribe
