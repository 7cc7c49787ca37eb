#include "agricolmap/pipeline/registration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/pipeline/unknown_scale.hpp"

namespace agricolmap::pipeline {
namespace {

void requireColours(const Cloud& fixed, const Cloud& moving, const RegistrationOptions& options) {
  if (options.geometry_only) return;
  for (const Cloud* cloud : {&fixed, &moving}) {
    if (!cloud->hasColour()) {
      throw InputError(fmt::format(
          "{}: has no colours; Excess Green needs them (use --geometry_only to register by height "
          "alone)",
          cloud->name));
    }
  }
}

/// Fills the transforms and their parts from the poses in the levelled frames.
void compose(const Cloud& fixed, const Cloud& moving, const refine::VerticalOptions& options,
             Registration& result) {
  const auto localOf = [&](const Eigen::Affine3d& levelled) -> Eigen::Affine3d {
    return result.frames.levelled_from_fixed.inverse() * levelled *
           result.frames.levelled_from_moving;
  };
  const auto inFiles = [&](const Eigen::Affine3d& local) -> Eigen::Affine3d {
    return Eigen::Translation3d(fixed.origin) * local * Eigen::Translation3d(-moving.origin);
  };
  for (Alternative& other : result.alternatives) {
    const refine::VerticalResult vertical =
        refine::fitVertical(result.fixed_map, result.moving_map, other.pose, options);
    other.fixed_from_moving = inFiles(localOf(refine::liftPose(other.pose, vertical)));
  }
  const Eigen::Affine3d levelled = refine::liftPose(result.pose, result.vertical);
  result.local_fixed_from_moving = localOf(levelled);
  result.fixed_from_moving = inFiles(result.local_fixed_from_moving);
  const Eigen::Matrix2d& axes = result.space.scale_axes;
  result.parts = splitHorizontal(axes.transpose() * result.pose.linear() * axes);
  result.tilt = result.vertical.slope.array().atan().matrix();
  const Eigen::Vector3d middle(result.space.centre.x(), result.space.centre.y(), 0.0);
  result.shift = levelled * middle - middle;
  result.centre = fixed.origin + result.frames.levelled_from_fixed.inverse() * (levelled * middle);
  result.has_transform = true;
}

/// A registration in the making.
class Registrar {
 public:
  Registrar(const Cloud& fixed, const Cloud& moving, const RegistrationOptions& options,
            StageTimes& times, const locate::Association* association)
      : fixed_(fixed),
        moving_(moving),
        options_(options),
        times_(times),
        association_(association) {}

  Registration run(const Eigen::Affine3d& guess) {
    prepare(guess);
    PairOutcome& outcome = result_;
    outcome = placer().search();
    return finish();
  }

  /// Tries the factors that the moving file may be off by, and registers anew from what the best
  /// of them found: with heights at the right scale, and cells of the right size.
  Registration runAtUnknownScale(const Eigen::Affine3d& guess) {
    prepare(guess);
    const std::vector<double> factors = scaleFactors(moving_box_, fixed_box_, options_.prior);
    // What the points would add is not worth their time at a dozen scales that are wrong.
    RegistrationOptions trial = options_;
    if (trial.refine == RefineKind::kDenseCpd) trial.refine = RefineKind::kDense;
    std::optional<Found> best;
    for (const double factor : factors) {
      const Eigen::Affine3d scaled = scaledGuess(guess, factor);
      prepareMoving(scaled);
      std::optional<PairOutcome> next = placer(trial).searchOnce(0, nullptr);
      if (!next || (best && !better(*next, best->outcome))) continue;
      best = Found{factor, scaled, result_.frames, *std::move(next)};
      if (best->outcome.verdict.status == verdict::Status::kAccepted) break;
    }
    if (!best) {
      throw InputError(fmt::format(
          "{}: at no scale between 0.1 and 10 does it fit into the fixed map {} and still hold "
          "more than a few plants",
          moving_.name, fixed_.name));
    }
    result_.counts = best->outcome.counts;
    if (best->outcome.has_transform)
      settleAt(*best, guess);
    else
      static_cast<PairOutcome&>(result_) = std::move(best->outcome);
    return finish();
  }

 private:
  /// What one factor of an unknown scale led to.
  struct Found {
    double factor;
    Eigen::Affine3d guess;
    PairFrames frames;
    PairOutcome outcome;
  };

  /// 1. Level (assumption 5: only the moving map's scale is in question). 2. Multimodal grid maps
  /// (Sec. III-A).
  void prepare(const Eigen::Affine3d& guess) {
    const Eigen::Affine3d centred = centredGuess(fixed_, moving_, guess, options_.prior);
    times_.run("level", [&] { levelFixed(fixed_, options_.level, result_.frames); });
    fixed_box_ = result_.frames.fixed_footprint.box;
    levelAndBound(centred);
    if (!options_.prior.scale_unknown) {
      requirePlausibleExtents(fixed_, moving_, fixed_box_, moving_box_);
    }
    times_.run("grid", [&] {
      chooseCells();
      // Room for the high-pass.
      const map::Box2 window =
          options_.prior.scale_unknown
              ? fixed_box_
              : reachableWindow(moving_box_, result_.space, 2.0 * options_.signal.high_pass);
      result_.fixed_map = map::makeGridMap(fixed_, result_.frames.levelled_from_fixed,
                                           window.intersection(fixed_box_), grid_);
      result_.fixed_map.ground_deviation = result_.frames.fixed.roughness;
      if (!options_.prior.scale_unknown) gridMoving();
    });
  }

