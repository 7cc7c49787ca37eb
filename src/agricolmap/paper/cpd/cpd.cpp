#include "agricolmap/paper/cpd/cpd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/paper/cpd/cpd_accelerate.hpp"
#include "agricolmap/paper/cpd/cpd_fit.hpp"
#include "agricolmap/paper/cpd/cpd_level.hpp"

namespace agricolmap::paper {

std::string_view toString(CpdStatus status) {
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

void listOptions(OptionTable& table, CpdOptions& options) {
  table.choice("kind", options.kind, {"adapted", "published"},
               "adapted to strips of plants, or as Myronenko and Song published it, with the "
               "options of cpd.published alone");
  table.group("published", options.published);
  table
      .number("sigma_start", options.sigma_start, 0.005, 5.0, "m",
              "kernel width of the first iteration: how wrong the start may be")
      .basic();
  table.number("sigma_end", options.sigma_end, 0.002, 5.0, "m", "least kernel width");
  table.number("decay", options.decay, 0.3, 0.99, "",
               "most of the kernel width that is left from one level to the next");
  table.number("sigma_height", options.sigma_height, 0.0, 10.0, "m",
               "deviation of the height differences; 0 leaves the heights out");
  table.number("outlier_share", options.outlier_share, 0.001, 0.95, "",
               "share of moving points expected to have no counterpart, w in CPD");
  table.number(
      "border", options.border, 0.0, 10.0, "",
      "moving points nearer to the edge of their map count only as surroundings of others, "
      "in kernel widths");
  table.number("start_weight", options.start_weight, 0.0, 10.0, "",
               "pull of the start at sigma_start beside that of the matches; fades with the width");
  table.integer("max_points", options.max_points, 100, 10000000, "",
                "points per cloud; more are merged to squares");
  table.integer("max_iterations", options.max_iterations, 1, 10000, "",
                "most iterations at one kernel width");
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

/// What one expectation step leaves for the maximisation.
struct Expectation {
  CpdMoments moments;
  double weight = 0.0;  ///< of all moving points
  double square = 0.0;  ///< Σ W·|x − T(y)|² over pairs
  Expectation& operator+=(const Expectation& other) {
    moments += other.moments;
    weight += other.weight;
    square += other.square;
    return *this;
  }
};

/// Posterior of the outliers' uniform distribution, in units of the kernel sum: the article's
/// c = (2πσ²)^{D/2}·w/(1 − w)·M/V, with the mixture's points per ground for M/V.
double outlierTerm(const CpdClouds& clouds, double sigma, const CpdOptions& options) {
  const double horizontal = 2.0 * std::numbers::pi * sigma * sigma * clouds.density;
  const double deviation = options.sigma_height;
  const double width = std::sqrt(2.0 * std::numbers::pi) * deviation;
  const double vertical =
      deviation > 0.0 && width < clouds.height_range ? width / clouds.height_range : 1.0;
  return options.outlier_share / (1.0 - options.outlier_share) * horizontal * vertical;
}

Expectation expectation(const CpdLevel& level, const CpdPose& pose, double sigma, double outlier,
                        double sigma_height) {
  const CpdWidths widths{static_cast<float>(sigma), static_cast<float>(sigma_height)};
  return parallelSum(level.data.size(), kChunk, Expectation{},
                     [&](std::size_t begin, std::size_t end) {
                       Expectation part;
                       for (std::size_t i = begin; i < end; ++i) {
                         const map::VegetationPoint& p = level.data[i].point;
                         const Eigen::Vector3d& mean = level.data[i].mean;
                         const Eigen::Vector3d moved = applyPose(pose, p.position, p.height);
                         const CpdSums sums = level.fixed.at(moved.cast<float>(), widths);
                         part.weight += p.weight;
                         const double found = static_cast<double>(sums.weight);
                         if (!(found > 0.0)) continue;
                         const double w = p.weight * found / (found + outlier);
                         const Eigen::Vector3d target = moved + sums.mean_offset.cast<double>();
                         part.moments.add(w, mean, target);
                         part.square += w * static_cast<double>(sums.square);
                       }
                       return part;
                     });
}

/// Largest motion of the moving points between two poses [m].
double motionBetween(const CpdClouds& clouds, const CpdPose& a, const CpdPose& b) {
  return poseDistance(clouds.corners, a.plane, b.plane);
}

CpdPose toCentred(const CpdPose& pose, const CpdClouds& clouds) {
  CpdPose result = pose;
  result.plane.translation() = pose.plane * clouds.moving_origin - clouds.fixed_origin;
  return result;
}

CpdPose fromCentred(const CpdPose& pose, const CpdClouds& clouds) {
  CpdPose result = pose;
  result.plane.translation() += clouds.fixed_origin - pose.plane.linear() * clouds.moving_origin;
  return result;
}

/// A pose as numbers of like size, all in metres: where three corners of the strip go, and
/// the height offset.
Eigen::VectorXd toVector(const CpdPose& pose, const CpdClouds& clouds) {
  Eigen::VectorXd vector(7);
  for (Eigen::Index i = 0; i < 3; ++i) {
    vector.segment<2>(2 * i) = pose.plane * clouds.corners[static_cast<std::size_t>(i)];
  }
  vector(6) = pose.height_offset;
  return vector;
}

CpdPose fromVector(const Eigen::VectorXd& vector, const CpdClouds& clouds) {
  const Eigen::Vector2d& corner = clouds.corners[0];
  Eigen::Matrix2d sides;
  sides << clouds.corners[1] - corner, clouds.corners[2] - corner;
  Eigen::Matrix2d images;
  images << vector.segment<2>(2) - vector.head<2>(), vector.segment<2>(4) - vector.head<2>();
  CpdPose pose;
  pose.plane.linear() = images * sides.inverse();
  pose.plane.translation() = vector.head<2>() - pose.plane.linear() * corner;
  pose.height_offset = vector(6);
  return pose;
}

/// Expectation and maximisation, level by level, until the points stand still at the least σ.
class Refiner {
 public:
  Refiner(const CpdClouds& clouds, const CpdOptions& options, CpdResult& result)
      : clouds_(clouds), options_(options), result_(result) {}

  /// Fills in the result from `start` (centred clouds); returns the pose.
  CpdPose run(const CpdPose& start) {
    start_ = start;
    CpdPose pose = start;
    double sigma = options_.sigma_start;
    for (;;) {
      const bool last = sigma <= options_.sigma_end;
      bool still = false;
      const double estimate =
          climb(makeCpdLevel(clouds_, pose, sigma, last, options_), last, pose, still);
      if (failed_) return pose;
      if (last) {
        result_.status = still ? CpdStatus::kConverged : CpdStatus::kIterationLimit;
        return pose;
      }
      sigma = std::max(options_.sigma_end, std::min(estimate, options_.decay * sigma));
    }
  }

 private:
  /// Iterates at one σ; returns the article's estimate of σ. `still`: stopped moving.
  double climb(const CpdLevel& level, bool last, CpdPose& pose, bool& still) {
    const double tolerance = last ? options_.tolerance : kCoarseTolerance * level.sigma;
    const double outlier = outlierTerm(clouds_, level.sigma, options_);
    const double relative = level.sigma / options_.sigma_start;
    const double start_weight = last ? 0.0 : options_.start_weight * relative * relative;
    AndersonMixer mixer(kMixerMemory);
    double estimate = level.sigma;
    double before = std::numeric_limits<double>::infinity();
    CpdPose image = pose;
    for (int i = 0; i < options_.max_iterations && !still; ++i) {
      Expectation sums = expectation(level, pose, level.sigma, outlier, options_.sigma_height);
      ++result_.iterations;
      result_.matched_share = sums.weight > 0.0 ? sums.moments.weight / sums.weight : 0.0;
      if (start_weight > 0.0) addStart(level, pose, start_weight, sums.moments);
      const std::optional<CpdPose> fit = fitCpdPose(sums.moments);
      if (!fit || result_.matched_share < options_.min_matched) return fail();
      image = *fit;
      estimate = std::sqrt(0.5 * sums.square / sums.moments.weight);
      const double step = motionBetween(clouds_, pose, image);
      if (step > 2.0 * before) mixer.restart();  // mixing overshot: plain EM from here
      before = step;
      const CpdPose mixed = fromVector(
          mixer.next(toVector(pose, clouds_), toVector(image, clouds_), level.sigma), clouds_);
      still = std::max(step, motionBetween(clouds_, pose, mixed)) < tolerance;
      pose = mixed;
      if (motionBetween(clouds_, start_, pose) > options_.max_motion) {
        failed_ = true;
        result_.status = CpdStatus::kRanAway;
        return estimate;
      }
    }
    pose = image;  // not what mixing proposes
    return estimate;
  }

  /// Gives every datum a second counterpart, where the start puts it: coarse levels see too little
  /// of a sparse field to be let free. Heights stay out of it.
  void addStart(const CpdLevel& level, const CpdPose& pose, double weight,
                CpdMoments& moments) const {
    for (const CpdDatum& datum : level.data) {
      Eigen::Vector3d target;
      target << start_.plane * datum.mean.head<2>(), datum.mean.z() + pose.height_offset;
      moments.add(weight * datum.point.weight, datum.mean, target);
    }
  }

  double fail() {
    failed_ = true;
    result_.status = result_.matched_share >= options_.min_matched ? CpdStatus::kDegenerate
                                                                   : CpdStatus::kNoMatches;
    return 0.0;
  }

  static constexpr std::size_t kMixerMemory = 5;
  /// Before the last level, standing still means moving less than this share of σ.
  static constexpr double kCoarseTolerance = 0.02;

  const CpdClouds& clouds_;
  const CpdOptions& options_;
  CpdResult& result_;
  CpdPose start_;
  bool failed_ = false;
};

using Points = std::vector<map::VegetationPoint>;

/// The fixed points within the convex outline of the moving ones, as its extents in a number of
/// directions tell: what lies around the strip has no counterpart, and would stretch it.
Points withinOutline(const Points& fixed, const Points& moving, const CpdPose& start) {
  constexpr int kDirections = 32;
  Eigen::Matrix<double, kDirections, 2> directions;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kDirections;
    directions.row(k) << std::cos(angle), std::sin(angle);
  }
  Eigen::Array<double, kDirections, 1> farthest;
  farthest.setConstant(std::numeric_limits<double>::lowest());
  for (const map::VegetationPoint& p : moving) {
    farthest = farthest.max((directions * p.position).array());
  }
  const Eigen::Affine2d back = start.plane.inverse();
  Points inside;
  for (const map::VegetationPoint& p : fixed) {
    if (((directions * (back * p.position)).array() <= farthest).all()) inside.push_back(p);
  }
  return inside;
}

/// At most `count` points as columns, each with the same say, where `pose` puts them.
Eigen::Matrix3Xd asColumns(Points points, int count, const CpdPose& pose) {
  for (map::VegetationPoint& p : points) p.weight = 1.0;
  const Points few = map::thinToAtMost(points, static_cast<std::size_t>(count));
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(few.size()));
  for (std::size_t i = 0; i < few.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = applyPose(pose, few[i].position, few[i].height);
  }
  return columns;
}

CpdResult refineAsPublished(const Points& fixed, const Points& moving, const CpdPose& start,
                            const PublishedCpdOptions& options) {
  CpdResult result;
  result.pose = start;
  const Eigen::Matrix3Xd x =
      asColumns(withinOutline(fixed, moving, start), options.max_points, CpdPose{});
  const Eigen::Matrix3Xd y = asColumns(moving, options.max_points, start);
  if (std::min(x.cols(), y.cols()) < static_cast<Eigen::Index>(kMinPoints)) return result;
  const PublishedCpdResult found = publishedCpd(x, y, options);
  const PublishedCpdState& state = found.state;
  result.iterations = found.iterations;
  result.matched_share = state.matched / static_cast<double>(x.cols());
  if (state.degenerate) {
    result.status = CpdStatus::kDegenerate;
    return result;
  }
  result.status = found.converged ? CpdStatus::kConverged : CpdStatus::kIterationLimit;
  const Eigen::Vector3d mean = y.rowwise().mean();
  Eigen::Affine2d plane;
  plane.linear() = state.linear.topLeftCorner<2, 2>();
  plane.translation() = state.shift.head<2>() + state.linear.topRightCorner<2, 1>() * mean.z();
  result.pose.plane = plane * start.plane;
  const double rise = state.linear(2, 2);
  result.pose.height_offset = rise * start.height_offset + state.shift.z() +
                              state.linear.bottomLeftCorner<1, 2>() * mean.head<2>();
  return result;
}

}  // namespace

CpdResult refineByCpd(const std::vector<map::VegetationPoint>& fixed,
                      const std::vector<map::VegetationPoint>& moving, const CpdPose& start,
                      const CpdOptions& options) {
  CpdResult result;
  result.pose = start;
  if (fixed.size() < kMinPoints || moving.size() < kMinPoints) return result;
  if (options.kind == CpdKind::kPublished) {
    return refineAsPublished(fixed, moving, start, options.published);
  }
  const CpdClouds clouds = makeCpdClouds(fixed, moving, start, options);
  if (clouds.fixed.size() < kMinPoints || clouds.moving.size() < kMinPoints) return result;
  const CpdPose refined = Refiner(clouds, options, result).run(toCentred(start, clouds));
  if (result.usable()) result.pose = fromCentred(refined, clouds);
  return result;
}

}  // namespace agricolmap::paper
