#include "agricolmap/refine/vertical.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/refine/canopy_lift.hpp"
#include "agricolmap/refine/ground_cells.hpp"

namespace agricolmap::refine {

void listOptions(OptionTable& table, VerticalOptions& options) {
  table
      .choice("scale", options.scale, {"assumed", "measured"},
              "vertical scale: 1, or what the ground's relief tells for sure")
      .basic();
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

/// Of Excess Green: a map whose cells differ by less from soil to plant does not tell them apart.
constexpr float kContrast = 0.08F;
/// Shares of the cells below which lies soil, and above which lie plants.
constexpr double kSoilEnd = 0.02;
constexpr double kPlantEnd = 0.98;

/// Weight of any cell where the tilt is told, beside 1 for ground.
constexpr double kSurfaceWeight = 0.01;
constexpr double kSurfaceRobust = 4.0;
constexpr int kIterations = 20;

/// Part of the lift that may be wrong: blur and gain are known to about so much.
constexpr double kLiftDoubt = 0.35;
/// Surfaces that correlate by less than the one say nothing of each other, and beyond the other
/// all.
constexpr double kUnlike = 0.2;
constexpr double kLike = 0.4;
/// A drone does not see a canopy twice as deep as it is: where it seems to, the robot sees the tops
/// alone, and what is lowest among them is no ground whatever its colour.
constexpr double kTopsOnly = 2.4;
constexpr double kAnyDepth = 2.0;
/// Share of the lowest cells that must be ground for their relief to tell the vertical scale.
constexpr double kTellsScale = 0.5;
/// Residuals beyond this many deviations do not tell whether the lift is followed.
constexpr double kFollowed = 4.0;

/// Weight of each pair as ground in both maps; `share` gets the share below the tolerance.
std::vector<double> groundWeights(const std::vector<GroundCell>& cells, double tolerance,
                                  double& share) {
  std::vector<double> heights;
  for (const GroundCell& cell : cells) {
    heights.push_back(std::hypot(cell.moving_canopy, cell.fixed_canopy));
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
    if (weights[i] >= kSurelyGround) ground.push_back(std::abs(values[i]));
  }
  return ground.empty() ? 0.0 : std::max(1e-4, deviationFrom(ground));
}

/// difference = plane · (1, x, y) for the ground.
struct Tilted {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  double deviation = 0.0;  ///< robust, of the ground's residuals [m]

  double residual(const GroundCell& cell, double difference) const {
    return difference - plane[0] - plane.tail<2>().dot(cell.place);
  }
};

/// The tilt, by iteratively reweighted least squares (Tukey) over the ground, and, where that is
/// seen along a wheel track only and does not tell, over all of the surface, which may lie at
/// another height. `of_ground`, `of_surface`: differences of heights as either is to be compared. A
/// pull towards no tilt matters only where there is hardly anything to see.
Tilted fitTilt(const std::vector<GroundCell>& cells, const std::vector<double>& ground,
               const std::vector<double>& of_ground, const std::vector<double>& of_surface,
               double robust) {
  using Parameters = Eigen::Vector4d;  // height of the ground, of the surface; tilt
  Tilted fit;
  std::vector<double> on_ground(cells.size()), on_surface(cells.size());
  std::vector<double> ground_weights = ground;
  std::vector<double> surface_weights(cells.size(), kSurfaceWeight);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Vector4d(1e-6, 1e-6, 1e-2, 1e-2).asDiagonal();
    Parameters right = Parameters::Zero();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Eigen::Vector2d& place = cells[i].place;
      for (const auto& [weight, difference, row] :
           {std::tuple(ground_weights[i], of_ground[i], Parameters(1, 0, place.x(), place.y())),
            {surface_weights[i], of_surface[i], Parameters(0, 1, place.x(), place.y())}}) {
        if (weight < 1e-6) continue;
        normal += weight * row * row.transpose();
        right += weight * difference * row;
      }
    }
    const Parameters found = normal.ldlt().solve(right);
    fit.plane << found[0], found[2], found[3];
    for (std::size_t i = 0; i < cells.size(); ++i) {
      on_ground[i] = fit.residual(cells[i], of_ground[i]);
      on_surface[i] = fit.residual(cells[i], of_surface[i]) + found[0] - found[1];
    }
    fit.deviation = groundDeviation(on_ground, ground);
    std::vector<double> distances(on_surface);
    for (double& distance : distances) distance = std::abs(distance);
    const double spread = std::max(1e-4, deviationFrom(distances));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double side = on_ground[i] > 0.0 ? kCanopyBelow : 1.0;
      ground_weights[i] =
          ground[i] < 1e-6
              ? 0.0
              : ground[i] * tukeyWeight(side * on_ground[i] / (robust * fit.deviation));
      surface_weights[i] = kSurfaceWeight * tukeyWeight(on_surface[i] / (kSurfaceRobust * spread));
    }
  }
  return fit;
}

