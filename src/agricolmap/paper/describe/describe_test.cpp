#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/paper/describe/descriptor_map.hpp"

namespace agricolmap::paper {
namespace {

constexpr int kSide = 80;
constexpr double kCell = 0.02;

/// A map whose cells all hold points, with the given ExG and height.
template <typename Exg, typename Height>
map::GridMap mapOf(const Exg& exg, const Height& height) {
  map::GridMap map;
  map.frame = {Eigen::Vector2d(10.0, 20.0), kCell, kSide, kSide};
  map.weight = Raster<float>(kSide, kSide, 1.0F);
  map.exg = Raster<float>(kSide, kSide);
  map.height = Raster<float>(kSide, kSide);
  map.colour = Raster<Rgb>(kSide, kSide);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      map.exg(row, col) = static_cast<float>(exg(row, col));
      map.height(row, col) = static_cast<float>(height(row, col));
      const auto grey = static_cast<std::uint8_t>(100.0F + 50.0F * map.exg(row, col));
      map.colour(row, col) = {grey, grey, grey};
    }
  }
  return map;
}

double waves(double row, double col) {
  return std::sin(0.31 * row + 0.1 * col) + std::cos(0.23 * col - 0.07 * row * col / 40.0);
}
constexpr auto kFlat = [](int, int) { return 0.0; };

DescriptorMap describedFirst(const map::GridMap& map, const DescribeOptions& options = {}) {
  const map::Box2 all(map.frame.corner,
                      map.frame.corner + Eigen::Vector2d::Constant(kSide * kCell));
  return describeMap(map, all, 1, options).front();
}

int difference(const std::uint8_t* a, const std::uint8_t* b, int size) {
  int sum = 0;
  for (int k = 0; k < size; ++k) sum += std::abs(a[k] - b[k]);
  return sum;
}

TEST(Daisy, ConstantImageHasNoGradients) {
  const DescriptorMap map = describedFirst(mapOf([](int, int) { return 0.7; }, kFlat));
  const std::size_t middle = map.index(kSide / 2, kSide / 2);
  EXPECT_EQ(map.known[middle] & DescriptorMap::kDaisyBits, DescriptorMap::kDaisyBits);
  EXPECT_TRUE(std::all_of(map.daisy(middle), map.daisy(middle) + kDaisySize,
                          [](std::uint8_t byte) { return byte == 0; }));
}

TEST(Daisy, IgnoresGainAndBias) {
  const auto exg = [](int row, int col) { return waves(row, col); };
  const auto changed = [](int row, int col) { return 3.0 * waves(row, col) - 5.0; };
  for (const DaisyNorm norm : {DaisyNorm::kPartial, DaisyNorm::kFull}) {
    DescribeOptions options;
    options.daisy.norm = norm;
    const DescriptorMap a = describedFirst(mapOf(exg, kFlat), options);
    const DescriptorMap b = describedFirst(mapOf(changed, kFlat), options);
    for (int row = 0; row < kSide; row += 7) {
      const std::size_t i = a.index(row, 40);
      EXPECT_EQ(a.known[i], b.known[i]);
      EXPECT_LE(difference(a.daisy(i), b.daisy(i), kDaisySize), 4);
    }
  }
}

TEST(Daisy, RampPointsAlongItsGradient) {
  // Brighter to the north: orientation 2 (90°) takes most, 6 (270°) nothing.
  const DescriptorMap map = describedFirst(mapOf([](int row, int) { return 0.1 * row; }, kFlat));
  const std::uint8_t* daisy = map.daisy(map.index(40, 40));
  for (std::ptrdiff_t point = 0; point < kDaisyPoints; ++point) {
    const std::uint8_t* histogram = daisy + point * kDaisyOrientations;
    EXPECT_EQ(std::max_element(histogram, histogram + kDaisyOrientations) - histogram, 2);
    EXPECT_EQ(histogram[6], 0);
    EXPECT_EQ(histogram[1], histogram[3]);
  }
}

