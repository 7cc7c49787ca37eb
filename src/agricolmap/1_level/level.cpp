#include "agricolmap/1_level/level.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "agricolmap/core/error.hpp"

namespace agricolmap {

void describe(OptionTable& table, LevelOptions& options) {
  table.number("cell", options.cell, 0.05, 10.0, "m",
               "side of the cells whose low points stand for the ground");
  table.number("percentile", options.percentile, 0.0, 0.5, "",
               "which of a cell's heights is taken for its ground");
  table.number("max_tilt_deg", options.max_tilt_deg, 0.0, 80.0, "deg",
               "ground planes steeper than this are refused");
}

namespace {

// A plane has three parameters: 200 000 points in cells of half a metre fix it far better than the
// ground is flat.
constexpr std::size_t kMaxSamples = 200'000;
constexpr std::size_t kMinPointsPerCell = 3;
constexpr double kMinExtent = 0.2;  // [m]
constexpr int kMostRounds = 3;
constexpr double kSettled = 1e-3;  ///< a round that turns the cloud by less is the last [rad]
/// A plane found from upright and no steeper than this needs no other start [rad].
constexpr double kPlainlyUpright = 0.1;
/// Another plane must be smoother than the upright one's by these factors; the latter if it is too
/// steep for a field.
constexpr double kSmoother = 0.8;
constexpr double kFarSmoother = 0.25;
/// Rougher ground than this [m] may be canopy: then a lower percentile is tried, too.
constexpr double kPlainlyGround = 0.03;
constexpr double kLowerPercentile = 0.3;  // of the options' one

using Points = std::vector<Eigen::Vector3d>;

/// Evenly spread points of the cloud in the guess frame.
Points samplePoints(const Cloud& cloud, const Eigen::Affine3d& guess_from_local) {
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / kMaxSamples);
  Points points;
  points.reserve(cloud.size() / stride + 1);
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    points.push_back(guess_from_local * cloud.xyz[i].cast<double>());
  }
  return points;
}

/// One low point per cell of the horizontal lattice, cells in order of their key.
Points lowPoints(const Points& points, const LevelOptions& options) {
  std::vector<std::pair<std::int64_t, std::size_t>> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto col = static_cast<std::int64_t>(std::floor(points[i].x() / options.cell));
    const auto row = static_cast<std::int64_t>(std::floor(points[i].y() / options.cell));
    keyed[i] = {(row << 32) + col, i};
  }
  std::sort(keyed.begin(), keyed.end());
  Points low;
  for (std::size_t begin = 0; begin < keyed.size();) {
    std::size_t end = begin;
    while (end < keyed.size() && keyed[end].first == keyed[begin].first) ++end;
    if (end - begin >= kMinPointsPerCell) {
      const auto nth = keyed.begin() + static_cast<std::ptrdiff_t>(
                                           static_cast<double>(begin) +
                                           options.percentile * static_cast<double>(end - begin));
      std::nth_element(keyed.begin() + static_cast<std::ptrdiff_t>(begin), nth,
                       keyed.begin() + static_cast<std::ptrdiff_t>(end),
                       [&](const auto& a, const auto& b) {
                         return points[a.second].z() < points[b.second].z();
                       });
      low.push_back(points[nth->second]);
    }
    begin = end;
  }
  return low;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Plane {
  Eigen::Vector3d slope_and_height = Eigen::Vector3d::Zero();  ///< z = a·x + b·y + c about centre
  double deviation = 0.0;                                      ///< 1.48 MAD [m]
};

/// z = a·x + b·y + c by iteratively reweighted least squares with Tukey's weight. A faint pull of
/// the slopes towards zero keeps a single row of cells from tilting freely about itself.
Plane fitPlane(const Points& points, const Eigen::Vector3d& centre, double cell) {
  Plane plane;
  std::vector<double> weights(points.size(), 1.0);
  std::vector<double> residuals(points.size());
  for (int iteration = 0; iteration < 15; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
    normal *= 1e-3 * cell * cell;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d d = points[i] - centre;
      const Eigen::Vector3d row(d.x(), d.y(), 1.0);
      normal += weights[i] * row * row.transpose();
      right += weights[i] * d.z() * row;
    }
    plane.slope_and_height = normal.ldlt().solve(right);
    std::vector<double> absolute(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d d = points[i] - centre;
      residuals[i] = d.z() - plane.slope_and_height.dot(Eigen::Vector3d(d.x(), d.y(), 1.0));
      absolute[i] = std::abs(residuals[i]);
    }
    plane.deviation = 1.4826 * median(absolute);
    const double limit = 4.685 * std::max(plane.deviation, 1e-4);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double u = residuals[i] / limit;
      weights[i] = std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
    }
  }
  return plane;
}