  /// Cells that both clouds fill.
  void chooseCells() {
    double spacing = result_.frames.fixed_footprint.spacing();
    if (!options_.prior.scale_unknown) {
      spacing = std::max(spacing, result_.frames.moving_footprint.spacing());
    }
    grid_ = map::coarsened(options_.grid, spacing);
  }

  void levelAndBound(const Eigen::Affine3d& guess) {
    times_.run("level",
               [&] { levelMoving(fixed_, moving_, guess, options_.level, result_.frames); });
    moving_box_ = result_.frames.moving_footprint.box;
    result_.space = searchSpace(moving_box_, result_.frames, options_.prior);
  }

  void gridMoving() {
    result_.moving_map =
        map::makeGridMap(moving_, result_.frames.levelled_from_moving, moving_box_, grid_);
    result_.moving_map.ground_deviation = result_.frames.moving.roughness;
  }

  void prepareMoving(const Eigen::Affine3d& guess) {
    levelAndBound(guess);
    times_.run("grid", [&] { gridMoving(); });
  }

  PairPlacer placer() { return placer(options_); }
  /// `options` must outlive it.
  PairPlacer placer(const RegistrationOptions& options) {
    return {result_.fixed_map, result_.moving_map, result_.space, options, times_, association_};
  }

  /// The guess with the moving cloud made larger about its middle.
  Eigen::Affine3d scaledGuess(const Eigen::Affine3d& guess, double factor) const {
    const Eigen::Affine3d centred = centredGuess(fixed_, moving_, guess, options_.prior);
    const Eigen::Vector3d middle = meanOf(moving_);
    return centred * Eigen::Translation3d(middle) * Eigen::UniformScaling<double>(factor) *
           Eigen::Translation3d(-middle);
  }

  void settleAt(const Found& found, const Eigen::Affine3d& guess) {
    const Eigen::Matrix2d& axes = result_.space.scale_axes;
    const HorizontalParts parts =
        splitHorizontal(axes.transpose() * found.outcome.pose.linear() * axes);
    scale_ = found.factor * std::sqrt(parts.scale_x * parts.scale_y);
    const Eigen::Affine3d scaled = scaledGuess(guess, scale_);
    prepareMoving(scaled);
    // Levelled moving of now → levelled moving of then, in the plane.
    const Eigen::Affine3d then_from_now =
        found.frames.levelled_from_moving * result_.frames.levelled_from_moving.inverse();
    Eigen::Affine2d plane = Eigen::Affine2d::Identity();
    plane.linear() = then_from_now.linear().topLeftCorner<2, 2>();
    plane.translation() = then_from_now.translation().head<2>();
    Placement placement;
    placement.score = found.outcome.evidence.significance;
    for (const double u : {0.0, 0.5, 1.0}) {
      for (const double v : {0.0, 0.5, 1.0}) {
        const Eigen::Vector2d point =
            moving_box_.min() + moving_box_.sizes().cwiseProduct(Eigen::Vector2d(u, v));
        placement.matches.push_back({point, found.outcome.pose * plane * point});
      }
    }
    std::vector<RefinedPose> rivals = found.outcome.rivals;
    for (RefinedPose& rival : rivals) rival.pose = rival.pose * plane;
    const std::vector<std::pair<std::string, double>> counts = result_.counts;
    PairOutcome& outcome = result_;
    outcome = placer().settle(placement, std::move(rivals));
    outcome.counts.insert(outcome.counts.begin(), counts.begin(), counts.end());
  }

  Registration finish() {
    if (result_.has_transform) {
      compose(fixed_, moving_, options_.vertical, result_);
      result_.parts.scale_x *= scale_;
      result_.parts.scale_y *= scale_;
      result_.vertical_scale *= scale_;
    }
    return std::move(result_);
  }

  const Cloud& fixed_;
  const Cloud& moving_;
  const RegistrationOptions& options_;
  StageTimes& times_;
  const locate::Association* association_;
  Registration result_;
  map::GridOptions grid_;
  map::Box2 fixed_box_;
  map::Box2 moving_box_;
  double scale_ = 1.0;  ///< that the moving file was enlarged by
};

}  // namespace

Registration registerClouds(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                            const RegistrationOptions& chosen, StageTimes& times,
                            const locate::Association* association) {
  checkOptions(chosen);
  RegistrationOptions options = chosen;
  requireColours(fixed, moving, options);
  if ((options.prior.anywhere() || options.prior.scale_unknown) && association == nullptr &&
      options.association == AssociationKind::kFlow) {
    throw UsageError(
        "the flow needs to know about where to look and at what scale: give --prior-sigma with a "
        "translation and no --scale-unknown, or use --association correlation");
  }
  if (options.geometry_only) {
    options.signal.term = map::DataTerm::kHeight;
    options.flow.describe.term = map::DataTerm::kHeight;
  }
  Registrar registrar(fixed, moving, options, times, association);
  return options.prior.scale_unknown ? registrar.runAtUnknownScale(guess) : registrar.run(guess);
}

}  // namespace agricolmap::pipeline