double between(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

/// What of the lift the differences follow, 0…1: nothing where the drone sees through gaps that
/// the robot does not see whole. `weights`: of the ground.
double followed(const std::vector<GroundCell>& cells, const std::vector<double>& differences,
                const std::vector<double>& lift, const std::vector<double>& weights,
                const Tilted& raw) {
  double sum = 0.0, mean_lift = 0.0, mean_residual = 0.0;
  std::vector<double> w(weights.size()), residuals(weights.size());
  for (std::size_t i = 0; i < w.size(); ++i) {
    residuals[i] = raw.residual(cells[i], differences[i]);
    w[i] = weights[i] * tukeyWeight(residuals[i] / (kFollowed * raw.deviation));
    sum += w[i];
    mean_lift += w[i] * lift[i];
    mean_residual += w[i] * residuals[i];
  }
  if (!(sum > 0.0)) return 0.0;
  mean_lift /= sum;
  mean_residual /= sum;
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < w.size(); ++i) {
    product += w[i] * (lift[i] - mean_lift) * (residuals[i] - mean_residual);
    square += w[i] * (lift[i] - mean_lift) * (lift[i] - mean_lift);
  }
  return square > 0.0 ? std::clamp(product / square, 0.0, 1.0) : 0.0;
}

/// VerticalResult::ground_seen.
double groundSeen(const std::vector<GroundCell>& cells, const std::vector<double>& ground,
                  const VerticalResult& result) {
  std::vector<float> greenness;
  greenness.reserve(cells.size());
  for (const GroundCell& cell : cells) greenness.push_back(cell.greenness);
  const float soil = quantile(greenness, kSoilEnd);
  const float plant = quantile(greenness, kPlantEnd);
  if (plant - soil >= kContrast) {
    double all = 0.0, bare = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      all += ground[i];
      if (cells[i].greenness < 0.5F * (soil + plant)) bare += ground[i];
    }
    return bare / all;
  }
  const double hidden = between(result.ground_share, kClearGroundShare, kMinGroundShare);
  // Leaves are not flat.
  const double rough = between(result.residual, kFlatResidual, kRoughResidual);
  return 1.0 - hidden * rough;
}

double canopyOf(const std::vector<GroundCell>& cells) {
  std::vector<double> heights;
  heights.reserve(cells.size());
  for (const GroundCell& cell : cells) heights.push_back(cell.moving_canopy);
  return quantile(heights, 0.9);
}

/// How far the levelled planes, laid upon one another, may be from the registration's heights [m]:
/// by their deviations, and by as much as the fixed map's lowest ground here is above its plane.
double levelDeviation(const map::GridMap& fixed, const map::GridMap& moving,
                      const std::vector<GroundCell>& cells) {
  std::vector<double> grounds;
  grounds.reserve(cells.size());
  for (const GroundCell& cell : cells) grounds.push_back(cell.fixed_ground);
  return std::hypot(fixed.ground_deviation, moving.ground_deviation,
                    quantile(grounds, kMinGroundShare));
}

}  // namespace

double VerticalResult::bias() const {
  const double unseen = 1.0 - ground_seen;
  // Squared: cells that are a little greener than soil are gaps that a leaf reaches into.
  return std::hypot(kLiftDoubt * lift, unseen * unseen * canopy);
}

