#include "agricolmap/map/level.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>
#include <vector>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/map/ground_plane.hpp"

namespace agricolmap::map {

void listOptions(OptionTable& table, LevelOptions& options) {
  table.number("cell", options.cell, 0.05, 10.0, "m",
               "side of the cells whose low points stand for the ground");
  table.number("percentile", options.percentile, 0.0, 0.5, "",
               "which of a cell's heights is taken for its ground");
  table
      .number("max_tilt_deg", options.max_tilt_deg, 0.0, 80.0, "deg",
              "ground planes steeper than this are refused")
      .basic();
}

namespace {

// A plane has three parameters: 200 000 points in cells of half a metre fix it far better than the
// ground is flat.
constexpr std::size_t kMaxSamples = 200'000;
constexpr double kMinExtent = 0.2;  // [m]
constexpr int kMostRounds = 3;
constexpr double kSettled = 1e-3;  ///< a round that turns the cloud by less is the last [rad]
/// A plane found from upright and no steeper than this needs no other start [rad].
constexpr double kPlainlyUpright = 0.1;
/// Another plane must be smoother than the upright one's by these factors; the latter if it is too
/// steep for a field.
constexpr double kSmoother = 0.8;
constexpr double kFarSmoother = 0.25;
/// Rougher ground than this [m] may be canopy: then the plane under it is sought, too.
constexpr double kPlainlyGround = 0.03;
constexpr double kLowerPercentiles[] = {1.0, 0.3, 0.1, 0.03, 0.0};  ///< of the options' one
/// A plane under a canopy must have this share of the cells' support; one that is lower by less
/// than this [m] is not lower.
constexpr double kLeastSupport = 0.15;
constexpr double kSameHeight = 0.05;
/// Beside a plane that is too steep for a field, one under a canopy needs so many cells of those of
/// the steep one: a strip on its edge stands on a handful, which may well be level.
constexpr double kCellsBesideSteep = 0.5;
/// A plane that is steeper than a better supported one by more than this cuts through the crop and
/// rests on stray points [rad]: ground and canopy are all but parallel.
constexpr double kAslant = 0.05;

/// Points spread over the cloud, in the guess frame: one of every `stride`, but not always the
/// same one, which in a cloud in raster order may be that of the same columns in every row.
LevelPoints samplePoints(const PointStream& cloud, const Eigen::Affine3d& guess_from_local) {
  const std::size_t count = cloud.facts().points;
  const std::size_t stride = std::max<std::size_t>(1, count / kMaxSamples);
  Random random(1);
  std::size_t begin = 0;  // of the next stretch of points that one is taken from
  const auto next = [&] {
    const std::size_t one =
        begin < count ? begin + random.below(std::min(stride, count - begin)) : count;
    begin += stride;
    return one;
  };
  LevelPoints points;
  points.reserve(count / stride + 1);
  std::size_t one = next();
  cloud.pass([&](const PointBatch& batch) {
    for (; one < batch.first + batch.size(); one = next()) {
      points.push_back(guess_from_local * batch.xyz[one - batch.first].cast<double>());
    }
  });
  return points;
}

/// Upward normal of the plane through all points (total least squares): a start that any tilt has.
Eigen::Vector3d roughNormal(const LevelPoints& points, const Eigen::Vector3d& centre) {
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

void requireExtent(const CloudFacts& cloud, const LevelPoints& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  const Eigen::Vector3d size = box.sizes();
  if (size.x() < kMinExtent || size.y() < kMinExtent) {
    throw InputError(fmt::format(
        "{}: {} points span only {:.3g} x {:.3g} m horizontally, too little to be a map (at least "
        "{} m each way); check units and axes (x, y horizontal, z up, metres)",
        cloud.name, cloud.points, size.x(), size.y(), kMinExtent));
  }
}

LevelPoints turnedPoints(const LevelPoints& points, const Eigen::Affine3d& turn) {
  LevelPoints turned(points.size());
  std::transform(points.begin(), points.end(), turned.begin(),
                 [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(turn * p); });
  return turned;
}

/// Turns `levelled` about `centre` so that `plane`, found in it, becomes z = centre.z.
void makeLevel(const GroundPlane& plane, const Eigen::Vector3d& centre, Eigen::Affine3d& levelled) {
  const Eigen::Translation3d drop(-plane.slope_and_height.z() * Eigen::Vector3d::UnitZ());
  levelled = uprightAbout(centre, plane.normal()) * drop * levelled;
}

double tiltOf(const Eigen::Affine3d& levelled) {
  return std::acos(std::clamp(levelled.linear()(2, 2), -1.0, 1.0));
}

/// Levels `points` about `centre`, beginning with the frame `start`. The result's frame has its
/// ground at the height of `centre`.
Levelling levelFrom(const Eigen::Affine3d& start, const CloudFacts& cloud,
                    const LevelPoints& points, const Eigen::Vector3d& centre,
                    const LevelOptions& options) {
  Levelling result;
  Eigen::Affine3d& levelled = result.levelled_from_guess;
  levelled = start;
  // A cell's low percentile is only its ground once the ground is nearly level: hence more rounds.
  for (int round = 0; round < kMostRounds; ++round) {
    const LevelPoints low =
        lowPoints(turnedPoints(points, levelled), options.cell, options.percentile);
    if (low.size() < 3) {
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& p : points) box.extend(p);
      throw InputError(fmt::format(
          "{}: only {} ground cells of {} m hold 3 points or more, of {} points over {:.5g} x "
          "{:.5g} m: are its coordinates metres? If they are, the cloud is too sparse (enlarge "
          "level.cell) or too small (reduce it) to level",
          cloud.name, low.size(), options.cell, cloud.points, box.sizes().x(), box.sizes().y()));
    }
    const GroundPlane plane = fitPlane(low, centre, options.cell);
    makeLevel(plane, centre, levelled);
    result.roughness = plane.deviation;
    result.cells = low.size();
    if (plane.slope_and_height.head<2>().norm() < kSettled) break;
  }
  result.tilt = tiltOf(levelled);
  return result;
}

/// A plane that may be the ground under a canopy.
struct UnderCanopy {
  Levelling levelling;
  double height = 0.0;  ///< of the guess frame's centre over the plane [m]
  double share = 0.0;   ///< of the cells that support it
};

/// Levels by the best supported plane of the cells' points at `percentile`.
UnderCanopy levelBySupport(Eigen::Affine3d levelled, const LevelPoints& points,
                           const Eigen::Vector3d& centre, double cell, double percentile) {
  UnderCanopy result;
  for (int round = 0; round < kMostRounds; ++round) {
    const LevelPoints low = lowPoints(turnedPoints(points, levelled), cell, percentile);
    const SupportedPlane under = findPlaneUnder(low, centre, cell);
    makeLevel(under.plane, centre, levelled);
    result.share = under.support / static_cast<double>(low.size());
    result.levelling = {levelled, tiltOf(levelled), under.plane.deviation, low.size(),
                        true,     under.share};
    if (under.plane.slope_and_height.head<2>().norm() < kSettled) break;
  }
  result.height = (levelled * centre).z() - centre.z();
  return result;
}

/// Under a crop that nearly closes, few of a cell's points are of the ground, and of many cells
/// none: of the planes that enough cells support, at `found` and at lower percentiles, the lowest.
/// Not at once: clouds have points below the ground, too.
/// Of planes beside one that is too steep only those that rest on many of its cells.
Levelling levelUnderCanopy(const Levelling& found, const LevelPoints& points,
                           const Eigen::Vector3d& centre, const LevelOptions& options) {
  const Eigen::Affine3d starts[] = {Eigen::Affine3d::Identity(), found.levelled_from_guess};
  std::vector<UnderCanopy> planes(std::size(kLowerPercentiles) * std::size(starts));
  parallelFor(planes.size(), [&](std::size_t i) {
    const double percentile = kLowerPercentiles[i / std::size(starts)] * options.percentile;
    planes[i] =
        levelBySupport(starts[i % std::size(starts)], points, centre, options.cell, percentile);
  });
  const bool steep = found.tilt > radians(options.max_tilt_deg);
  const double fewest = steep ? kCellsBesideSteep * static_cast<double>(found.cells) : 0.0;
  std::erase_if(planes, [&](const UnderCanopy& plane) {
    const double cells = plane.share * static_cast<double>(plane.levelling.cells);
    return plane.share < kLeastSupport || cells < fewest;
  });
  const std::vector<UnderCanopy> all = planes;
  std::erase_if(planes, [&](const UnderCanopy& plane) {
    return std::any_of(all.begin(), all.end(), [&](const UnderCanopy& other) {
      return other.share > plane.share && other.levelling.tilt < plane.levelling.tilt - kAslant;
    });
  });
  double highest = -std::numeric_limits<double>::infinity();
  for (const UnderCanopy& plane : planes) highest = std::max(highest, plane.height);
  const UnderCanopy* best = nullptr;
  for (const UnderCanopy& plane : planes) {
    if (plane.height < highest - kSameHeight) continue;
    if (best == nullptr || plane.share > best->share) best = &plane;
  }
  return best == nullptr ? found : best->levelling;
}

}  // namespace

Levelling levelCloud(const PointStream& stream, const Eigen::Affine3d& guess_from_local,
                     const LevelOptions& options) {
  const CloudFacts& cloud = stream.facts();
  if (cloud.points == 0) throw InputError(fmt::format("{}: the cloud has no points", cloud.name));
  const LevelPoints points = samplePoints(stream, guess_from_local);
  requireExtent(cloud, points);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) centre += p;
  centre /= static_cast<double>(points.size());

