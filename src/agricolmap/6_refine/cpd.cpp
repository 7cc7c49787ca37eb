#include "agricolmap/6_refine/cpd.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "agricolmap/6_refine/cpd_fit.hpp"
#include "agricolmap/6_refine/cpd_kernel.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap {

std::string_view describe(CpdStatus status) {
  switch (status) {
    case CpdStatus::kConverged:
      return "converged";
    case CpdStatus::kIterationLimit:
      return "stopped at the iteration limit";
    case CpdStatus::kTooFewPoints:
      return "too few vegetation points in the overlap";
    case CpdStatus::kNoMatches:
      return "too few vegetation points found a counterpart";
    case CpdStatus::kDegenerate:
      return "the matched points do not determine a transform";
    case CpdStatus::kRanAway:
      return "moved further from the start than a refinement may";
  }
  return "unknown";
}

void describe(OptionTable& table, CpdOptions& options) {
  table.choice("model", options.model, {"affine", "scaled", "similarity", "rigid"},
               "horizontal map: 6 parameters, 5 without shear, 4 with one scale, 3 without scale");
  table.number("sigma_start", options.sigma_start, 0.005, 5.0, "m",
               "kernel width of the first iteration: how wrong the start may be");
  table.number("sigma_end", options.sigma_end, 0.002, 5.0, "m", "least kernel width");
  table.number("decay", options.decay, 0.3, 0.99, "",
               "most of the kernel width that an iteration may leave");
  table.number("sigma_height", options.sigma_height, 0.0, 10.0, "m",
               "deviation of the height differences; 0 leaves the heights out");
  table.flag("vertical_scale", options.vertical_scale,
             "estimate a vertical scale beside the vertical offset");
  table.number("outlier_share", options.outlier_share, 0.001, 0.95, "",
               "share of moving points expected to have no counterpart, w in CPD");
  table.flag("weights", options.weights, "greener points count more");
  table.integer("max_points", options.max_points, 100, 10000000, "",
                "points per cloud; more are merged to squares");
  table.integer("max_iterations", options.max_iterations, 1, 10000, "", "most iterations");
  table.number("tolerance", options.tolerance, 1e-7, 0.1, "m",
               "motion per iteration that counts as standing still");
  table.number("max_motion", options.max_motion, 0.001, 100.0, "m",
               "motion from the start beyond which the refinement is thrown away");
  table.number("min_matched", options.min_matched, 0.0, 1.0, "",
               "least share of moving points with a counterpart");
}

namespace {

constexpr std::size_t kMinPoints = 20;
constexpr std::size_t kChunk = 256;
/// Points are merged to squares of this many σ, and merged anew when σ has shrunk by kRebuild.
constexpr double kSquare = 0.5;
constexpr double kRebuild = 0.6;
/// Side of the squares that measure how much ground the fixed vegetation covers [m].
constexpr double kCoverSquare = 0.5;

using Points = std::vector<VegetationPoint>;

/// Both clouds about origins of their own, so that float kernels lose nothing.
struct Centred {
  Points fixed;
  Points moving;
  Eigen::Vector2d fixed_origin;
  Eigen::Vector2d moving_origin;
  std::array<Eigen::Vector2d, 4> corners;  ///< of the moving points' box
  double density = 0.0;                    ///< fixed weight per covered ground [1/m²]
  double height_range = 0.0;               ///< of the fixed points, as of a uniform spread [m]
};

Box2 boxOf(const Points& points) {
  Box2 box;
  for (const VegetationPoint& p : points) box.extend(p.position);
  return box;
}

/// The points, cropped, of equal weight if so chosen, and few enough.
Points prepare(const Points& points, const Box2& crop, const CpdOptions& options) {
  Points kept;
  for (const VegetationPoint& p : points) {
    if (!crop.contains(p.position) || !(p.weight > 0.0)) continue;
    kept.push_back(p);
    if (!options.weights) kept.back().weight = 1.0;
  }
  return thinToAtMost(kept, static_cast<std::size_t>(options.max_points));
}

Centred centre(const Points& fixed, const Points& moving, const CpdPose& start,
               const CpdOptions& options) {
  Centred result;
  const Box2 box = boxOf(moving);
  Box2 crop;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d corner = box.corner(static_cast<Box2::CornerType>(i));
    crop.extend(start.plane * corner);
    result.corners[static_cast<std::size_t>(i)] = corner - box.center();
  }
  const double margin = options.max_motion + 3.0 * options.sigma_start;
  crop.min().array() -= margin;
  crop.max().array() += margin;
  result.fixed = prepare(fixed, crop, options);
  result.moving = prepare(moving, box, options);
  result.moving_origin = box.center();
  result.fixed_origin = start.plane * box.center();
  double weight = 0.0;
  double height = 0.0;
  double square = 0.0;
  for (VegetationPoint& p : result.fixed) {
    p.position -= result.fixed_origin;
    weight += p.weight;
    height += p.weight * p.height;
    square += p.weight * p.height * p.height;
  }
  for (VegetationPoint& p : result.moving) p.position -= result.moving_origin;
  if (weight > 0.0) {
    const double covered = static_cast<double>(thinVegetation(result.fixed, kCoverSquare).size());
    result.density = weight / (covered * kCoverSquare * kCoverSquare);
    height /= weight;
    result.height_range = std::sqrt(12.0 * std::max(0.0, square / weight - height * height));
  }
  return result;
}

