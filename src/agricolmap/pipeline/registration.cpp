#include "agricolmap/pipeline/registration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/pipeline/refinement.hpp"

namespace agricolmap {
namespace {

// Beyond this ratio of areas "moving" and "fixed" were swapped, or one is in other units.
constexpr double kMaxAreaRatio = 4.0;

// The second attempt of the correlation search.
constexpr double kFinerCell = 2.0 / 3.0;
constexpr int kMoreClimbs = 3;

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

struct PointSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  PointSum& operator+=(const PointSum& other) {
    sum += other.sum;
    return *this;
  }
};

/// Mean of the cloud's points in its file's coordinates.
Eigen::Vector3d meanOf(const Cloud& cloud) {
  if (cloud.xyz.empty()) return cloud.origin;
  const PointSum total =
      parallelSum<PointSum>(cloud.size(), 1U << 16, {}, [&](std::size_t begin, std::size_t end) {
        PointSum part;
        for (std::size_t i = begin; i < end; ++i) part.sum += cloud.xyz[i].cast<double>();
        return part;
      });
  return cloud.origin + total.sum / static_cast<double>(cloud.size());
}

/// Where the guess says nothing about the place, the middles of the clouds are laid together, so
/// that all that follows counts from there, however far apart the files' coordinates are.
Eigen::Affine3d centredGuess(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                             const PriorUncertainty& uncertainty) {
  if (!uncertainty.anywhere()) return guess;
  return Eigen::Translation3d(meanOf(fixed) - guess * meanOf(moving)) * guess;
}

PairFrames levelPair(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                     const LevelOptions& options) {
  // In double and about the origins, so that UTM coordinates cancel before anything is float.
  const Eigen::Affine3d guess_local =
      Eigen::Translation3d(-fixed.origin) * guess * Eigen::Translation3d(moving.origin);
  PairFrames frames;
  frames.fixed = levelCloud(fixed, Eigen::Affine3d::Identity(), options);
  frames.moving = levelCloud(moving, guess_local, options);
  frames.levelled_from_fixed = frames.fixed.levelled_from_guess;
  frames.levelled_from_moving = frames.moving.levelled_from_guess * guess_local;
  return frames;
}

struct Box2Sum {
  Box2 box;
  Box2Sum& operator+=(const Box2Sum& other) {
    box.extend(other.box);
    return *this;
  }
};

/// Horizontal bounds of the cloud in the levelled frame.
Box2 boundsOf(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local) {
  return parallelSum<Box2Sum>(
             cloud.size(), 1U << 16, {},
             [&](std::size_t begin, std::size_t end) {
               Box2Sum part;
               for (std::size_t i = begin; i < end; ++i) {
                 part.box.extend(
                     (levelled_from_local * cloud.xyz[i].cast<double>()).head<2>().eval());
               }
               return part;
             })
      .box;
}

/// The part of the fixed frame that the moving map can reach, with a rim for the high-pass.
Box2 reachableWindow(const Box2& moving, const SearchSpace& space, double rim) {
  const double heading = space.uncertainty.heading_deg * std::numbers::pi / 180.0;
  const double stretch = std::exp(logScaleLimit(space.uncertainty));
  Box2 window;
  for (const double yaw : {-heading, 0.0, heading}) {
    for (int corner = 0; corner < 4; ++corner) {
      const Eigen::Vector2d arm =
          moving.corner(static_cast<Box2::CornerType>(corner)) - space.centre;
      window.extend((space.centre + stretch * (rotation2(yaw) * arm)).eval());
    }
  }
  const double margin = space.uncertainty.translation + rim;
  window.extend((window.min() - Eigen::Vector2d::Constant(margin)).eval());
  window.extend((window.max() + Eigen::Vector2d::Constant(margin)).eval());
  return window;
}

SearchSpace searchSpace(const Box2& moving, const PairFrames& frames,
                        const PriorUncertainty& uncertainty) {
  SearchSpace space;
  space.uncertainty = uncertainty;
  space.centre = moving.center();
  const Eigen::Matrix2d axes = frames.levelled_from_moving.linear().topLeftCorner<2, 2>();
  space.scale_axes = axes.colwise().normalized();
  return space;
}

void gridPair(const Cloud& fixed, const Cloud& moving, const RegistrationOptions& options,
              Registration& result) {
  const Box2 moving_box = boundsOf(moving, result.frames.levelled_from_moving);
  const Box2 fixed_box = boundsOf(fixed, result.frames.levelled_from_fixed);
  if (moving_box.volume() > kMaxAreaRatio * fixed_box.volume()) {
    throw InputError(fmt::format(
        "{}: covers {:.3g} x {:.3g} m, far more than the fixed map {} with {:.3g} x {:.3g} m; are "
        "FIXED and MOVING swapped, or their units different?",
        moving.name, moving_box.sizes().x(), moving_box.sizes().y(), fixed.name,
        fixed_box.sizes().x(), fixed_box.sizes().y()));
  }
  result.space = searchSpace(moving_box, result.frames, options.prior);
  const Box2 window = reachableWindow(moving_box, result.space, 2.0 * options.signal.high_pass);
  result.fixed_map = makeGridMap(fixed, result.frames.levelled_from_fixed,
                                 window.intersection(fixed_box), options.grid);
  result.moving_map =
      makeGridMap(moving, result.frames.levelled_from_moving, moving_box, options.grid);
  result.counts = {{"fixed_cells", static_cast<double>(result.fixed_map.filled)},
                   {"moving_cells", static_cast<double>(result.moving_map.filled)}};
}

std::unique_ptr<Association> makeAssociation(const RegistrationOptions& options) {
  if (options.association == AssociationKind::kFlow) {
    return std::make_unique<FlowAssociation>(options.flow);
  }
  CorrelationOptions search = options.search;
  search.signal = options.signal;
  return std::make_unique<CorrelationSearch>(search);
}

/// moving levelled → fixed levelled, with the vertical part.
Eigen::Affine3d lift(const Eigen::Affine2d& pose, const VerticalResult& vertical) {
  Eigen::Affine3d lifted = Eigen::Affine3d::Identity();
  lifted.linear().topLeftCorner<2, 2>() = pose.linear();
  lifted.translation().head<2>() = pose.translation();
  lifted.linear().row(2).head<2>() = vertical.slope.transpose() * pose.linear();
  lifted.translation().z() =
      vertical.offset + vertical.slope.dot(pose.translation() - vertical.about);
  return lifted;
}

/// Fills the transforms and their parts from the pose in the levelled frames.
void compose(const Cloud& fixed, const Cloud& moving, Registration& result) {
  const Eigen::Affine3d levelled = lift(result.pose, result.vertical);
  result.local_fixed_from_moving =
      result.frames.levelled_from_fixed.inverse() * levelled * result.frames.levelled_from_moving;
  result.fixed_from_moving = Eigen::Translation3d(fixed.origin) * result.local_fixed_from_moving *
                             Eigen::Translation3d(-moving.origin);
  const Eigen::Matrix2d& axes = result.space.scale_axes;
  result.parts = splitHorizontal(axes.transpose() * result.pose.linear() * axes);
  result.tilt = result.vertical.slope.array().atan().matrix();
  const Eigen::Vector3d middle(result.space.centre.x(), result.space.centre.y(), 0.0);
  result.shift = levelled * middle - middle;
  result.centre = fixed.origin + result.frames.levelled_from_fixed.inverse() * (levelled * middle);
  result.has_transform = true;
}

/// Stages 3 to 8 on gridded maps.
void place(const PoseRefinement& refinement, const Association& association,
           const RegistrationOptions& options, StageTimes& times, Registration& result) {
  // 3.–5. Data association: descriptors, flow and vote (Sec. III-B), or the correlation search.
  result.association =
      association.associate(result.fixed_map, result.moving_map, result.space, times);
  result.counts.insert(result.counts.end(), result.association.counts.begin(),
                       result.association.counts.end());
  // 6. Affine with two scales per placement (Eq. 3); 7. refinement of the best.
  const RefineOutcome refined =
      refinement.choose(result.association.placements, times, result.counts);
  result.has_transform = refined.best.has_value();
  if (!refined.best) {
    result.verdict = rejectBecause(refined.failure);
    return;
  }
  result.pose = refined.best->pose;
  const Fit fit = refinement.fit(result.pose);
  result.overlap = fit.overlap;
  result.correlation = fit.correlation;
  result.vertical = times.run("vertical", [&] {
    return fitVertical(result.fixed_map, result.moving_map, result.pose, options.vertical);
  });
  // 8. Verdict.
  times.run("verdict", [&] {
    result.evidence = refinement.evidence(result.pose);
    result.verdict =
        judge(result.evidence, result.overlap, result.pose, result.space, options.verdict);
  });
  if (result.vertical.status != VerticalStatus::kOk) {
    result.verdict = rejectBecause("the heights of the two maps do not fit one another");
  }
}

}  // namespace