TEST(Daisy, MarksUnknownGroundAndBridgesHoles) {
  const auto exg = [](int row, int col) { return waves(row, col); };
  const map::GridMap whole = mapOf(exg, kFlat);
  map::GridMap strip = whole;
  map::GridMap sparse = whole;
  Random random(3);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      // Values of empty cells must not matter.
      if (col >= 40) strip.weight(row, col) = 0.0F, strip.exg(row, col) = 1e6F;
      if (random.chance(0.3)) sparse.weight(row, col) = 0.0F, sparse.exg(row, col) = -1e6F;
    }
  }
  const DescriptorMap a = describedFirst(whole);
  const DescriptorMap b = describedFirst(strip);
  const std::size_t edge = a.index(40, 39);
  EXPECT_TRUE((b.known[edge] & 1U) != 0);
  EXPECT_TRUE((b.known[edge] & (1U << 11)) == 0);  // outer ring, east
  EXPECT_LT(std::popcount(b.known[edge]), std::popcount(a.known[edge]));
  EXPECT_EQ(b.known[b.index(40, 60)], 0U);
  // Far from the border nothing changes.
  const std::size_t inside = a.index(40, 12);
  EXPECT_LE(difference(a.daisy(inside), b.daisy(inside), kDaisySize),
            difference(a.daisy(inside), a.daisy(a.index(44, 12)), kDaisySize) / 4);
  // A third of the cells missing changes less than a step of 2 cells does.
  const DescriptorMap c = describedFirst(sparse);
  const std::size_t middle = a.index(40, 40);
  EXPECT_LT(difference(a.daisy(middle), c.daisy(middle), kDaisySize),
            difference(a.daisy(middle), a.daisy(a.index(42, 42)), kDaisySize));
}

TEST(DescribeMap, EmptyCellsCanCountAsZero) {
  const auto height = [](int row, int col) { return 0.02 * waves(row, col); };
  const auto exg = [](int row, int col) { return 2.0 + waves(row, col); };
  map::GridMap strip = mapOf(exg, height);
  map::GridMap zeros = strip;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 40; col < kSide; ++col) {
      // What an empty cell holds does not matter; a filled one that holds 0 is as good.
      strip.weight(row, col) = 0.0F, strip.exg(row, col) = 1e6F, strip.height(row, col) = 1e6F;
      zeros.exg(row, col) = zeros.height(row, col) = 0.0F;
    }
  }
  DescribeOptions options;
  options.empty = EmptyCells::kZero;
  const DescriptorMap a = describedFirst(strip, options);
  const DescriptorMap b = describedFirst(zeros);
  const std::size_t edge = a.index(40, 39);
  EXPECT_EQ(a.known[edge], b.known[edge]);
  EXPECT_EQ(a.known[edge] & DescriptorMap::kDaisyBits, DescriptorMap::kDaisyBits);
  EXPECT_EQ(difference(a.daisy(edge), b.daisy(edge), kDaisySize + kFpfhSize), 0);
  // The border is a step that a masked map does not see.
  EXPECT_GT(difference(a.daisy(edge), describedFirst(strip).daisy(edge), kDaisySize), 500);
  EXPECT_FALSE(a.describes(a.index(40, 40)));
  EXPECT_TRUE(b.describes(b.index(40, 40)));
}