/// The clouds at the resolution of one σ.
struct Level {
  double sigma;
  Points moving;
  CpdMixture fixed;
};

Level makeLevel(const Centred& clouds, double sigma, bool last) {
  const auto coarse = [&](const Points& points) {
    return last ? points : thinVegetation(points, kSquare * sigma);
  };
  std::vector<Eigen::Vector4f> fixed;
  for (const VegetationPoint& p : coarse(clouds.fixed)) {
    fixed.emplace_back(
        Eigen::Vector4d(p.position.x(), p.position.y(), p.height, p.weight).cast<float>());
  }
  return {sigma, coarse(clouds.moving), CpdMixture(fixed, static_cast<float>(sigma))};
}

/// What one expectation step leaves for the maximisation.
struct Expectation {
  CpdMoments moments;
  double weight = 0.0;    ///< of all moving points
  double square = 0.0;    ///< Σ W·|x − T(y)|² over pairs
  double residual = 0.0;  ///< Σ W·|x̄ − T(y)|² over moving points
  std::size_t pairs = 0;
  Expectation& operator+=(const Expectation& other) {
    moments += other.moments;
    weight += other.weight;
    square += other.square;
    residual += other.residual;
    pairs += other.pairs;
    return *this;
  }
};

/// Posterior of the outliers' uniform distribution, in units of the kernel sum: the article's
/// c = (2πσ²)^{D/2}·w/(1 − w)·M/V, with the mixture's points per ground for M/V.
double outlierTerm(const Centred& clouds, double sigma, const CpdOptions& options) {
  const double horizontal = 2.0 * std::numbers::pi * sigma * sigma * clouds.density;
  const double deviation = options.sigma_height;
  const double width = std::sqrt(2.0 * std::numbers::pi) * deviation;
  const double vertical =
      deviation > 0.0 && width < clouds.height_range ? width / clouds.height_range : 1.0;
  return options.outlier_share / (1.0 - options.outlier_share) * horizontal * vertical;
}

Expectation expectation(const Level& level, const CpdPose& pose, double sigma, double outlier,
                        double sigma_height) {
  const CpdWidths widths{static_cast<float>(sigma), static_cast<float>(sigma_height)};
  return parallelSum(
      level.moving.size(), kChunk, Expectation{}, [&](std::size_t begin, std::size_t end) {
        Expectation part;
        for (std::size_t i = begin; i < end; ++i) {
          const VegetationPoint& p = level.moving[i];
          Eigen::Vector3d moved;
          moved << pose.plane * p.position, pose.height_scale * p.height + pose.height_offset;
          const CpdSums sums = level.fixed.at(moved.cast<float>(), widths);
          part.pairs += sums.pairs;
          part.weight += p.weight;
          const double found = static_cast<double>(sums.weight);
          if (!(found > 0.0)) continue;
          const double w = p.weight * found / (found + outlier);
          const Eigen::Vector3d offset = sums.mean_offset.cast<double>();
          part.moments.add(w, {p.position.x(), p.position.y(), p.height}, moved + offset);
          part.square += w * static_cast<double>(sums.square);
          part.residual += w * offset.head<2>().squaredNorm();
        }
        return part;
      });
}

