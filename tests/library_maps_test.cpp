// Maps of cells, by the public headers and the shared libraries alone.
#include <gtest/gtest.h>

#include <agricolmap/error.hpp>
#include <agricolmap/io.hpp>
#include <agricolmap/maps.hpp>
#include <agricolmap/register.hpp>
#include <cmath>
#include <filesystem>
#include <vector>

namespace agricolmap {
namespace {

TEST(Maps, ShowTheCloudWhereItLies) {
  // A plane that rises by 0.1 along x, with one green square metre, far from zero.
  std::vector<Eigen::Vector3d> points;
  std::vector<Rgb> colours;
  for (int row = 0; row < 200; ++row) {
    for (int col = 0; col < 300; ++col) {
      const Eigen::Vector2d at(0.02 * (col + 0.5), 0.02 * (row + 0.5));
      const bool green = at.x() > 4.0 && at.x() < 5.0 && at.y() > 1.0 && at.y() < 2.0;
      points.emplace_back(500000.0 + at.x(), 5000000.0 + at.y(), 80.0 + 0.1 * at.x());
      colours.push_back(green ? Rgb{20, 200, 20} : Rgb{100, 90, 80});
    }
  }
  const CellMap map = mapCloud(makeCloud(points, colours));
  ASSERT_EQ(map.height_m.size(), static_cast<std::size_t>(map.rows) * map.cols);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  int green = 0;
  for (int row = 0; row < map.rows; ++row) {
    for (int col = 0; col < map.cols; ++col) {
      const std::size_t i = static_cast<std::size_t>(row) * map.cols + col;
      if (!(map.weight[i] > 0.0F)) {
        EXPECT_TRUE(std::isnan(map.height_m[i]));
        continue;
      }
      EXPECT_NEAR(map.height_m[i], 0.0F, 0.002F);
      if (map.excess_green[i] < 0.5F) continue;
      ++green;
      middle += map.file_from_cell * Eigen::Vector3d(col + 0.5, row + 0.5, map.height_m[i]);
    }
  }
  ASSERT_GT(green, 1000);
  EXPECT_LT((middle / green - Eigen::Vector3d(500004.5, 5000001.5, 80.45)).norm(), 0.02);
}

/// Mean difference of greenness where both maps show some.
double difference(const ComparedMaps& maps) {
  const Transform fixed_cell_from_moving_cell =
      maps.fixed.file_from_cell.inverse() * maps.moving.file_from_cell;
  double sum = 0.0;
  int cells = 0;
  for (int row = 0; row < maps.moving.rows; ++row) {
    for (int col = 0; col < maps.moving.cols; ++col) {
      const Eigen::Vector3d at =
          fixed_cell_from_moving_cell * Eigen::Vector3d(col + 0.5, row + 0.5, 0.0);
      const auto fixed_col = static_cast<int>(std::floor(at.x()));
      const auto fixed_row = static_cast<int>(std::floor(at.y()));
      if (fixed_col < 0 || fixed_row < 0) continue;
      if (fixed_col >= maps.fixed.cols || fixed_row >= maps.fixed.rows) continue;
      const float one = maps.moving.excess_green[static_cast<std::size_t>(row) * maps.moving.cols +
                                                 static_cast<std::size_t>(col)];
      const float other =
          maps.fixed.excess_green[static_cast<std::size_t>(fixed_row) * maps.fixed.cols +
                                  static_cast<std::size_t>(fixed_col)];
      if (std::isnan(one) || std::isnan(other)) continue;
      sum += std::abs(one - other);
      ++cells;
    }
  }
  EXPECT_GT(cells, 1000);
  return sum / cells;
}

TEST(ComparedMaps, LieOnEachOtherWhereTheTransformationLaysThem) {
  const std::filesystem::path folder = std::filesystem::path(AGRICOLMAP_PAIRS) / "same_field";
  const Cloud fixed = readCloud(folder / "uav/point_cloud.ply");
  const Cloud moving = readCloud(folder / "ugv/point_cloud.ply");
  const Registration result = registerClouds(fixed, moving, readMatrix(folder / "prior.txt"));
  ASSERT_TRUE(result.accepted());
  ComparedMaps maps = comparedMaps(result);
  const double laid = difference(maps);
  maps.moving.file_from_cell.pretranslate(Eigen::Vector3d(0.1, 0.1, 0.0));
  EXPECT_LT(laid, 0.7 * difference(maps));
}

TEST(ComparedMaps, NeedARegistration) {
  EXPECT_THROW(comparedMaps(Registration()), UsageError);
  Registration own;
  own.fixed_from_moving = Transform::Identity();
  const std::vector<Eigen::Vector3d> points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  EXPECT_THROW(alignedCloud(makeCloud(points), own), UsageError);
}

}  // namespace
}  // namespace agricolmap