Registration registerClouds(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                            const RegistrationOptions& chosen, StageTimes& times) {
  checkOptions(chosen);
  RegistrationOptions options = chosen;
  requireColours(fixed, moving, options);
  if (options.prior.anywhere() && options.association == AssociationKind::kFlow) {
    throw UsageError(
        "the flow needs to know about where to look: give --prior-sigma with a translation, or use "
        "--association correlation");
  }
  if (options.geometry_only) {
    options.signal.term = DataTerm::kHeight;
    options.flow.describe.term = DataTerm::kHeight;
  }
  Registration result;
  // 1. Level (assumption 5: only the moving map's scale is in question).
  result.frames = times.run("level", [&] {
    return levelPair(fixed, moving, centredGuess(fixed, moving, guess, options.prior),
                     options.level);
  });
  // 2. Multimodal grid maps (Sec. III-A).
  times.run("grid", [&] { gridPair(fixed, moving, options, result); });
  const PoseRefinement refinement(result.fixed_map, result.moving_map, result.space, options);
  const std::vector<std::pair<std::string, double>> grid_counts = result.counts;
  // What the search at its usual cell size does not find convincingly is looked for once more in
  // finer cells: dearer, and needed where the canopy is closed and only leaves tell places apart.
  const int attempts = options.association == AssociationKind::kCorrelation ? 2 : 1;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    result.counts = grid_counts;
    result.counts.emplace_back("attempts", attempt + 1.0);
    place(refinement, *makeAssociation(options), options, times, result);
    if (result.verdict.status == Status::kAccepted) break;
    options.search.cell *= kFinerCell;
    options.search.climbs *= kMoreClimbs;
  }
  if (result.has_transform) compose(fixed, moving, result);
  return result;
}

}  // namespace agricolmap
