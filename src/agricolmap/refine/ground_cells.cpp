#include "agricolmap/refine/ground_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::refine {
namespace {

/// The cells of the fixed map under the moving one.
Part partUnder(const map::GridMap& fixed, const map::GridMap& moving, const Eigen::Affine2d& pose) {
  Eigen::AlignedBox2d box;
  for (const int r : {0, moving.frame.rows}) {
    for (const int c : {0, moving.frame.cols}) {
      box.extend(fixed.frame.cellOf(pose * moving.frame.centre(r, c)));
    }
  }
  const auto within = [](double at, int count) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(count)));
  };
  return {within(box.min().y(), fixed.frame.rows), within(box.max().y() + 1.0, fixed.frame.rows),
          within(box.min().x(), fixed.frame.cols), within(box.max().x() + 1.0, fixed.frame.cols)};
}

}  // namespace

GroundModel::GroundModel(const map::GridMap& map, const Part& part, double window)
    : row0_(part.row0),
      col0_(part.col0),
      step_(std::max(1, static_cast<int>(std::lround(0.5 * window / map.frame.cell)))),
      nodes_((part.row1 - part.row0) / step_ + 2, (part.col1 - part.col0) / step_ + 2,
             std::numeric_limits<float>::quiet_NaN()) {
  parallelFor(static_cast<std::size_t>(nodes_.rows()), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    std::vector<float> heights;
    for (int c = 0; c < nodes_.cols(); ++c) nodes_(r, c) = lowOf(map, r, c, heights);
  });
}

double GroundModel::at(int row, int col) const {
  const double v = static_cast<double>(row - row0_) / step_;
  const double u = static_cast<double>(col - col0_) / step_;
  return cellsClamped<double>(nodes_.rows(), nodes_.cols(), u, v).mean([&](int r, int c) {
    return static_cast<double>(nodes_(r, c));
  });
}

float GroundModel::lowOf(const map::GridMap& map, int r, int c, std::vector<float>& heights) const {
  heights.clear();
  const int y0 = std::max(0, row0_ + (r - 1) * step_);
  const int y1 = std::min(map.frame.rows, row0_ + (r + 1) * step_);
  const int x0 = std::max(0, col0_ + (c - 1) * step_);
  const int x1 = std::min(map.frame.cols, col0_ + (c + 1) * step_);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      if (map.valid(y, x)) heights.push_back(map.height(y, x));
    }
  }
  if (heights.size() < 10) return std::numeric_limits<float>::quiet_NaN();
  return quantile(heights, 0.1);
}

bool fixedCellAt(const map::GridMap& fixed, const Eigen::Vector2d& place, int& row, int& col) {
  const Eigen::Vector2d cell = fixed.frame.cellOf(place);
  row = static_cast<int>(std::lround(cell.y()));
  col = static_cast<int>(std::lround(cell.x()));
  return fixed.weight.contains(row, col) && fixed.valid(row, col);
}

std::vector<GroundCell> groundCells(const map::GridMap& fixed, const map::GridMap& moving,
                                    const GroundModel& under_moving, const Eigen::Affine2d& pose,
                                    double window) {
  const GroundModel under_fixed(fixed, partUnder(fixed, moving, pose), window);
  std::vector<GroundCell> cells;
  for (int r = 0; r < moving.frame.rows; r += 2) {
    for (int c = 0; c < moving.frame.cols; c += 2) {
      if (!moving.valid(r, c)) continue;
      const Eigen::Vector2d place = pose * moving.frame.centre(r, c);
      int fr = 0, fc = 0;
      if (!fixedCellAt(fixed, place, fr, fc)) continue;
      const auto here = static_cast<double>(moving.height(r, c));
      const auto there = static_cast<double>(fixed.height(fr, fc));
      const double here_canopy = here - under_moving.at(r, c);
      const double there_canopy = there - under_fixed.at(fr, fc);
      if (!std::isfinite(here_canopy) || !std::isfinite(there_canopy)) continue;
      cells.push_back({place, here, there - here, std::max(0.0, here_canopy),
                       std::max(0.0, there_canopy), there - there_canopy, moving.exg(r, c), r, c});
    }
  }
  return cells;
}

}  // namespace agricolmap::refine
