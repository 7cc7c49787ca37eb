#include "agricolmap/report/page/change_squares.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace agricolmap::report {
namespace {

using io::FieldKind;
using io::GeometryKind;
using io::VectorFeature;
using io::VectorLayer;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostSquares = 900.0;

/// A mean in the making.
struct Mean {
  double sum = 0.0;
  double count = 0.0;
  void add(float value) {
    if (std::isnan(value)) return;
    sum += static_cast<double>(value);
    count += 1.0;
  }
  double value() const { return count > 0.0 ? sum / count : kNone; }
};

struct Square {
  Mean change, detection, plants, cover;
  double compared = 0.0;  ///< cells
  double rose = 0.0;      ///< cells
  double fell = 0.0;
};

/// Squares of a side, southernmost first, about a corner on their multiples.
struct Squares {
  double side = 1.0;
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< file coordinates
  int rows = 0;
  int cols = 0;
};

Squares squaresOf(const GridFrame& frame, const Eigen::Vector2d& origin) {
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  Squares squares;
  for (const double side : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
    squares.side = side;
    if (size.x() * size.y() <= kMostSquares * side * side) break;
  }
  const Eigen::Array2d low = (origin + frame.corner).array() / squares.side;
  const Eigen::Array2d high = (origin + frame.corner + size).array() / squares.side;
  squares.corner = squares.side * low.floor().matrix();
  squares.cols = static_cast<int>(std::ceil(high.x()) - std::floor(low.x()));
  squares.rows = static_cast<int>(std::ceil(high.y()) - std::floor(low.y()));
  return squares;
}

Raster<Square> sumsOf(const ChangeGround& ground, const Squares& squares) {
  Raster<Square> sums(squares.rows, squares.cols);
  const GridFrame& frame = ground.frame;
  for (int r = 0; r < frame.rows; ++r) {
    for (int c = 0; c < frame.cols; ++c) {
      const Eigen::Vector2d at =
          (ground.origin + frame.centre(r, c) - squares.corner) / squares.side;
      const int row = static_cast<int>(at.y()), col = static_cast<int>(at.x());
      if (!sums.contains(row, col)) continue;
      Square& square = sums(row, col);
      const std::size_t i = ground.heights.change.index(r, c);
      const float change = ground.heights.change[i];
      if (!std::isnan(change)) {
        square.change.add(change);
        square.compared += 1.0;
        square.detection.add(ground.heights.detection[i]);
        if (ground.heights.significant[i] > 0.0F)
          (change > 0.0F ? square.rose : square.fell) += 1.0;
      }
      if (ground.plant_height.known()) {
        square.plants.add(ground.plant_height.after[i] - ground.plant_height.before[i]);
      }
      if (ground.cover.known()) square.cover.add(ground.cover.after[i] - ground.cover.before[i]);
      if (!ground.surface.known()) square.compared = square.cover.count;
    }
  }
  return sums;
}

VectorLayer emptyLayer(const ChangeGround& ground) {
  VectorLayer layer{"squares",
                    GeometryKind::kPolygon,
                    {{"id", FieldKind::kInteger}, {"compared_m2", FieldKind::kReal, 2}},
                    {}};
  if (ground.surface.known()) {
    for (const char* name : {"change_m", "level_m", "rose", "fell", "volume_m3"}) {
      layer.fields.push_back({name, FieldKind::kReal, 4});
    }
  }
  if (ground.plant_height.known()) {
    layer.fields.push_back({"plant_height_change_m", FieldKind::kReal, 4});
  }
  if (ground.cover.known()) layer.fields.push_back({"cover_change", FieldKind::kReal, 4});
  return layer;
}

}  // namespace

VectorLayer changeSquares(const ChangeGround& ground) {
  const Squares squares = squaresOf(ground.frame, ground.origin);
  const Raster<Square> sums = sumsOf(ground, squares);
  VectorLayer layer = emptyLayer(ground);
  const double cell = ground.frame.cell * ground.frame.cell;
  for (int r = 0; r < sums.rows(); ++r) {
    for (int c = 0; c < sums.cols(); ++c) {
      const Square& square = sums(r, c);
      const double cells = square.compared;
      if (cells == 0.0) continue;
      const Eigen::Vector2d a = squares.corner + squares.side * Eigen::Vector2d(c, r);
      const Eigen::Vector2d b = a + Eigen::Vector2d::Constant(squares.side);
      VectorFeature feature{{a, {b.x(), a.y()}, b, {a.x(), b.y()}},
                            {static_cast<std::int64_t>(layer.features.size() + 1), cells * cell}};
      if (ground.surface.known()) {
        feature.values.insert(feature.values.end(),
                              {square.change.value(), square.detection.value(), square.rose / cells,
                               square.fell / cells, square.change.sum * cell});
      }
      if (ground.plant_height.known()) feature.values.emplace_back(square.plants.value());
      if (ground.cover.known()) feature.values.emplace_back(square.cover.value());
      layer.features.push_back(std::move(feature));
    }
  }
  return layer;
}

}  // namespace agricolmap::report
