#include "agricolmap/6_refine/vertical.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace agricolmap {

void describe(OptionTable& table, VerticalOptions& options) {
  table.number("ground_window", options.ground_window, 0.05, 100.0, "m",
               "side of the window whose lowest cells stand for the ground");
  table.number("max_slope", options.max_slope, 0.0, 10.0, "m/m",
               "a larger tilt between the levelled maps is refused");
  table.number("robust", options.robust, 0.5, 100.0, "deviations",
               "height differences further off do not count (Tukey weight)");
}

namespace {

constexpr std::size_t kMinCells = 50;

/// A cell that both maps see.
struct Pair {
  Eigen::Vector2d place;  ///< fixed frame, relative to the middle [m]
  double difference;      ///< fixed − moving height [m]
  double canopy;          ///< moving height above its own ground nearby [m]
};

/// Ground under each cell: the 10th percentile of the seen heights in a window around it, from
/// windows on a lattice, bilinear between them.
class GroundModel {
 public:
  GroundModel(const GridMap& map, double window) : frame_(map.frame) {
    step_ = std::max(1, static_cast<int>(std::lround(0.5 * window / map.frame.cell)));
    rows_ = map.frame.rows / step_ + 2;
    cols_ = map.frame.cols / step_ + 2;
    nodes_ = Raster<float>(rows_, cols_, std::numeric_limits<float>::quiet_NaN());
    std::vector<float> heights;
    for (int r = 0; r < rows_; ++r) {
      for (int c = 0; c < cols_; ++c) {
        heights.clear();
        for (int y = std::max(0, (r - 1) * step_); y < std::min(map.frame.rows, (r + 1) * step_);
             ++y) {
          for (int x = std::max(0, (c - 1) * step_); x < std::min(map.frame.cols, (c + 1) * step_);
               ++x) {
            if (map.valid(y, x)) heights.push_back(map.height(y, x));
          }
        }
        if (heights.size() < 10) continue;
        const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
        std::nth_element(heights.begin(), low, heights.end());
        nodes_(r, c) = *low;
      }
    }
  }
  /// NaN where no window around had enough cells.
  double at(int row, int col) const {
    const double v = static_cast<double>(row) / step_;
    const double u = static_cast<double>(col) / step_;
    const int r = std::min(static_cast<int>(v), rows_ - 2);
    const int c = std::min(static_cast<int>(u), cols_ - 2);
    const double fv = v - r, fu = u - c;
    return (1 - fv) * ((1 - fu) * node(r, c) + fu * node(r, c + 1)) +
           fv * ((1 - fu) * node(r + 1, c) + fu * node(r + 1, c + 1));
  }

 private:
  double node(int r, int c) const { return static_cast<double>(nodes_(r, c)); }
  GridFrame frame_;
  int step_ = 1;
  int rows_ = 0;
  int cols_ = 0;
  Raster<float> nodes_;
};

std::vector<Pair> overlap(const GridMap& fixed, const GridMap& moving, const Eigen::Affine2d& pose,
                          double window) {
  const GroundModel ground(moving, window);
  std::vector<Pair> pairs;
  for (int r = 0; r < moving.frame.rows; r += 2) {
    for (int c = 0; c < moving.frame.cols; c += 2) {
      if (!moving.valid(r, c)) continue;
      const Eigen::Vector2d place = pose * moving.frame.centre(r, c);
      const Eigen::Vector2d cell = fixed.frame.cellOf(place);
      const int fr = static_cast<int>(std::lround(cell.y()));
      const int fc = static_cast<int>(std::lround(cell.x()));
      if (!fixed.weight.contains(fr, fc) || !fixed.valid(fr, fc)) continue;
      const auto height = static_cast<double>(moving.height(r, c));
      const double canopy = height - ground.at(r, c);
      if (!std::isfinite(canopy)) continue;
      pairs.push_back(
          {place, static_cast<double>(fixed.height(fr, fc)) - height, std::max(0.0, canopy)});
    }
  }
  return pairs;
}

double medianAbsolute(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// difference = o + s·place + k·canopy by iteratively reweighted least squares (Tukey), with a pull
/// of k towards 0 that only matters where there is no canopy to see.
Eigen::Vector4d fitModel(const std::vector<Pair>& pairs, double robust, double& deviation) {
  Eigen::Vector4d model = Eigen::Vector4d::Zero();
  std::vector<double> residuals(pairs.size()), weights(pairs.size(), 1.0);
  for (int iteration = 0; iteration < 20; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Vector4d(0, 1e-2, 1e-2, 1e-2).asDiagonal();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Vector4d row(1.0, pairs[i].place.x(), pairs[i].place.y(), pairs[i].canopy);
      normal += weights[i] * row * row.transpose();
      right += weights[i] * pairs[i].difference * row;
    }
    model = normal.ldlt().solve(right);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Vector4d row(1.0, pairs[i].place.x(), pairs[i].place.y(), pairs[i].canopy);
      residuals[i] = pairs[i].difference - row.dot(model);
    }
    deviation = std::max(1e-4, 1.4826 * medianAbsolute(residuals));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double u = residuals[i] / (robust * deviation);
      weights[i] = std::abs(u) < 1.0 ? (1 - u * u) * (1 - u * u) : 0.0;
    }
  }
  return model;
}

}  // namespace

VerticalResult fitVertical(const GridMap& fixed, const GridMap& moving,
                           const Eigen::Affine2d& fixed_from_moving,
                           const VerticalOptions& options) {
  checkOptions(options);
  VerticalResult result;
  std::vector<Pair> pairs = overlap(fixed, moving, fixed_from_moving, options.ground_window);
  result.cells = pairs.size();
  if (pairs.size() < kMinCells) return result;
  for (const Pair& pair : pairs) result.about += pair.place;
  result.about /= static_cast<double>(pairs.size());
  for (Pair& pair : pairs) pair.place -= result.about;
  const Eigen::Vector4d model = fitModel(pairs, options.robust, result.residual);
  result.offset = model[0];
  result.slope = model.segment<2>(1);
  result.canopy_gain = 1.0 + model[3];
  result.status =
      result.slope.norm() > options.max_slope ? VerticalStatus::kTooSteep : VerticalStatus::kOk;
  return result;
}

}  // namespace agricolmap