TEST(DescribeMap, RefusesWhatWouldTakeTooMuchMemory) {
  // Only the frame is looked at: the layers of such a map would not fit here.
  map::GridMap wide;
  wide.frame = {Eigen::Vector2d::Zero(), kCell, 6000, 6000};
  const map::Box2 all(Eigen::Vector2d::Zero(), Eigen::Vector2d(120.0, 120.0));
  try {
    describeMap(wide, all, 3, {});
    FAIL() << "14 GB were not refused";
  } catch (const UsageError& error) {
    const std::string what = error.what();
    for (const char* part : {"120 x 120 m", "GiB", "4 GiB", "tighten the prior", "cells"}) {
      EXPECT_NE(what.find(part), std::string::npos) << what;
    }
  }
  const map::GridMap small = mapOf(kFlat, kFlat);
  DescribeOptions options;
  options.max_memory = 0.001;
  EXPECT_THROW(describedFirst(small, options), UsageError);
  options.max_memory = 0.01;
  EXPECT_NO_THROW(describedFirst(small, options));
  // 1 ha in cells of 2 cm, all in reach.
  EXPECT_NEAR(describingBytes(25e6) / 1e9, 9.8, 0.3);
}

int peak(const std::uint8_t* histogram) {
  return static_cast<int>(std::max_element(histogram, histogram + kFpfhBins) - histogram);
}

TEST(Fpfh, PlaneFallsIntoMiddleBinsWhateverItsTilt) {
  for (const double slope : {0.0, 0.3}) {
    const DescriptorMap map = describedFirst(
        mapOf(kFlat, [&](int row, int col) { return kCell * slope * (row + 0.5 * col); }));
    const std::size_t middle = map.index(40, 40);
    ASSERT_TRUE((map.known[middle] & DescriptorMap::kFpfhBit) != 0);
    const std::uint8_t* fpfh = map.fpfh(middle);
    for (std::ptrdiff_t angle = 0; angle < 3; ++angle) {
      const std::uint8_t* histogram = fpfh + angle * kFpfhBins;
      EXPECT_EQ(peak(histogram), kFpfhBins / 2);
      EXPECT_NEAR(std::accumulate(histogram, histogram + kFpfhBins, 0), 255, 6);
    }
    EXPECT_GE(fpfh[kFpfhBins / 2], 240);
  }
}

TEST(Fpfh, CylinderDiffersFromPlaneAndNotFromItsTurnedSelf) {
  const double radius = 8.0;  // cells
  const auto ridge = [&](double across) {
    return kCell * std::sqrt(std::max(0.0, radius * radius - across * across));
  };
  const DescriptorMap plane = describedFirst(mapOf(kFlat, kFlat));
  const DescriptorMap along_x =
      describedFirst(mapOf(kFlat, [&](int row, int) { return ridge(row - 40); }));
  const DescriptorMap along_y =
      describedFirst(mapOf(kFlat, [&](int, int col) { return ridge(col - 40); }));
  const DescriptorMap raised =
      describedFirst(mapOf(kFlat, [&](int row, int) { return 2.0 + ridge(row - 40); }));
  const std::size_t middle = plane.index(40, 40);
  const int unlike = difference(plane.fpfh(middle), along_x.fpfh(middle), kFpfhSize);
  EXPECT_GT(unlike, 150);
  EXPECT_LE(difference(along_x.fpfh(middle), along_y.fpfh(middle), kFpfhSize), unlike / 20);
  EXPECT_LE(difference(along_x.fpfh(middle), raised.fpfh(middle), kFpfhSize), 6);
}

TEST(Fpfh, ExaggerationTellsGentleReliefFromAPlane) {
  const auto gentle = [](int row, int col) { return 0.01 * waves(row, col); };
  const auto unlike = [&](double exaggeration) {
    DescribeOptions options;
    options.fpfh.exaggeration = exaggeration;
    const DescriptorMap plane = describedFirst(mapOf(kFlat, kFlat), options);
    const DescriptorMap relief = describedFirst(mapOf(kFlat, gentle), options);
    const std::size_t middle = plane.index(40, 40);
    return difference(plane.fpfh(middle), relief.fpfh(middle), kFpfhSize);
  };
  EXPECT_GT(unlike(8.0), 2 * unlike(1.0));
  EXPECT_GT(unlike(8.0), 100);
}

