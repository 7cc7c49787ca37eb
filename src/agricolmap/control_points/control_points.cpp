#include "agricolmap/control_points/control_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "agricolmap/control_points/control_points_fit.hpp"
#include "agricolmap/control_points/control_points_robust.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::control_points {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Smaller shares of the widest spread (6 cm over a strip of 10 m) would make a scale of the error
/// of picking.
constexpr double kLeastSpread = 0.02;

/// What gives rise to a warning.
constexpr double kFarLeftOut = 2.0;      ///< left-out residuals in residuals; six pairs have 1.8
constexpr double kLooseScale = 0.01;     ///< deviation of a scale
constexpr double kLargeResidual = 0.05;  ///< as far off as a registration may be (paper, V-A) [m]

/// Throws unless the pairs with weight determine the model.
void requireSpread(const ControlFit& problem, std::span<const double> weights, ControlModel model,
                   const std::string& source, std::string_view which) {
  const PairSpread spread = spreadOf(problem.places(), weights);
  if (!(spread.along > kLeastPickSigma)) {
    throw InputError(fmt::format(
        "{}: {} lie on one spot of the moving map; pick pairs all over the strip", source, which));
  }
  if (spread.across < kLeastSpread * spread.along) {
    throw InputError(fmt::format(
        "{}: {} lie on a line in the moving map ({:.3f} m to its sides, {:.3f} m along it, RMS), "
        "which does not determine the scale across; add pairs on both sides of it",
        source, which, spread.across, spread.along));
  }
  if (model == ControlModel::kAffine && spread.thinnest < kLeastSpread * spread.widest) {
    throw InputError(fmt::format(
        "{}: {} lie in a plane of the moving map ({:.3f} m off it, {:.3f} m along it, RMS), which "
        "does not determine a full affine; add pairs of other heights or use the model 'scales'",
        source, which, spread.thinnest, spread.widest));
  }
}

/// Adds up residuals that are chosen by the caller.
class AxisSums {
 public:
  void add(const Eigen::Vector3d& residual) {
    ++count_;
    sum_ += residual;
    squares_ += residual.cwiseProduct(residual);
  }
  AxisErrors errors() const {
    const double n = count_ > 0 ? static_cast<double>(count_) : kNan;
    return {count_, sum_ / n, (squares_ / n).cwiseSqrt()};
  }

 private:
  std::size_t count_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares_ = Eigen::Vector3d::Zero();
};

void judge(std::span<const ControlPair> pairs, const ControlFit& problem,
           const Eigen::Affine3d& local, const std::vector<double>& weights, double tukey,
           ControlEstimate& estimate) {
  const PickSigmas sigmas{estimate.sigma_horizontal, estimate.sigma_vertical};
  for (const ControlPair& pair : pairs) {
    PairResidual result;
    result.residual = problem.residual(local, pair);
    result.left_out.setConstant(kNan);
    result.outlier = sigmas.distance(result.residual) >= tukey;
    estimate.residuals.push_back(result);
  }
  for (std::size_t k = 0; k < problem.size(); ++k) {
    estimate.residuals[problem.given()[k]].weight = weights[k];
  }
}

/// Leaves out each control pair in turn, the weights of the others as they are: its own residual
/// then, and what the parts of the transformation do (jackknife).
void leaveOut(std::span<const ControlPair> pairs, const ControlFit& problem,
              const std::vector<double>& weights, ControlEstimate& estimate) {
  std::vector<std::optional<Eigen::Affine3d>> fits(problem.size());
  parallelFor(problem.size(), [&](std::size_t k) {
    std::vector<double> others = weights;
    others[k] = 0.0;
    fits[k] = problem.fit(others);
    if (!fits[k]) return;
    const std::size_t i = problem.given()[k];
    estimate.residuals[i].left_out = problem.residual(*fits[k], pairs[i]);
  });
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  Eigen::Vector3d scale = Eigen::Vector3d::Zero();
  Eigen::Vector3d shear = Eigen::Vector3d::Zero();
  std::size_t used = 0;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (!(weights[k] > 0.0)) continue;
    ++used;
    if (!fits[k]) {
      angles.setConstant(kNan);
      scale.setConstant(kNan);
      shear.setConstant(kNan);
      break;
    }
    const ControlParts parts = splitLinear(fits[k]->linear());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double turn = wrapAngle(parts.angles[axis] - estimate.parts.angles[axis]);
      angles[axis] += turn * turn;
    }
    scale += (parts.scale - estimate.parts.scale).cwiseAbs2();
    shear += (parts.shear - estimate.parts.shear).cwiseAbs2();
  }
  const double factor = used > 0 ? 1.0 - 1.0 / static_cast<double>(used) : kNan;
  estimate.deviations = {(factor * angles).cwiseSqrt(), (factor * scale).cwiseSqrt(),
                         (factor * shear).cwiseSqrt()};
}

