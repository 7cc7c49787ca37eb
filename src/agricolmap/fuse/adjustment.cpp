#include "agricolmap/fuse/adjustment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "agricolmap/core/parabola.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::fuse {
namespace {

constexpr double kLeastArea = 0.5;          ///< that two strips share [m²]
constexpr double kLeastCorrelation = 0.35;  ///< for an offset to be believed
constexpr double kOffsetDeviation = 0.005;  ///< to which an offset is told, in the plane [m]
/// Less area tells it less well, as where strips end they see plants from one side alone [m²].
constexpr double kEnoughArea = 4.0;
/// Of what two strips share as they lie, so much must still be shared where they are tried: where
/// corners alone overlap any two are alike.
constexpr double kLeastShared = 0.5;
constexpr double kHeightDeviation = 0.003;  ///< and in height [m]

/// Sums of a correlation.
struct Sums {
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;

  void add(double x, double y) {
    n += 1.0;
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  double correlation() const {
    const double var_a = aa - a * a / n, var_b = bb - b * b / n;
    if (!(n > 0.0 && var_a > 1e-9 && var_b > 1e-9)) return 0.0;
    return (ab - a * b / n) / std::sqrt(var_a * var_b);
  }
};

/// How alike two strips are where both have cells.
struct Likeness {
  double cells = 0.0;
  double correlation = 0.0;
};

/// Both strips on a lattice, and which of their cells belong together.
struct Shared {
  const map::GridMap& first;
  const map::GridMap& second;
  int row_offset = 0;  ///< row of `second` − row of `first`, of the same place
  int col_offset = 0;