/// Largest motion of the moving points between two poses [m].
double motionBetween(const Centred& clouds, const CpdPose& a, const CpdPose& b) {
  double motion = 0.0;
  for (const Eigen::Vector2d& corner : clouds.corners) {
    motion = std::max(motion, (a.plane * corner - b.plane * corner).norm());
  }
  return motion;
}

CpdPose toCentred(const CpdPose& pose, const Centred& clouds) {
  CpdPose result = pose;
  result.plane.translation() = pose.plane * clouds.moving_origin - clouds.fixed_origin;
  return result;
}

CpdPose fromCentred(const CpdPose& pose, const Centred& clouds) {
  CpdPose result = pose;
  result.plane.translation() += clouds.fixed_origin - pose.plane.linear() * clouds.moving_origin;
  return result;
}

/// Expectation and maximisation until the points stand still at the least σ.
class Refiner {
 public:
  Refiner(const Centred& clouds, const CpdOptions& options, const Eigen::Matrix2d& scale_axes)
      : clouds_(clouds), options_(options), scale_axes_(scale_axes) {}

  /// Fills in `result` from `start` (centred clouds); returns the pose.
  CpdPose run(const CpdPose& start, CpdResult& result) {
    CpdPose pose = start;
    double sigma = options_.sigma_start;
    std::optional<Level> level;
    result.status = CpdStatus::kIterationLimit;
    for (result.iterations = 0; result.iterations < options_.max_iterations;) {
      const bool last = sigma <= options_.sigma_end;
      if (!level || (last ? level->sigma != sigma : sigma < kRebuild * level->sigma)) {
        level = makeLevel(clouds_, sigma, last);
      }
      const Expectation sums = expectation(
          *level, pose, sigma, outlierTerm(clouds_, sigma, options_), options_.sigma_height);
      ++result.iterations;
      result.pairs += sums.pairs;
      record(sums, sigma, result);
      const std::optional<CpdPose> next =
          fitCpdPose(sums.moments, options_.model, scale_axes_, options_.vertical_scale);
      if (!next || result.matched_share < options_.min_matched) {
        result.status =
            next || !(sums.moments.weight > 0.0) ? CpdStatus::kNoMatches : CpdStatus::kDegenerate;
        return pose;
      }
      const double step = motionBetween(clouds_, pose, *next);
      pose = *next;
      result.motion = motionBetween(clouds_, start, pose);
      if (result.motion > options_.max_motion) {
        result.status = CpdStatus::kRanAway;
        return pose;
      }
      if (last && step < options_.tolerance) {
        result.status = CpdStatus::kConverged;
        return pose;
      }
      const double estimate = std::sqrt(0.5 * sums.square / sums.moments.weight);
      if (!last) sigma = std::max(options_.sigma_end, std::min(estimate, options_.decay * sigma));
    }
    return pose;
  }

 private:
  static void record(const Expectation& sums, double sigma, CpdResult& result) {
    result.sigma = sigma;
    result.matched_share = sums.weight > 0.0 ? sums.moments.weight / sums.weight : 0.0;
    result.rms = sums.moments.weight > 0.0 ? std::sqrt(sums.residual / sums.moments.weight) : 0.0;
  }

  const Centred& clouds_;
  const CpdOptions& options_;
  const Eigen::Matrix2d& scale_axes_;
};

}  // namespace

CpdResult refineByCpd(const std::vector<VegetationPoint>& fixed,
                      const std::vector<VegetationPoint>& moving, const CpdPose& start,
                      const CpdOptions& options, const Eigen::Matrix2d& scale_axes) {
  checkOptions(options);
  if (options.sigma_end > options.sigma_start) {
    throw UsageError("sigma_end of the point refinement must not exceed sigma_start");
  }
  CpdResult result;
  result.pose = start;
  if (fixed.size() < kMinPoints || moving.size() < kMinPoints) return result;
  const Centred clouds = centre(fixed, moving, start, options);
  result.fixed_points = clouds.fixed.size();
  result.moving_points = clouds.moving.size();
  if (clouds.fixed.size() < kMinPoints || clouds.moving.size() < kMinPoints) return result;
  const CpdPose refined =
      Refiner(clouds, options, scale_axes).run(toCentred(start, clouds), result);
  if (result.usable()) result.pose = fromCentred(refined, clouds);
  return result;
}

}  // namespace agricolmap