void sumUp(std::span<const ControlPair> pairs, ControlEstimate& estimate) {
  AxisSums control, left_out, check;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PairResidual& result = estimate.residuals[i];
    if (pairs[i].use == PairUse::kCheck) {
      check.add(result.residual);
    } else if (!result.outlier) {
      control.add(result.residual);
      left_out.add(result.left_out);
    }
  }
  estimate.control = control.errors();
  estimate.left_out = left_out.errors();
  estimate.check = check.errors();
}

std::string namesOf(std::span<const ControlPair> pairs, const ControlEstimate& estimate,
                    PairUse use) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].use == use && estimate.residuals[i].outlier) names.push_back(pairs[i].name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void warnLeftOut(std::span<const ControlPair> pairs, ControlEstimate& estimate) {
  std::vector<std::string> needed;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PairResidual& result = estimate.residuals[i];
    if (result.weight > 0.0 && !result.left_out.allFinite()) needed.push_back(pairs[i].name);
  }
  if (!needed.empty()) {
    estimate.warnings.push_back(fmt::format(
        "without {} the others do not determine the transformation, so that a mistake there would "
        "go unseen; pick more pairs",
        fmt::join(needed, " or ")));
    return;
  }
  const double fitted = std::max(estimate.control.spatial(), kLeastPickSigma);
  if (estimate.left_out.spatial() <= kFarLeftOut * fitted) return;
  estimate.warnings.push_back(fmt::format(
      "left out, the control pairs are {:.3f} m off, in the fit {:.3f} m: there are too "
      "few of them; pick more",
      estimate.left_out.spatial(), estimate.control.spatial()));
}

void warn(std::span<const ControlPair> pairs, ControlEstimate& estimate) {
  std::vector<std::string>& warnings = estimate.warnings;
  if (const std::string names = namesOf(pairs, estimate, PairUse::kControl); !names.empty()) {
    warnings.push_back(fmt::format(
        "outliers that were set aside: {}; look at these pairs again in both maps", names));
  }
  if (const std::string names = namesOf(pairs, estimate, PairUse::kCheck); !names.empty()) {
    warnings.push_back(fmt::format(
        "check points further off than the control points explain: {}; they count all the same",
        names));
  }
  if (estimate.check.count == 0) {
    warnings.push_back(
        "no check points: nothing that was not fitted says how good the transformation is");
  }
  warnLeftOut(pairs, estimate);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!(estimate.deviations.scale[axis] > kLooseScale)) continue;
    warnings.push_back(fmt::format(
        "the scale along the moving file's {} is known to {:.1f} % only; pick pairs further apart "
        "in that direction",
        "xyz"[axis], 100.0 * estimate.deviations.scale[axis]));
  }
  if (estimate.control.spatial() > kLargeResidual) {
    warnings.push_back(fmt::format(
        "the control pairs are {:.3f} m off (RMS), more than the {:.2f} m that a registration may "
        "be: this is no truth to measure it by",
        estimate.control.spatial(), kLargeResidual));
  }
}

}  // namespace

std::string_view toString(ControlModel model) {
  return model == ControlModel::kScales ? "scales" : "affine";
}

std::size_t neededPairs(ControlModel model) { return minimalPairs(model) + 1; }

ControlEstimate estimateFromPairs(std::span<const ControlPair> pairs, const ControlOptions& options,
                                  const std::string& source) {
  const ControlFit problem(pairs, options);
  const std::size_t needed = neededPairs(options.model);
  if (problem.size() < needed) {
    throw InputError(fmt::format("{}: {} control pairs; the model '{}' needs {} at least", source,
                                 problem.size(), toString(options.model), needed));
  }
  std::vector<double> weights(problem.size(), 1.0);
  requireSpread(problem, weights, options.model, source, "the control pairs");
  const auto start = problem.leastMedian();
  if (!start) {
    throw InputError(
        fmt::format("{}: the control pairs fit only a mirrored map; are x and y (easting and "
                    "northing) the wrong way round on one side, or do most pairs lie on a line?",
                    source));
  }
  auto local = problem.reweighted(*start, problem.sigmas(*start), weights);
  const PickSigmas sigmas = problem.sigmas(local.value_or(*start));
  if (local) local = problem.reweighted(*local, sigmas, weights);
  const auto agreeing = static_cast<std::size_t>(
      std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0.0; }));
  if (!local || agreeing < needed) {
    throw InputError(
        fmt::format("{}: fewer than {} control pairs agree with each other; look at "
                    "them again in both maps",
                    source, needed));
  }
  requireSpread(problem, weights, options.model, source, "the control pairs that agree");

  ControlEstimate estimate;
  estimate.model = options.model;
  estimate.fixed_from_moving = problem.inFileCoordinates(*local);
  estimate.parts = splitLinear(local->linear());
  estimate.sigma_horizontal = sigmas.horizontal;
  estimate.sigma_vertical = sigmas.vertical;
  judge(pairs, problem, *local, weights, options.tukey, estimate);
  leaveOut(pairs, problem, weights, estimate);
  sumUp(pairs, estimate);
  warn(pairs, estimate);
  return estimate;
}

}  // namespace agricolmap::control_points