  Levelling result = levelFrom(Eigen::Affine3d::Identity(), cloud, points, centre, options);
  const double limit = radians(options.max_tilt_deg);
  // From upright, a steep plane is not always found; the plane through all points is a start that
  // any tilt has. But a narrow strip of a tall crop is as thick as it is wide, and its plane may
  // stand on edge: then upright was the better start.
  if (result.tilt > kPlainlyUpright) {
    const Levelling other = levelFrom(uprightAbout(centre, roughNormal(points, centre)), cloud,
                                      points, centre, options);
    const double factor = other.tilt <= limit ? kSmoother : kFarSmoother;
    if (other.roughness < factor * result.roughness) result = other;
  }
  if (result.roughness > kPlainlyGround) {
    result = levelUnderCanopy(result, points, centre, options);
  }
  if (result.tilt > limit) {
    throw InputError(
        fmt::format(
            "{}: its ground plane is tilted by {:.0f} deg (level.max_tilt_deg is {}); z must point "
            "up: give the cloud's attitude in the initial guess",
            cloud.name, degrees(result.tilt), options.max_tilt_deg),
        Remedy::kInitialGuess);
  }
  result.levelled_from_guess =
      Eigen::Translation3d(0.0, 0.0, -centre.z()) * result.levelled_from_guess;
  return result;
}

Levelling levelCloud(const Cloud& cloud, const Eigen::Affine3d& guess_from_local,
                     const LevelOptions& options) {
  return levelCloud(CloudStream(cloud), guess_from_local, options);
}

}  // namespace agricolmap::map
