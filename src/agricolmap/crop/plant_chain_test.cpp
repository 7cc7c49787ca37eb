// Which hills of a row are plants.
#include "agricolmap/crop/plant_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "agricolmap/crop/stand_learning.hpp"

namespace agricolmap::crop {
namespace {

constexpr double kDistance = 0.2;

Piece pieceAt(double middle, double area, double parted = 1.0, double aside = 0.0) {
  Piece piece;
  piece.from = middle - 0.05;
  piece.to = middle + 0.05;
  piece.top = middle;
  piece.middle = middle;
  piece.height = 0.05;
  piece.area = area;
  piece.length = 0.1;
  piece.parted = parted;
  piece.aside = aside;
  return piece;
}

StandModel usualModel() {
  StandModel model;
  model.distance = kDistance;
  model.area = 0.005;
  return model;
}

std::vector<Piece> rowOf(int count) {
  std::vector<Piece> pieces;
  for (int i = 0; i < count; ++i) pieces.push_back(pieceAt(kDistance * i, 0.005));
  return pieces;
}

TEST(PlantChain, OfPlantsThatStandApartIsCertain) {
  const Chain chain = chainOf(rowOf(20), usualModel());
  EXPECT_EQ(chain.plants.size(), 20U);
  EXPECT_NEAR(chain.expected, 20.0, 0.1);
  EXPECT_LT(chain.variance, 0.1);
  for (const PlantGroup& plant : chain.plants) EXPECT_GT(plant.probability, 0.95);
}

// 600 m of beets drilled to the millimetre, and the loosest rhythm: the product of their densities
// leaves the range of a double either way.
TEST(PlantChain, OfALongRowIsThatOfAShortOne) {
  for (const double looseness : {0.05, 0.12, 0.3}) {
    StandModel model = usualModel();
    model.jitter = looseness;
    model.drift = 1.3 * looseness;
    const Chain chain = chainOf(rowOf(3000), model);
    EXPECT_NEAR(chain.expected, 3000.0, 15.0);
    EXPECT_GT(chain.variance, 0.0);
    double sum = 0.0;
    for (const PlantGroup& plant : chain.plants) sum += plant.probability;
    EXPECT_NEAR(sum, chain.expected, 15.0);
  }
}

TEST(PlantChain, OfNothingIsEmpty) {
  const Chain chain = chainOf({}, usualModel());
  EXPECT_TRUE(chain.plants.empty());
  EXPECT_EQ(chain.expected, 0.0);
}

TEST(PlantChain, LeavesOfOnePlantAreOne) {
  std::vector<Piece> pieces = rowOf(20);
  // The eleventh shows as two halves with a shallow valley.
  pieces[10] = pieceAt(kDistance * 10 - 0.03, 0.0025, 0.3);
  pieces.insert(pieces.begin() + 11, pieceAt(kDistance * 10 + 0.03, 0.0025));
  const Chain chain = chainOf(pieces, usualModel());
  ASSERT_EQ(chain.plants.size(), 20U);
  EXPECT_EQ(chain.plants[10].first, 10U);
  EXPECT_EQ(chain.plants[10].last, 11U);
  EXPECT_NEAR(chain.plants[10].middle, kDistance * 10, 1e-9);
}

TEST(PlantChain, TheRhythmPartsWhatNoValleyDoes) {
  std::vector<Piece> pieces = rowOf(20);
  // Two neighbours in one hill: its halves, without a valley between.
  pieces[10].parted = 0.0;
  const Chain chain = chainOf(pieces, usualModel());
  EXPECT_EQ(chain.plants.size(), 20U);
}

TEST(PlantChain, ASmallPieceAsideOfTheRhythmIsAWeed) {
  std::vector<Piece> pieces = rowOf(20);
  pieces.insert(pieces.begin() + 11, pieceAt(kDistance * 10.5, 0.0006, 1.0, 0.06));
  StandModel model = usualModel();
  model.area_spread = 0.4;
  const Chain chain = chainOf(pieces, model);
  EXPECT_EQ(chain.plants.size(), 20U);
  for (const PlantGroup& plant : chain.plants) EXPECT_FALSE(plant.first <= 11 && plant.last >= 11);
}

TEST(PlantChain, WhatIsDoubtfulIsBetweenTheNumbers) {
  std::vector<Piece> pieces = rowOf(20);
  // Half a plant, between two that are there.
  pieces.insert(pieces.begin() + 11, pieceAt(kDistance * 10.5, 0.0025));
  const Chain chain = chainOf(pieces, usualModel());
  EXPECT_GT(chain.expected, 19.9);
  EXPECT_LT(chain.expected, 21.1);
  EXPECT_GT(chain.variance, 0.001);
}

TEST(PlantChain, LearnsWhatIsUsual) {
  std::vector<Piece> pieces = rowOf(60);
  for (Piece& piece : pieces) piece.area = 0.008;
  pieces.erase(pieces.begin() + 30, pieces.begin() + 33);
  StandModel model = usualModel();
  model.distance = 0.19;
  for (int round = 0; round < 4; ++round) {
    model = relearnt({chainOf(pieces, model)}, {pieces}, model);
  }
  EXPECT_NEAR(model.distance, kDistance, 1e-3);
  EXPECT_NEAR(model.area, 0.008, 1e-6);
  EXPECT_NEAR(model.missing, 3.0 / 60.0, 0.01);
  EXPECT_LT(model.drift, 0.1);
}

TEST(PlantChain, ErrsMoreOnACoarserMap) {
  const StandModel model = usualModel();
  const std::vector<Chain> rows = {chainOf(rowOf(20), model)};
  EXPECT_GT(modelError(rows, model, 0.03), modelError(rows, model, 0.01));
  EXPECT_GT(modelError({}, model, 0.01), 0.5);
}

}  // namespace
}  // namespace agricolmap::crop
