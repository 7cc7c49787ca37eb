#include "agricolmap/change/common_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::change {
namespace {

/// Of a cell: what corners and sides differ by through arithmetic with coordinates of 10⁷ m.
constexpr double kRounding = 1e-4;
constexpr double kLeastKnown = 0.5;  // of a cell's area

/// The cells of one axis that a cell reaches over, and the share of it that each is.
struct Reach {
  int first = 0;
  std::vector<double> share;
};

/// Of `count` cells of side `to` from `to_corner`; of the other axis only what it has.
std::vector<Reach> reachesOf(double from_corner, double from, int from_count, double to_corner,
                             double to, int count) {
  std::vector<Reach> reaches(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Reach& reach = reaches[static_cast<std::size_t>(i)];
    const double begin = (to_corner + i * to - from_corner) / from;
    const double end = begin + to / from;
    const int first = std::max(0, static_cast<int>(std::floor(begin + kRounding)));
    const int last = std::min(from_count, static_cast<int>(std::ceil(end - kRounding)));
    reach.first = first;
    for (int k = first; k < last; ++k) {
      reach.share.push_back((std::min(end, k + 1.0) - std::max(begin, 1.0 * k)) * from / to);
    }
  }
  return reaches;
}

/// `lift` before, `lower` after the mean.
template <typename Lift, typename Lower>
Raster<float> average(const Raster<float>& values, const GridFrame& from, const GridFrame& to,
                      const Lift& lift, const Lower& lower) {
  if (sameGrid(from, to)) return values;
  const std::vector<Reach> rows =
      reachesOf(from.corner.y(), from.cell, from.rows, to.corner.y(), to.cell, to.rows);
  const std::vector<Reach> cols =
      reachesOf(from.corner.x(), from.cell, from.cols, to.corner.x(), to.cell, to.cols);
  Raster<float> means(to.rows, to.cols, std::numeric_limits<float>::quiet_NaN());
  parallelFor(rows.size(), [&](std::size_t r) {
    const Reach& row = rows[r];
    float* const out = means.row(static_cast<int>(r));
    for (std::size_t c = 0; c < cols.size(); ++c) {
      const Reach& col = cols[c];
      double sum = 0.0;
      double known = 0.0;
      for (std::size_t i = 0; i < row.share.size(); ++i) {
        const float* const line = values.row(row.first + static_cast<int>(i)) + col.first;
        for (std::size_t k = 0; k < col.share.size(); ++k) {
          if (std::isnan(line[k])) continue;
          const double share = row.share[i] * col.share[k];
          sum += share * lift(static_cast<double>(line[k]));
          known += share;
        }
      }
      if (known >= kLeastKnown) out[c] = static_cast<float>(lower(sum / known));
    }
  });
  return means;
}

}  // namespace

bool sameGrid(const GridFrame& a, const GridFrame& b) {
  return a.rows == b.rows && a.cols == b.cols &&
         std::abs(a.cell - b.cell) * std::max(a.rows, a.cols) < kRounding * a.cell &&
         (a.corner - b.corner).cwiseAbs().maxCoeff() < kRounding * a.cell;
}

std::optional<GridFrame> commonGrid(const GridFrame& a, const GridFrame& b) {
  const bool a_coarser = a.cell >= b.cell * (1.0 - kRounding);
  const GridFrame& coarse = a_coarser ? a : b;
  const GridFrame& fine = a_coarser ? b : a;
  const auto sizeOf = [](const GridFrame& frame) {
    return Eigen::Vector2d(frame.cols, frame.rows);
  };
  const Eigen::Array2d low = (fine.corner - coarse.corner).array() / coarse.cell;
  const Eigen::Array2d high = low + sizeOf(fine).array() * (fine.cell / coarse.cell);
  const Eigen::Array2d first = (low - kRounding).ceil().max(0.0);
  const Eigen::Array2d last = (high + kRounding).floor().min(sizeOf(coarse).array());
  if ((last <= first).any()) return std::nullopt;
  GridFrame common;
  common.corner = coarse.corner + coarse.cell * first.matrix();
  common.cell = coarse.cell;
  common.cols = static_cast<int>(last.x() - first.x());
  common.rows = static_cast<int>(last.y() - first.y());
  return common;
}

Raster<float> areaMean(const Raster<float>& values, const GridFrame& from, const GridFrame& to) {
  const auto same = [](double value) { return value; };
  return average(values, from, to, same, same);
}

Raster<float> areaRms(const Raster<float>& values, const GridFrame& from, const GridFrame& to) {
  return average(
      values, from, to, [](double value) { return value * value; },
      [](double value) { return std::sqrt(value); });
}

Raster<std::uint16_t> nearestCode(const Raster<std::uint16_t>& codes, const GridFrame& from,
                                  const GridFrame& to) {
  Raster<std::uint16_t> nearest(to.rows, to.cols);
  for (int r = 0; r < to.rows; ++r) {
    for (int c = 0; c < to.cols; ++c) {
      const Eigen::Array2d at = (from.cellOf(to.centre(r, c)).array() + 0.5 + kRounding).floor();
      const int row = static_cast<int>(at.y());
      const int col = static_cast<int>(at.x());
      if (codes.contains(row, col)) nearest(r, c) = codes(row, col);
    }
  }
  return nearest;
}

}  // namespace agricolmap::change
