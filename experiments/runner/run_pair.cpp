#include "experiments/runner/run_pair.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <utility>

#include "agricolmap/core/affine_fit.hpp"

namespace agricolmap::experiments {
namespace {

/// Places of a strip at which its stated error is compared with the true one.
constexpr std::size_t kPlaces = 2000;
/// Squared Mahalanobis distance that nine of ten keep within in the plane.
constexpr double kNinetyPercent = 4.605;

/// "accepted", "ambiguous", "rejected", or "failed" without a transform.
std::string statusOf(const MethodOutcome& outcome) {
  if (!outcome.fixed_from_moving) return "failed";
  if (outcome.ambiguous) return "ambiguous";
  return outcome.accepted ? "accepted" : "rejected";
}

std::string stageText(const MethodTimes& times) {
  std::string text;
  for (const auto& [stage, seconds] : times.stages()) {
    text += fmt::format("{}{}={:.4f}", text.empty() ? "" : ";", stage, seconds);
  }
  return text;
}

/// Of all threads of this process so far [s].
double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void setErrors(const evaluate::RegistrationErrors& errors, Row& row) {
  row.rms = errors.rms;
  row.rms_horizontal = errors.rms_horizontal;
  row.rms_vertical = errors.rms_vertical;
  row.worst = errors.worst;
  row.rms_to_best_affine = errors.rms_to_best_affine;
  row.e_t = errors.translation;
  row.e_r = errors.rotation;
  row.e_s = errors.scale;
}

}  // namespace

PairRuns::PairRuns(Pair pair, int seed)
    : fixed_(std::move(pair.fixed)),
      guess_(pair.guess),
      overlaps_(pair.overlaps),
      seed_(seed),
      slips_(std::move(pair.slips)),
      unscaled_{std::move(pair.moving), std::move(pair.truth)} {}

const PairRuns::Moving& PairRuns::movingFor(const AddedError* error) {
  if (error == nullptr || error->scale == 0.0) return unscaled_;
  const auto [at, is_new] = scaled_.try_emplace(error->scale);
  Moving& moving = at->second;
  if (is_new) {
    const Eigen::Affine3d scaled = scaleError(*error, seed_, unscaled_.cloud);
    moving = unscaled_;
    transformCloud(moving.cloud, scaled);
    moving.truth.best_affine = unscaled_.truth.best_affine * scaled.inverse();
  }
  return moving;
}

Eigen::Affine3d PairRuns::guessFor(const Start& start) const {
  if (start.error == nullptr) return guess_;
  // The guess takes the file's lengths at face value; the middle is where it was.
  return wrongGuess(start.suite, *start.error, seed_, unscaled_.cloud, guess_);
}

void PairRuns::run(const Method& method, const Start& start, Row& row) {
  const Moving& moving = movingFor(start.error);
  row.negative = !overlaps_;
  row.fixed_points = static_cast<double>(fixed_->size());
  row.moving_points = static_cast<double>(moving.cloud.size());
  const MethodInput input{.fixed = *fixed_,
                          .moving = moving.cloud,
                          .guess = guessFor(start),
                          .prior = start.told,
                          .truth = moving.truth.best_affine};
  const Stopwatch watch;
  const double cpu = cpuSeconds();
  const MethodOutcome outcome = method.run(input);
  row.run_s = watch.seconds();
  row.cpu_s = cpuSeconds() - cpu;
  fillErrors(outcome, moving, row);
}

void PairRuns::fillDeformation(const MethodOutcome& outcome, const Moving& moving, Row& row) const {
  const evaluate::RegistrationErrors errors =
      evaluate::evaluateAligned(*outcome.aligned, moving.truth, moving.cloud);
  const evaluate::SuccessLimits limits;
  row.aligned_rms = errors.rms;
  row.aligned_rms_horizontal = errors.rms_horizontal;
  row.right = overlaps_ && errors.rms <= limits.rms;
  row.right_in_plane = overlaps_ && errors.rms_horizontal <= limits.rms;
  for (const Eigen::Vector3d& slip : slips_) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& found : outcome.slips) {
      nearest = std::min(nearest, (found - slip).head<2>().norm());
    }
    row.slip_place = std::isnan(row.slip_place) ? nearest : std::max(row.slip_place, nearest);
  }
  if (!std::isfinite(row.slip_place)) row.slip_place = kNotKnown;
  if (moving.truth.points.empty()) return;
  const std::size_t step = std::max<std::size_t>(1, moving.cloud.size() / kPlaces);
  double within = 0.0, count = 0.0;
  for (std::size_t i = 0; i < moving.cloud.size(); i += step) {
    const Eigen::Vector2d error =
        (outcome.aligned->filePoint(i) - moving.truth.points[i]).head<2>();
    const Eigen::Matrix2d covariance = outcome.place_covariance(moving.cloud.filePoint(i));
    within += error.dot(covariance.ldlt().solve(error)) <= kNinetyPercent ? 1.0 : 0.0;
    count += 1.0;
  }
  row.places_covered = within / count;
}

void PairRuns::fillErrors(const MethodOutcome& outcome, const Moving& moving, Row& row) const {
  row.status = statusOf(outcome);
  row.accepted = row.status == "accepted";
  row.message = outcome.why;
  row.stages = stageText(outcome.times);
  for (const auto& [name, value] : outcome.facts) row.*numberColumn(name) = value;
  if (!outcome.fixed_from_moving) return;
  const evaluate::RegistrationErrors errors =
      evaluate::evaluateTransform(*outcome.fixed_from_moving, moving.truth, moving.cloud);
  setErrors(errors, row);
  const evaluate::SuccessLimits limits;
  row.right = overlaps_ && errors.within(limits);
  row.right_in_plane = overlaps_ && errors.rms_horizontal <= limits.rms;
  row.aligned_rms = errors.rms;
  row.aligned_rms_horizontal = errors.rms_horizontal;
  if (!moving.truth.points.empty()) {
    const Eigen::Affine3d best = fitAffine(moving.cloud, moving.truth.points);
    row.best_affine_rms = evaluate::evaluateTransform(best, moving.truth, moving.cloud).rms;
  }
  if (outcome.aligned) fillDeformation(outcome, moving, row);
  if (!outcome.stated) return;
  if (const auto coverage = coverageOf(*outcome.fixed_from_moving, *outcome.stated, *fixed_,
                                       moving.cloud, moving.truth)) {
    row.pose_mahalanobis2 = coverage->pose_distance2;
    row.centre_mahalanobis2 = coverage->shift_distance2;
    // By its definition the error is what the truth differs by from what was found.
    row.centre_error_x = -coverage->error[0];
    row.centre_error_y = -coverage->error[1];
    const auto& covariance = outcome.stated->pose.covariance;
    row.centre_deviation_x = std::sqrt(covariance(0, 0));
    row.centre_deviation_y = std::sqrt(covariance(1, 1));
    row.centre_correlation = covariance(0, 1) / (row.centre_deviation_x * row.centre_deviation_y);
    row.height_error = coverage->height_error;
    row.height_mahalanobis2 = coverage->height_distance2;
  }
}

}  // namespace agricolmap::experiments
