#include "agricolmap/pipeline/followed.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::pipeline {
namespace {

/// What may be lost in drawing the straightened map: of the significance, which hangs on the finest
/// that the maps show, and of the correlation.
constexpr double kLeastKept = 0.8;
constexpr double kMostLost = 0.01;
/// A slip has a place and an offset.
constexpr double kFreedomOfSlip = 3.0;

/// What the slices of the evidence, which lie straight across the strip, tell of where pieces of it
/// along the path lie.
std::vector<deform::PieceOffset> piecesOf(const verdict::Evidence& evidence,
                                          const deform::Path& path) {
  std::vector<deform::PieceOffset> pieces;
  for (const verdict::SliceOffset& slice : evidence.parts.slices) {
    pieces.push_back({path.place(evidence.strip.world({slice.along, 0.0})).along, slice.offset});
  }
  std::stable_sort(
      pieces.begin(), pieces.end(),
      [](const deform::PieceOffset& a, const deform::PieceOffset& b) { return a.along < b.along; });
  return pieces;
}

/// Whether the strip, bend taken out, is one and fits no worse.
bool fitsAsOne(const Placed& straight, const Placed& bent) {
  return straight.uncertainty && bent.uncertainty && !straight.evidence.parts.apart() &&
         straight.heights.status == refine::VerticalStatus::kOk &&
         straight.evidence.agreement() >= bent.evidence.agreement() - 1e-9 &&
         straight.evidence.significance >= kLeastKept * bent.evidence.significance &&
         straight.correlation >= bent.correlation - kMostLost;
}

/// How freely the bend could follow chance: its coefficients.
double freedomOf(const deform::Deformation& deformation) {
  return 2.0 * deformation.basis().size() +
         kFreedomOfSlip * static_cast<double>(deformation.slips.size());
}

/// The bend comes before the pose that was found with it, and the heights' tilt behind both.
Eigen::Matrix3d throughPose(const Placed& placed) {
  Eigen::Matrix3d before = Eigen::Matrix3d::Identity();
  before.topLeftCorner<2, 2>() = placed.followed->bend.pose.linear().inverse();
  return refine::liftPose(placed.pose, placed.heights).linear() * before;
}

}  // namespace

void followBends(const refine::PairSignals& signals, const SearchSpace& space,
                 const std::optional<deform::Path>& known, const Refined& refined,
                 const RegistrationOptions& options, Monitor& monitor, Placed& placed) {
  if (options.deform == DeformKind::kNone || options.refine != RefineKind::kDense ||
      placed.heights.status != refine::VerticalStatus::kOk) {
    return;
  }
  const deform::Path path =
      known ? *known
            : deform::straightPath(map::stripFrame(signals.moving().at(refine::kRankingFactor)));
  std::optional<deform::Bend> bend = monitor.run(Stage::kDeform, [&] {
    return deform::followBend(signals, placed.pose, placed.heights, path,
                              piecesOf(placed.evidence, path), options.bend);
  });
  if (!bend) return;
  Followed followed = monitor.run(Stage::kDeform, [&] {
    map::GridMap straight = deform::straightened(signals.moving().grid(), *bend);
    const Eigen::Affine2d longest =
        deform::moveOfLongestStretch(signals.moving().at(refine::kRankingFactor), *bend);
    return Followed{*std::move(bend), std::move(straight), longest};
  });
  const correlation::MapSignals moving(followed.straight, options.signal);
  const refine::PairSignals straight = monitor.run(Stage::kDeform, [&] {
    return refine::PairSignals(signals.fixed(), moving, options.hidden, options.filter);
  });
  refine::RefinedPose pose = *refined.best;
  pose.pose = followed.bend.pose;
  // What was found for a strip in parts is a compromise between them, in scale and shear, too.
  refine::DenseRefineOptions near = options.dense;
  near.hops = 0;
  const auto found =
      monitor.run(Stage::kRefine, [&] { return refine::refineFrom(straight, pose.pose, near); });
  if (found) pose.pose = found->pose;
  Placed next = measure(straight, space, pose, refined, options, monitor);
  if (!fitsAsOne(next, placed)) return;
  verdict::discountFreedom(next.evidence, placed.evidence.significance,
                           freedomOf(followed.bend.deformation));
  const double doubt =
      verdict::doubtOfBend(followed.bend.rms, *placed.uncertainty, *next.uncertainty);
  // One that with its doubt leaves the blocks as far apart as they were moves points for nothing.
  if (!placed.evidence.parts.apart() &&
      std::hypot(next.uncertainty->scatter_rms, doubt) >= placed.uncertainty->scatter_rms) {
    return;
  }
  next.uncertainty->expected_rms =
      std::hypot(next.uncertainty->expected_rms, deform::slipRms(followed.bend.deformation), doubt);
  next.followed = std::move(followed);
  placed = std::move(next);
}