  /// Calls `take(cell of first, cell of second)` for all places that both have when `first` is
  /// moved by (rows, cols).
  template <typename Take>
  void each(int rows, int cols, const Take& take) const {
    const int dr = row_offset + rows, dc = col_offset + cols;
    const int row_begin = std::max(0, -dr), col_begin = std::max(0, -dc);
    const int row_end = std::min(first.frame.rows, second.frame.rows - dr);
    const int col_end = std::min(first.frame.cols, second.frame.cols - dc);
    for (int r = row_begin; r < row_end; ++r) {
      for (int c = col_begin; c < col_end; ++c) {
        const std::size_t i = first.weight.index(r, c), k = second.weight.index(r + dr, c + dc);
        if (first.valid(i) && second.valid(k)) take(i, k);
      }
    }
  }
  Likeness likeness(int rows, int cols) const {
    Sums height, exg;
    each(rows, cols, [&](std::size_t i, std::size_t k) {
      height.add(first.height[i], second.height[k]);
      exg.add(first.exg[i], second.exg[k]);
    });
    // A channel that one of the two has not says nothing.
    return {height.n, std::max({height.correlation(), exg.correlation(),
                                0.5 * (height.correlation() + exg.correlation())})};
  }
  double area() const {
    double cells = 0.0;
    each(0, 0, [&](std::size_t, std::size_t) { cells += 1.0; });
    return cells * first.frame.cell * first.frame.cell;
  }
};

struct Peak {
  int row = 0;
  int col = 0;
  double correlation = 0.0;
  Eigen::Vector2d between = Eigen::Vector2d::Zero();  ///< (col, row) beside the cell
};

Peak peakWithin(const Shared& shared, int row, int col, int reach) {
  constexpr double kNowhere = -2.0;
  const int side = 2 * reach + 1;
  const double least = kLeastShared * shared.likeness(0, 0).cells;
  Raster<double> scores(side, side);
  parallelFor(static_cast<std::size_t>(side), [&](std::size_t i) {
    const int r = static_cast<int>(i);
    for (int c = 0; c < side; ++c) {
      const Likeness alike = shared.likeness(row + r - reach, col + c - reach);
      scores(r, c) = alike.cells >= least ? alike.correlation : kNowhere;
    }
  });
  const auto best =
      static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  const int r = static_cast<int>(best) / side, c = static_cast<int>(best) % side;
  Peak peak{row + r - reach, col + c - reach, scores[best], {}};
  const auto between = [&](double before, double after) {
    return before > kNowhere && after > kNowhere ? parabolaVertex(before, scores(r, c), after)
                                                 : 0.0;
  };
  if (r > 0 && r + 1 < side && c > 0 && c + 1 < side) {
    peak.between = {between(scores(r, c - 1), scores(r, c + 1)),
                    between(scores(r - 1, c), scores(r + 1, c))};
  }
  return peak;
}

/// How many deviations an offset is off, by what both strips state and how well it is told.
double sigmasOf(const Disagreement& found, const StripErrors& a, const StripErrors& b) {
  const double plane = std::hypot(std::hypot(a.plane, b.plane) / std::sqrt(2.0), found.deviation);
  const double height = std::hypot(std::hypot(a.height, b.height), kHeightDeviation);
  return std::max(found.offset.head<2>().norm() / plane / std::sqrt(2.0),
                  std::abs(found.offset.z()) / height);
}

/// Two of the strips.
struct Pair {
  std::size_t first = 0;
  std::size_t second = 0;
};

std::optional<Disagreement> compare(const Pair& pair, const std::vector<const StripCells*>& strips,
                                    const FineStrips& strips_fine,
                                    const std::vector<StripErrors>& errors) {
  const StripCells &first = *strips[pair.first], &second = *strips[pair.second];
  const Shared coarse{first.coarse, second.coarse, first.row - second.row, first.col - second.col};
  Disagreement found{.first = pair.first, .second = pair.second};
  found.area = coarse.area();
  if (found.area < kLeastArea) return std::nullopt;
  const double cell = first.coarse.frame.cell;
  const Peak rough = peakWithin(coarse, 0, 0, static_cast<int>(std::lround(kFarthest / cell)));
  const int factor = strips_fine.factor;
  const map::GridMap first_fine = strips_fine.of(pair.first);
  const map::GridMap second_fine = strips_fine.of(pair.second);
  const Shared fine{first_fine, second_fine, coarse.row_offset * factor,
                    coarse.col_offset * factor};
  const Peak peak = peakWithin(fine, rough.row * factor, rough.col * factor, factor + 1);
  if (peak.correlation < kLeastCorrelation) return std::nullopt;
  std::vector<double> rises;
  fine.each(peak.row, peak.col, [&](std::size_t i, std::size_t k) {
    rises.push_back(static_cast<double>(second_fine.height[k] - first_fine.height[i]));
  });
  const double step = cell / factor;
  found.correlation = peak.correlation;
  found.deviation = kOffsetDeviation * std::max(1.0, kEnoughArea / found.area);
  found.offset = {step * (peak.col + peak.between.x()), step * (peak.row + peak.between.y()),
                  median(rises)};
  found.sigmas = sigmasOf(found, errors[pair.first], errors[pair.second]);
  return found;
}

}  // namespace

std::vector<Disagreement> compareStrips(const std::vector<const StripCells*>& strips,
                                        const FineStrips& fine,
                                        const std::vector<StripErrors>& errors) {
  std::vector<Disagreement> all;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    for (std::size_t k = i + 1; k < strips.size(); ++k) {
      if (auto found = compare({i, k}, strips, fine, errors)) all.push_back(*found);
    }
  }
  return all;
}

std::vector<Eigen::Vector3d> adjustedShifts(const std::vector<Disagreement>& offsets,
                                            const std::vector<StripErrors>& errors) {
  const auto count = static_cast<Eigen::Index>(errors.size());
  std::vector<Eigen::Vector3d> shifts(errors.size(), Eigen::Vector3d::Zero());
  if (offsets.empty()) return shifts;
  constexpr double kLeastError = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const bool height = axis == 2;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const StripErrors& own = errors[static_cast<std::size_t>(i)];
      const double error = std::max(kLeastError, height ? own.height : own.plane / std::sqrt(2.0));
      normal(i, i) += 1.0 / (error * error);
    }
    for (const Disagreement& pair : offsets) {
      if (!pair.plausible()) continue;
      const double deviation = height ? kHeightDeviation : pair.deviation;
      const double weight = 1.0 / (deviation * deviation);
      const auto a = static_cast<Eigen::Index>(pair.first);
      const auto b = static_cast<Eigen::Index>(pair.second);
      normal(a, a) += weight;
      normal(b, b) += weight;
      normal(a, b) -= weight;
      normal(b, a) -= weight;
      right[a] += weight * pair.offset[axis];
      right[b] -= weight * pair.offset[axis];
    }
    const Eigen::VectorXd solved = normal.ldlt().solve(right);
    for (Eigen::Index i = 0; i < count; ++i) {
      shifts[static_cast<std::size_t>(i)][axis] = solved[i];
    }
  }
  return shifts;
}

}  // namespace agricolmap::fuse
