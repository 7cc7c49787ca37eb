// Fields of round plants for tests: where each stands is known.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "agricolmap/core/random.hpp"
#include "agricolmap/crop/view.hpp"

namespace agricolmap::crop {

struct TestField {
  GridFrame frame;
  Raster<float> exg;
  Raster<float> height;
  std::vector<Eigen::Vector2d> plants;

  explicit TestField(double side = 8.0, double cell = 0.01) {
    frame.cell = cell;
    frame.rows = frame.cols = static_cast<int>(std::lround(side / cell));
    exg = Raster<float>(frame.rows, frame.cols);
    height = Raster<float>(frame.rows, frame.cols);
    Random random(5);
    for (float& value : exg) value = static_cast<float>(random.normal(0.02));
    for (float& value : height) value = static_cast<float>(random.normal(0.002));
  }
  View view() const { return {frame, exg, height}; }

  void disc(const Eigen::Vector2d& at, double radius, double tall) {
    const Eigen::Vector2d cell = frame.cellOf(at);
    const int reach = static_cast<int>(radius / frame.cell) + 1;
    for (int r = static_cast<int>(cell.y()) - reach; r <= cell.y() + reach + 1; ++r) {
      for (int c = static_cast<int>(cell.x()) - reach; c <= cell.x() + reach + 1; ++c) {
        if (!exg.contains(r, c) || (frame.centre(r, c) - at).norm() > radius) continue;
        exg(r, c) += 0.25F;
        height(r, c) += static_cast<float>(tall);
      }
    }
  }

  /// Rows 0.5 m apart along `line`, which bends y by x; a plant each 0.2 m, give or take 1 cm, but
  /// those that `missing` names by row and number.
  void sow(const std::function<double(double)>& bend, double turn,
           const std::function<bool(int, int)>& missing, double radius = 0.05) {
    Random random(7);
    const double side = frame.cell * frame.cols;
    const Eigen::Vector2d middle = Eigen::Vector2d::Constant(0.5 * side);
    const Eigen::Rotation2Dd rotation(turn);
    for (int row = -20; row <= 20; ++row) {
      for (int k = -40; k <= 40; ++k) {
        const double u = 0.2 * k + random.normal(0.01) + 0.05 * (row % 3);
        const double v = 0.5 * row + bend(u) + random.normal(0.005);
        const Eigen::Vector2d at = middle + rotation * Eigen::Vector2d(u, v);
        const bool inside = at.minCoeff() > 0.1 && at.maxCoeff() < side - 0.1;
        if (!inside || missing(row, k)) continue;
        disc(at, radius, 0.1);
        plants.push_back(at);
      }
    }
  }
};

}  // namespace agricolmap::crop
