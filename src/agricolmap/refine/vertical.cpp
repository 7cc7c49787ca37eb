#include "agricolmap/refine/vertical.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::refine {

void listOptions(OptionTable& table, VerticalOptions& options) {
  table.number("ground_window", options.ground_window, 0.05, 100.0, "m",
               "side of the window whose lowest cells stand for the ground");
  table.number("ground_tolerance", options.ground_tolerance, 0.001, 10.0, "m",
               "height above the ground at which a cell's weight as ground has fallen to 0.6");
  table
      .number("max_slope", options.max_slope, 0.0, 10.0, "m/m",
              "a larger tilt between the levelled maps is refused")
      .basic();
  table.number("robust", options.robust, 0.5, 100.0, "deviations",
               "height differences further off do not count (Tukey weight)");
}

namespace {

constexpr std::size_t kMinCells = 50;
/// At least this share of the cells stands for the ground, however tall they are.
constexpr double kMinGroundShare = 0.05;
/// With this share of them seeing ground in both maps there is no doubt which cells do.
constexpr double kClearGroundShare = 0.2;
/// Lowest cells that fit one another to this [m] are soil, and those that do to no more than that
/// may be leaves.
constexpr double kFlatResidual = 0.01;
constexpr double kRoughResidual = 0.04;
/// Lowest cells that fit one another to this [m] are right to centimetres, however few see the
/// ground: drilled wheat, where levelling may take the foot of the canopy for the ground. Under a
/// canopy that closes they differ by decimetres.
constexpr double kUnsureResidual = 0.05;

/// A robot that looks from the side takes canopy for ground more often than a drone does, and then
/// the fixed map seems too low: differences on the other side fade later, by this factor.
constexpr double kCanopyBelow = 0.6;

/// A cell that both maps see.
struct Pair {
  Eigen::Vector2d place;  ///< fixed frame [m], later relative to the middle
  double difference;      ///< fixed − moving height [m]
  double moving_canopy;   ///< height above the moving map's ground nearby [m]
  double fixed_canopy;    ///< and above the fixed map's [m]
  double fixed_ground;    ///< height of the latter [m]
};

/// Cells [row0, row1) × [col0, col1) of a map.
struct Part {
  int row0, row1, col0, col1;
};

/// Ground under each cell of a part: the 10th percentile of the seen heights in a window around it,
/// from windows on a lattice, bilinear between them.
class GroundModel {
 public:
  GroundModel(const map::GridMap& map, const Part& part, double window)
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
  /// NaN where no window around had enough cells.
  double at(int row, int col) const {
    const double v = static_cast<double>(row - row0_) / step_;
    const double u = static_cast<double>(col - col0_) / step_;
    return cellsClamped<double>(nodes_.rows(), nodes_.cols(), u, v).mean([&](int r, int c) {
      return static_cast<double>(nodes_(r, c));
    });
  }

 private:
  float lowOf(const map::GridMap& map, int r, int c, std::vector<float>& heights) const {
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

  int row0_;
  int col0_;
  int step_;
  Raster<float> nodes_;
};

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

std::vector<Pair> overlap(const map::GridMap& fixed, const map::GridMap& moving,
                          const Eigen::Affine2d& pose, double window) {
  const GroundModel under_moving(moving, {0, moving.frame.rows, 0, moving.frame.cols}, window);
  const GroundModel under_fixed(fixed, partUnder(fixed, moving, pose), window);
  std::vector<Pair> pairs;
  for (int r = 0; r < moving.frame.rows; r += 2) {
    for (int c = 0; c < moving.frame.cols; c += 2) {
      if (!moving.valid(r, c)) continue;
      const Eigen::Vector2d place = pose * moving.frame.centre(r, c);
      const Eigen::Vector2d cell = fixed.frame.cellOf(place);
      const int fr = static_cast<int>(std::lround(cell.y()));
      const int fc = static_cast<int>(std::lround(cell.x()));
      if (!fixed.weight.contains(fr, fc) || !fixed.valid(fr, fc)) continue;
      const auto here = static_cast<double>(moving.height(r, c));
      const auto there = static_cast<double>(fixed.height(fr, fc));
      const double here_canopy = here - under_moving.at(r, c);
      const double there_canopy = there - under_fixed.at(fr, fc);
      if (!std::isfinite(here_canopy) || !std::isfinite(there_canopy)) continue;
      pairs.push_back({place, there - here, std::max(0.0, here_canopy), std::max(0.0, there_canopy),
                       there - there_canopy});
    }
  }
  return pairs;
}

/// Weight of each pair as ground in both maps; `share` gets the share below the tolerance.
std::vector<double> groundWeights(const std::vector<Pair>& pairs, double tolerance, double& share) {
  std::vector<double> heights;
  for (const Pair& pair : pairs) {
    heights.push_back(std::hypot(pair.moving_canopy, pair.fixed_canopy));
  }
  const auto low = std::count_if(heights.begin(), heights.end(),
                                 [&](double height) { return height <= tolerance; });
  share = static_cast<double>(low) / static_cast<double>(heights.size());
  double scale = tolerance;
  if (share < kMinGroundShare) {
    scale = std::max(scale, quantile(std::vector<double>(heights), kMinGroundShare));
  }
  for (double& height : heights) height = std::exp(-0.5 * (height / scale) * (height / scale));
  return heights;
}

/// Robust deviation of `values` from 0 where `weights` are at least 0.6, so of the ground.
double groundDeviation(const std::vector<double>& values, const std::vector<double>& weights) {
  std::vector<double> ground;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (weights[i] >= 0.6) ground.push_back(std::abs(values[i]));
  }
  return ground.empty() ? 0.0 : deviationFrom(ground);
}

/// difference = o + s·place by iteratively reweighted least squares (Tukey) over the ground, with a
/// pull of s towards 0 that only matters where the ground is too small to tell.
Eigen::Vector3d fitPlane(const std::vector<Pair>& pairs, const std::vector<double>& ground,
                         double robust, double& deviation) {
  Eigen::Vector3d model = Eigen::Vector3d::Zero();
  std::vector<double> residuals(pairs.size());
  std::vector<double> weights = ground;
  for (int iteration = 0; iteration < 20; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Vector3d(0, 1e-2, 1e-2).asDiagonal();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Vector3d row(1.0, pairs[i].place.x(), pairs[i].place.y());
      normal += weights[i] * row * row.transpose();
      right += weights[i] * pairs[i].difference * row;
    }
    model = normal.ldlt().solve(right);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      residuals[i] = pairs[i].difference - model[0] - model.tail<2>().dot(pairs[i].place);
    }
    deviation = std::max(1e-4, groundDeviation(residuals, ground));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double side = residuals[i] > 0.0 ? kCanopyBelow : 1.0;
      weights[i] = ground[i] * tukeyWeight(side * residuals[i] / (robust * deviation));
    }
  }
  return model;
}