namespace {

/// With all heights at face value.
VerticalResult fitAtFaceValue(const map::GridMap& fixed, const map::GridMap& moving,
                              const Eigen::Affine2d& fixed_from_moving,
                              const VerticalOptions& options) {
  VerticalResult result;
  const GroundModel under_moving(moving, {0, moving.frame.rows, 0, moving.frame.cols},
                                 options.ground_window);
  std::vector<GroundCell> cells =
      groundCells(fixed, moving, under_moving, fixed_from_moving, options.ground_window);
  result.cells = cells.size();
  if (cells.size() < kMinCells) return result;
  const std::vector<double> ground =
      groundWeights(cells, options.ground_tolerance, result.ground_share);
  double sum = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    result.about += ground[i] * cells[i].place;
    sum += ground[i];
  }
  result.about /= sum;
  for (GroundCell& cell : cells) cell.place -= result.about;
  std::vector<double> differences;
  differences.reserve(cells.size());
  for (const GroundCell& cell : cells) differences.push_back(cell.difference);
  const Tilted raw = fitTilt(cells, ground, differences, differences, options.robust);
  result.residual = raw.deviation;
  result.canopy = canopyOf(cells);
  result.ground_seen = groundSeen(cells, ground, result);
  result.relief = map::hasRelief(fixed) && map::hasRelief(moving);
  // Where a canopy hides the ground from the cells, the planes that levelling found from the points
  // may tell more.
  const double level = levelDeviation(fixed, moving, cells);
  if (result.ground_share < kMinGroundShare && result.residual > kUnsureResidual &&
      level < result.residual) {
    result.residual = level;
  } else {
    const CanopyLift canopy =
        predictLift(fixed, moving, under_moving, fixed_from_moving, cells, raw.plane, result.about);
    result.blur = canopy.blur;
    result.canopy_gain = canopy.gain;
    result.ground_seen *= between(canopy.gain, kTopsOnly, kAnyDepth);
    // Surfaces that have nothing in common predict nothing.
    const double share = followed(cells, differences, canopy.lift, ground, raw) *
                         between(canopy.correlation, kUnlike, kLike);
    std::vector<double> of_ground = differences, of_surface = differences;
    std::vector<double> lift(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      lift[i] = share * canopy.lift[i];
      of_ground[i] -= lift[i];
      of_surface[i] -= canopy.lift[i];
    }
    const Tilted fit = fitTilt(cells, ground, of_ground, of_surface, options.robust);
    result.offset = fit.plane[0];
    result.slope = fit.plane.tail<2>();
    result.residual = fit.deviation;
    result.lift = raw.plane[0] - fit.plane[0];
    // Leaves taken for ground would tell how they grew.
    if (options.scale == VerticalScaleKind::kMeasured && result.ground_seen >= kTellsScale) {
      result.measured_scale = measureVerticalScale(cells, ground, lift, options.ground_window);
    }
  }
  result.status =
      result.slope.norm() > options.max_slope ? VerticalStatus::kTooSteep : VerticalStatus::kOk;
  return result;
}

}  // namespace

VerticalResult fitVertical(const map::GridMap& fixed, const map::GridMap& moving,
                           const Eigen::Affine2d& fixed_from_moving,
                           const VerticalOptions& options) {
  VerticalResult result = fitAtFaceValue(fixed, moving, fixed_from_moving, options);
  if (!result.measured_scale.clear()) return result;
  const VerticalScale scale = result.measured_scale;
  map::GridMap stretched = moving;
  for (float& height : stretched.height) height *= static_cast<float>(scale.value);
  stretched.ground_deviation *= scale.value;
  VerticalOptions known = options;
  known.scale = VerticalScaleKind::kAssumed;
  result = fitAtFaceValue(fixed, stretched, fixed_from_moving, known);
  result.scale = scale.value;
  result.measured_scale = scale;
  return result;
}

Eigen::Affine3d liftPose(const Eigen::Affine2d& pose, const VerticalResult& vertical) {
  Eigen::Affine3d lifted = Eigen::Affine3d::Identity();
  lifted.linear().topLeftCorner<2, 2>() = pose.linear();
  lifted.translation().head<2>() = pose.translation();
  lifted.linear()(2, 2) = vertical.scale;
  lifted.linear().row(2).head<2>() = vertical.slope.transpose() * pose.linear();
  lifted.translation().z() =
      vertical.offset + vertical.slope.dot(pose.translation() - vertical.about);
  return lifted;
}

}  // namespace agricolmap::refine
