// Rows and plants of fields where each place is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/crop/field_rows.hpp"
#include "agricolmap/crop/test_crop.hpp"

namespace agricolmap::crop {
namespace {

constexpr auto kStraight = [](double) { return 0.0; };
constexpr auto kNoneMissing = [](int, int) { return false; };

FieldRows rowsOf(const TestField& field) {
  const Greenness greenness = greennessOf(field.view());
  EXPECT_TRUE(greenness.known());
  return findRows(field.frame, greenness.green, {});
}

std::vector<Eigen::Vector2d> placesOf(const FieldRows& rows) {
  std::vector<Eigen::Vector2d> places;
  for (const FieldRow& row : rows.rows) {
    for (const CropPlant& plant : row.stand.plants) places.push_back(plant.place);
  }
  return places;
}

/// Share of `of` that have one of `among` within 3 cm.
double met(const std::vector<Eigen::Vector2d>& of, const std::vector<Eigen::Vector2d>& among) {
  const auto count = std::count_if(of.begin(), of.end(), [&](const auto& a) {
    return std::any_of(among.begin(), among.end(),
                       [&](const auto& b) { return (a - b).norm() < 0.03; });
  });
  return static_cast<double>(count) / static_cast<double>(of.size());
}

TEST(Rows, AreFoundAtAnyHeading) {
  for (const double turn : {0.0, 0.4, 1.3, 2.6}) {
    TestField field;
    field.sow(kStraight, turn, kNoneMissing);
    const FieldRows rows = rowsOf(field);
    EXPECT_NEAR(rows.row_spacing, 0.5, 0.01) << turn;
    EXPECT_NEAR(std::abs(std::remainder(rows.heading - turn, std::numbers::pi)), 0.0, 0.02) << turn;
    EXPECT_NEAR(rows.spacing.distance, 0.2, 0.005) << turn;
    const std::vector<Eigen::Vector2d> found = placesOf(rows);
    EXPECT_GT(met(field.plants, found), 0.98) << turn;
    EXPECT_GT(met(found, field.plants), 0.995) << turn;
  }
}

TEST(Rows, AreFollowedThroughBends) {
  TestField field(12.0);
  // A heading that changes by half a radian over the field.
  field.sow([](double u) { return 0.04 * u * u; }, 0.2, kNoneMissing);
  const FieldRows rows = rowsOf(field);
  const std::vector<Eigen::Vector2d> found = placesOf(rows);
  EXPECT_GT(met(field.plants, found), 0.95);
  EXPECT_GT(met(found, field.plants), 0.98);
  double longest = 0.0;
  for (const FieldRow& row : rows.rows) longest = std::max(longest, row.line.length());
  EXPECT_GT(longest, 11.0);
}

TEST(Rows, AreNumberedAcrossTheField) {
  TestField field;
  field.sow(kStraight, 0.0, kNoneMissing);
  const FieldRows rows = rowsOf(field);
  ASSERT_GE(rows.rows.size(), 15U);
  for (std::size_t i = 1; i < rows.rows.size(); ++i) {
    const double step =
        rows.rows[i].line.at(2.0).point.y() - rows.rows[i - 1].line.at(2.0).point.y();
    EXPECT_NEAR(std::abs(step), 0.5, 0.05) << i;
  }
}

TEST(Plants, MissingOnesAreGaps) {
  TestField field;
  // One, two and five in a row, far from each other.
  field.sow(kStraight, 0.3, [](int row, int k) {
    return (row == 0 && k == 0) || (row == 2 && (k == 3 || k == 4)) ||
           (row == -3 && k >= -6 && k < -1);
  });
  const FieldRows rows = rowsOf(field);
  std::vector<double> lengths;
  for (const FieldRow& row : rows.rows) {
    for (const Stretch& gap : row.stand.gaps) lengths.push_back(gap.length());
  }
  std::sort(lengths.begin(), lengths.end());
  ASSERT_EQ(lengths.size(), 3U);
  EXPECT_NEAR(lengths[0], 0.4, 0.06);
  EXPECT_NEAR(lengths[1], 0.6, 0.06);
  EXPECT_NEAR(lengths[2], 1.2, 0.06);
}

TEST(Plants, GroundThatNobodySawIsNoGap) {
  TestField field;
  field.sow(kStraight, 0.0, kNoneMissing);
  for (int r = 0; r < field.frame.rows; ++r) {
    for (int c = 300; c < 360; ++c) field.exg(r, c) = kUnknown;
  }
  std::size_t gaps = 0;
  for (const FieldRow& row : rowsOf(field).rows) gaps += row.stand.gaps.size();
  EXPECT_EQ(gaps, 0U);
}

TEST(Plants, ThatTouchAreNotCounted) {
  TestField field;
  field.sow(kStraight, 0.0, kNoneMissing, 0.05);
  // A stretch of closed row in the middle of a field that parts elsewhere.
  for (double x = 3.0; x < 4.5; x += 0.02) field.disc({x, 4.0}, 0.05, 0.1);
  const FieldRows rows = rowsOf(field);
  double touching = 0.0;
  for (const FieldRow& row : rows.rows) {
    for (const Stretch& stretch : row.stand.touching) touching += stretch.length();
  }
  EXPECT_NEAR(touching, 1.5, 0.5);

  // Closed everywhere: no spacing, no plant.
  TestField closed;
  for (double y = 0.5; y < 7.6; y += 0.5) {
    for (double x = 0.1; x < 7.9; x += 0.02) closed.disc({x, y}, 0.08, 0.1);
  }
  const FieldRows bands = rowsOf(closed);
  EXPECT_GE(bands.rows.size(), 14U);
  EXPECT_EQ(bands.spacing.distance, 0.0);
  EXPECT_TRUE(placesOf(bands).empty());
}

TEST(Rows, AreNoneWhereNothingIsInRows) {
  TestField field;
  Random random(3);
  for (int i = 0; i < 400; ++i) {
    field.disc({random.uniform(0.2, 7.8), random.uniform(0.2, 7.8)}, 0.05, 0.1);
  }
  const Greenness greenness = greennessOf(field.view());
  ASSERT_TRUE(greenness.known());
  EXPECT_LT(findRows(field.frame, greenness.green, {}).spacing.clearness, 0.05);
}

}  // namespace
}  // namespace agricolmap::crop