Displacement::Displacement(const Registration& registration, const Cloud& moving)
    : registration_(registration),
      file_from_levelled_(registration.maps.frames.levelled_from_fixed.inverse().linear()),
      function_(
          registration.placed->followed->bend.deformation,
          registration.maps.frames.levelled_from_moving * Eigen::Translation3d(-moving.origin),
          file_from_levelled_ * throughPose(*registration.placed)) {}

Eigen::Vector3d Displacement::inFile(const Eigen::Vector3d& levelled) const {
  return file_from_levelled_ * levelled;
}

Eigen::Vector3d Displacement::at(const Eigen::Vector3d& moving_point) const {
  return function_.at(moving_point);
}

Eigen::Vector3d Displacement::place(const Eigen::Vector3d& moving_point) const {
  return registration_.transform->fixed_from_moving * moving_point + at(moving_point);
}

Eigen::Vector3d Displacement::pathPoint(double along) const {
  const deform::Path& path = registration_.placed->followed->bend.deformation.path();
  const Eigen::Vector2d point = path.point(along);
  return function_.levelledFromMoving().inverse() * Eigen::Vector3d(point.x(), point.y(), 0.0);
}

Eigen::Matrix3d Displacement::covarianceAt(const Eigen::Vector3d& moving_point) const {
  const Placed& placed = *registration_.placed;
  const deform::Deformation& deformation = placed.followed->bend.deformation;
  const Eigen::Vector2d point = (function_.levelledFromMoving() * moving_point).head<2>();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      verdict::placeCovariance(*placed.uncertainty, deformation.covarianceAt(point));
  const double height =
      std::pow(placed.uncertainty->height_deviation, 2) + std::pow(deformation.height_deviation, 2);
  // Of clouds without heights it is infinite, and times a zero of the rotation no number: what is
  // known of the plane would be lost with it.
  const bool known = std::isfinite(height);
  covariance(2, 2) = known ? height : 0.0;
  covariance = file_from_levelled_ * covariance * file_from_levelled_.transpose();
  if (!known) covariance(2, 2) = height;
  return covariance;
}

Cloud alignedCloud(const Registration& registration, const Cloud& moving) {
  const Eigen::Affine3d& transform = registration.transform->fixed_from_moving;
  Cloud aligned;
  aligned.name = moving.name;
  aligned.rgb = moving.rgb;
  aligned.origin = (transform * moving.origin).array().round().matrix();
  aligned.xyz.resize(moving.size());
  const std::optional<Displacement> displacement =
      registration.bent() ? std::optional<Displacement>(std::in_place, registration, moving)
                          : std::nullopt;
  parallelFor(
      moving.size(),
      [&](std::size_t i) {
        const Eigen::Vector3d point = moving.filePoint(i);
        Eigen::Vector3d place = transform * point;
        if (displacement) place += displacement->at(point);
        aligned.xyz[i] = (place - aligned.origin).cast<float>();
      },
      1U << 12);
  return aligned;
}

}  // namespace agricolmap::pipeline
