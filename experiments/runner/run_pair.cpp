#include "experiments/runner/run_pair.hpp"

#include <fmt/format.h>

#include <ctime>
#include <utility>

namespace agricolmap::experiments {
namespace {

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
  if (!outcome.stated) return;
  if (const auto coverage = coverageOf(*outcome.fixed_from_moving, *outcome.stated, *fixed_,
                                       moving.cloud, moving.truth)) {
    row.pose_mahalanobis2 = coverage->pose_distance2;
    row.centre_mahalanobis2 = coverage->shift_distance2;
    row.height_error = coverage->height_error;
    row.height_mahalanobis2 = coverage->height_distance2;
  }
}

}  // namespace agricolmap::experiments