/// Upward normal of the plane through all points (total least squares): a start that any tilt has.
Eigen::Vector3d roughNormal(const Points& points, const Eigen::Vector3d& centre) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p - centre) * (p - centre).transpose();
  const Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  return normal.z() < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

/// The rotation about `centre` that makes `normal` vertical.
Eigen::Affine3d uprightAbout(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(normal, Eigen::Vector3d::UnitZ());
  return Eigen::Translation3d(centre) * turn * Eigen::Translation3d(-centre);
}

void requireExtent(const Cloud& cloud, const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  const Eigen::Vector3d size = box.sizes();
  if (size.x() < kMinExtent || size.y() < kMinExtent) {
    throw InputError(fmt::format(
        "{}: {} points span only {:.3g} x {:.3g} m horizontally, too little to be a map (at least "
        "{} m each way); check units and axes (x, y horizontal, z up, metres)",
        cloud.name, cloud.size(), size.x(), size.y(), kMinExtent));
  }
}

/// Levels `points` about `centre`, beginning with the frame `start`.
Levelling levelFrom(const Eigen::Affine3d& start, const Cloud& cloud, const Points& points,
                    const Eigen::Vector3d& centre, const LevelOptions& options) {
  Levelling result;
  Eigen::Affine3d levelled = start;
  // A cell's low percentile is only its ground once the ground is nearly level: hence more rounds.
  for (int round = 0; round < kMostRounds; ++round) {
    Points turned(points.size());
    std::transform(points.begin(), points.end(), turned.begin(),
                   [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(levelled * p); });
    const Points low = lowPoints(turned, options);
    if (low.size() < 3) {
      throw InputError(fmt::format(
          "{}: only {} ground cells of {} m hold {} points or more; the cloud is too sparse or too "
          "small to level (reduce level.cell)",
          cloud.name, low.size(), options.cell, kMinPointsPerCell));
    }
    const Plane plane = fitPlane(low, centre, options.cell);
    const Eigen::Vector3d normal =
        Eigen::Vector3d(-plane.slope_and_height.x(), -plane.slope_and_height.y(), 1.0).normalized();
    const Eigen::Translation3d drop(-plane.slope_and_height.z() * Eigen::Vector3d::UnitZ());
    levelled = uprightAbout(centre, normal) * drop * levelled;
    result.roughness = plane.deviation;
    result.cells = low.size();
    if (std::hypot(normal.x(), normal.y()) < kSettled) break;
  }
  result.tilt = std::acos(std::clamp(levelled.linear()(2, 2), -1.0, 1.0));
  result.levelled_from_guess = Eigen::Translation3d(0.0, 0.0, -centre.z()) * levelled;
  return result;
}

}  // namespace

Levelling levelCloud(const Cloud& cloud, const Eigen::Affine3d& guess_from_local,
                     const LevelOptions& options) {
  checkOptions(options);
  if (cloud.empty()) throw InputError(fmt::format("{}: the cloud has no points", cloud.name));
  const Points points = samplePoints(cloud, guess_from_local);
  requireExtent(cloud, points);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) centre += p;
  centre /= static_cast<double>(points.size());

  Levelling result = levelFrom(Eigen::Affine3d::Identity(), cloud, points, centre, options);
  // Under a tall crop that nearly closes few of a cell's points are of the ground. Not at once the
  // lower percentile: clouds have points below the ground, too.
  if (result.roughness > kPlainlyGround) {
    LevelOptions lower = options;
    lower.percentile *= kLowerPercentile;
    const Levelling other = levelFrom(Eigen::Affine3d::Identity(), cloud, points, centre, lower);
    if (other.roughness < kSmoother * result.roughness) result = other;
  }
  const double limit = options.max_tilt_deg * std::numbers::pi / 180.0;
  // From upright, a steep plane is not always found; the plane through all points is a start that
  // any tilt has. But a narrow strip of a tall crop is as thick as it is wide, and its plane may
  // stand on edge: then upright was the better start.
  if (result.tilt > kPlainlyUpright) {
    const Levelling other = levelFrom(uprightAbout(centre, roughNormal(points, centre)), cloud,
                                      points, centre, options);
    const double factor = other.tilt <= limit ? kSmoother : kFarSmoother;
    if (other.roughness < factor * result.roughness) result = other;
  }
  if (result.tilt > limit) {
    throw InputError(fmt::format(
        "{}: its ground plane is tilted by {:.0f} deg (level.max_tilt_deg is {}); z must point up: "
        "give the cloud's attitude in offset.xyz or --prior",
        cloud.name, result.tilt * 180.0 / std::numbers::pi, options.max_tilt_deg));
  }
  return result;
}

}  // namespace agricolmap