/// Under a canopy without gaps the lowest cells of a map from afar are leaves, and those of one
/// from near are not: the offset is then one between leaves and soil, and nothing in the heights
/// tells. The surfaces, which both maps see, give another offset; where they do not contradict it,
/// either is right.
double doubtOf(const std::vector<Pair>& pairs, const VerticalResult& result) {
  std::vector<double> differences;
  differences.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    differences.push_back(pair.difference - result.slope.dot(pair.place));
  }
  const auto between = [](double value, double from, double to) {
    return std::clamp((value - from) / (to - from), 0.0, 1.0);
  };
  const double hidden = between(result.ground_share, kClearGroundShare, kMinGroundShare);
  // Leaves are not flat.
  const double rough = between(result.residual, kFlatResidual, kRoughResidual);
  return hidden * rough * std::abs(quantile(differences, 0.5) - result.offset);
}

/// Least squares of the fixed map's canopy heights on the moving map's.
double canopyGain(const std::vector<Pair>& pairs) {
  double product = 0.0;
  double square = 0.0;
  for (const Pair& pair : pairs) {
    product += pair.moving_canopy * pair.fixed_canopy;
    square += pair.moving_canopy * pair.moving_canopy;
  }
  return square > 0.0 ? product / square : 1.0;
}

/// How far the levelled planes, laid upon one another, may be from the registration's heights [m]:
/// by their deviations, and by as much as the fixed map's lowest ground here is above its plane.
double levelDeviation(const map::GridMap& fixed, const map::GridMap& moving,
                      const std::vector<Pair>& pairs) {
  std::vector<double> grounds;
  grounds.reserve(pairs.size());
  for (const Pair& pair : pairs) grounds.push_back(pair.fixed_ground);
  return std::hypot(fixed.ground_deviation, moving.ground_deviation,
                    quantile(grounds, kMinGroundShare));
}

}  // namespace

VerticalResult fitVertical(const map::GridMap& fixed, const map::GridMap& moving,
                           const Eigen::Affine2d& fixed_from_moving,
                           const VerticalOptions& options) {
  VerticalResult result;
  std::vector<Pair> pairs = overlap(fixed, moving, fixed_from_moving, options.ground_window);
  result.cells = pairs.size();
  if (pairs.size() < kMinCells) return result;
  const std::vector<double> ground =
      groundWeights(pairs, options.ground_tolerance, result.ground_share);
  double sum = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    result.about += ground[i] * pairs[i].place;
    sum += ground[i];
  }
  result.about /= sum;
  for (Pair& pair : pairs) pair.place -= result.about;
  const Eigen::Vector3d model = fitPlane(pairs, ground, options.robust, result.residual);
  result.offset = model[0];
  result.slope = model.tail<2>();
  result.canopy_gain = canopyGain(pairs);
  // Where a canopy hides the ground from the cells, the planes that levelling found from the points
  // may tell more.
  const double level = levelDeviation(fixed, moving, pairs);
  if (result.ground_share < kMinGroundShare && result.residual > kUnsureResidual &&
      level < result.residual) {
    result.offset = 0.0;
    result.slope.setZero();
    result.residual = level;
  }
  result.doubt = doubtOf(pairs, result);
  result.status =
      result.slope.norm() > options.max_slope ? VerticalStatus::kTooSteep : VerticalStatus::kOk;
  return result;
}

Eigen::Affine3d liftPose(const Eigen::Affine2d& pose, const VerticalResult& vertical) {
  Eigen::Affine3d lifted = Eigen::Affine3d::Identity();
  lifted.linear().topLeftCorner<2, 2>() = pose.linear();
  lifted.translation().head<2>() = pose.translation();
  lifted.linear().row(2).head<2>() = vertical.slope.transpose() * pose.linear();
  lifted.translation().z() =
      vertical.offset + vertical.slope.dot(pose.translation() - vertical.about);
  return lifted;
}

}  // namespace agricolmap::refine