TEST(Fpfh, EmptyCellsHaveNoPart) {
  const auto height = [](int row, int col) { return 0.02 * waves(row, col); };
  map::GridMap map = mapOf(kFlat, height);
  const DescriptorMap whole = describedFirst(map);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 40; col < kSide; ++col) {
      map.weight(row, col) = 0.0F;
      map.height(row, col) = 100.0F;
    }
  }
  const DescriptorMap half = describedFirst(map);
  EXPECT_EQ(half.known[half.index(40, 60)] & DescriptorMap::kFpfhBit, 0U);
  EXPECT_EQ(std::count_if(half.fpfh(half.index(40, 60)), half.fpfh(half.index(40, 60)) + kFpfhSize,
                          [](std::uint8_t b) { return b != 0; }),
            0);
  const std::size_t inside = half.index(40, 20);
  EXPECT_EQ(difference(half.fpfh(inside), whole.fpfh(inside), kFpfhSize), 0);
}

TEST(DescribeMap, CropsHalvesAndFollowsTheDataTerm) {
  const map::GridMap map = mapOf([](int row, int col) { return waves(row, col); },
                                 [](int row, int col) { return 0.02 * waves(col, row); });
  const map::Box2 part(Eigen::Vector2d(10.19, 20.41), Eigen::Vector2d(10.99, 25.0));
  const auto pyramid = describeMap(map, part, 3, {});
  ASSERT_EQ(pyramid.size(), 3U);
  EXPECT_EQ(pyramid[0].frame.cols, 41);
  EXPECT_EQ(pyramid[0].frame.rows, 60);
  EXPECT_NEAR(pyramid[0].frame.corner.x(), 10.18, 1e-9);
  EXPECT_NEAR(pyramid[0].frame.corner.y(), 20.40, 1e-9);
  EXPECT_EQ(pyramid[1].frame.cols, 21);
  EXPECT_NEAR(pyramid[2].frame.cell, 0.08, 1e-12);
  EXPECT_TRUE(
      describeMap(map, map::Box2(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1)), 3, {}).empty());

  const std::size_t middle = static_cast<std::size_t>(40) * kSide + 40;
  for (const auto& [term, bits] : {std::pair{map::DataTerm::kExgHeight, 17},
                                   {map::DataTerm::kRgb, 16},
                                   {map::DataTerm::kExg, 16},
                                   {map::DataTerm::kHeight, 1}}) {
    DescribeOptions options;
    options.term = term;
    EXPECT_EQ(std::popcount(describedFirst(map, options).known[middle]), bits);
  }
}

TEST(DescribeMap, CoarseDescriptorsSpanFewerCells) {
  // How many sample points lie on the map shows how far a descriptor reaches.
  const map::GridMap map = mapOf([](int row, int col) { return waves(row, col); }, kFlat);
  const map::Box2 whole(map.frame.corner,
                        map.frame.corner + map.frame.cell * Eigen::Vector2d(kSide, kSide));
  const auto known = [&](double shrink) {
    DescribeOptions options;
    options.daisy.shrink = shrink;
    const DescriptorMap coarse = describeMap(map, whole, 3, options)[2];
    const std::size_t middle = coarse.index(coarse.frame.rows / 2, coarse.frame.cols / 2);
    return std::popcount(coarse.known[middle] & DescriptorMap::kDaisyBits);
  };
  EXPECT_LT(known(1.0), kDaisyPoints);
  EXPECT_EQ(known(0.5), kDaisyPoints);
}

TEST(DescribeMap, SameOnAnyNumberOfThreads) {
  const map::GridMap map = mapOf([](int row, int col) { return waves(row, col); },
                                 [](int row, int col) { return 0.02 * waves(col, row); });
  const DescriptorMap parallel = describedFirst(map);
  const ThreadLimit limit(1);
  const DescriptorMap serial = describedFirst(map);
  EXPECT_EQ(parallel.bytes, serial.bytes);
  EXPECT_EQ(parallel.known, serial.known);
}

}  // namespace
}  // namespace agricolmap::paper
