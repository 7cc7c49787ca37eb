#include "agricolmap/paper/estimate_affine.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "agricolmap/core/random.hpp"
#include "agricolmap/core/scaled_rotation.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::paper {

void describe(OptionTable& table, AffineOptions& options) {
  table.choice("model", options.model, {"scaled_rotation", "free"}, "what the transform may do");
  table.flag("robust", options.robust,
             "set outliers aside; off: least squares over all matches, as in the paper");
  table.number("tukey", options.tukey, 2.0, 20.0, "deviations", "residual that gets no weight");
  table.integer("least", options.least, 4, 1000000, "", "matches needed");
  table.integer("starts", options.starts, 1, 100000, "", "random minimal fits to start from");
  table.integer("seed", options.seed, 0, 2147483647, "", "of the random fits");
}

std::string_view name(AffineStatus status) {
  switch (status) {
    case AffineStatus::kOk:
      return "ok";
    case AffineStatus::kTooFewMatches:
      return "too few matches";
    case AffineStatus::kDegenerate:
      return "degenerate matches";
  }
  return "unknown";
}

namespace {

constexpr std::size_t kMinimal = 4;    ///< matches of a random fit; 3 would do, 4 is steadier
constexpr std::size_t kScored = 1000;  ///< matches that a random fit is judged by
constexpr int kReweights = 30;
constexpr double kMedianToSigma = 1.1774;  ///< median of a 2-D normal's distance, in deviations
constexpr double kLeastSigma = 1e-6;       ///< keeps exact data from dividing by zero [m]

/// Weighted least squares of any 2-D affine map; nothing when the points span no area.
std::optional<Eigen::Affine2d> fitFree(std::span<const Match> matches,
                                       std::span<const double> weights) {
  double total = 0.0;
  Eigen::Vector2d mean_q = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_p = Eigen::Vector2d::Zero();
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  for (std::size_t i = 0; i < matches.size(); ++i) {
    total += weight(i);
    mean_q += weight(i) * matches[i].moving;
    mean_p += weight(i) * matches[i].fixed;
  }
  if (!(total > 0.0)) return std::nullopt;
  mean_q /= total;
  mean_p /= total;
  Eigen::Matrix2d cross = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector2d q = matches[i].moving - mean_q;
    cross += weight(i) * (matches[i].fixed - mean_p) * q.transpose();
    spread += weight(i) * q * q.transpose();
  }
  const double trace = spread.trace();
  if (!(trace > 0.0) || spread.determinant() < 1e-10 * trace * trace) return std::nullopt;
  Eigen::Affine2d fit;
  fit.linear() = cross * spread.inverse();
  if (!(fit.linear().determinant() > 0.0)) return std::nullopt;
  fit.translation() = mean_p - fit.linear() * mean_q;
  return fit;
}

/// One problem: the matches, and how a map is fitted to some of them.
class Problem {
 public:
  Problem(std::span<const Match> matches, const Eigen::Matrix2d& axes, const AffineOptions& options)
      : matches_(matches), axes_(orthonormalAxes(axes)), options_(options) {}

  std::optional<Eigen::Affine2d> fit(std::span<const Match> matches,
                                     std::span<const double> weights) const {
    if (options_.model == AffineModel::kFree) return fitFree(matches, weights);
    const auto fitted = fitScaledRotation(matches, weights, axes_);
    if (!fitted) return std::nullopt;
    return fitted->fixed_from_moving;
  }

  std::vector<double> residuals(const Eigen::Affine2d& pose, std::size_t step) const {
    std::vector<double> result;
    for (std::size_t i = 0; i < matches_.size(); i += step) {
      result.push_back((matches_[i].fixed - pose * matches_[i].moving).norm());
    }
    return result;
  }

  static double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  /// Robust deviation of a residual's coordinate [m].
  double deviationFrom(const Eigen::Affine2d& pose) const {
    return std::max(kLeastSigma, median(residuals(pose, 1)) / kMedianToSigma);
  }

  /// The random minimal fit with the smallest median residual.
  std::optional<Eigen::Affine2d> start() const {
    const std::size_t step = (matches_.size() + kScored - 1) / kScored;
    std::optional<Eigen::Affine2d> best;
    double best_median = std::numeric_limits<double>::max();
    const auto consider = [&](const std::optional<Eigen::Affine2d>& pose) {
      if (!pose) return;
      const double value = median(residuals(*pose, step));
      if (value < best_median) {
        best_median = value;
        best = pose;
      }
    };
    consider(fit(matches_, {}));
    Random random(static_cast<std::uint64_t>(options_.seed));
    std::vector<Match> sample(kMinimal);
    for (int k = 0; k < options_.starts; ++k) {
      for (Match& match : sample) match = matches_[random.below(matches_.size())];
      consider(fit(sample, {}));
    }
    return best;
  }

  /// Reweights until the map stands still; `sigma` becomes the last deviation.
  std::optional<Eigen::Affine2d> refine(Eigen::Affine2d pose, double& sigma) const {
    std::vector<double> weights(matches_.size());
    for (int k = 0; k < kReweights; ++k) {
      const std::vector<double> distance = residuals(pose, 1);
      sigma = std::max(kLeastSigma, median(distance) / kMedianToSigma);
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const double r = distance[i] / (options_.tukey * sigma);
        weights[i] = r < 1.0 ? (1.0 - r * r) * (1.0 - r * r) : 0.0;
      }
      const auto next = fit(matches_, weights);
      if (!next) return std::nullopt;
      const double change = (next->matrix() - pose.matrix()).norm();
      pose = *next;
      if (change < 1e-10) break;
    }
    sigma = deviationFrom(pose);
    return pose;
  }

  std::optional<Eigen::Affine2d> robustFit(double& sigma) const {
    const auto from = start();
    return from ? refine(*from, sigma) : std::nullopt;
  }

  std::optional<Eigen::Affine2d> plainFit(double& sigma) const {
    const auto pose = fit(matches_, {});
    if (pose) sigma = deviationFrom(*pose);
    return pose;
  }

  const Eigen::Matrix2d& axes() const { return axes_; }

 private:
  std::span<const Match> matches_;
  Eigen::Matrix2d axes_;
  const AffineOptions& options_;
};

AffineEstimate failure(AffineStatus status, std::size_t matches) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  AffineEstimate estimate;
  estimate.status = status;
  estimate.matches = matches;
  estimate.fixed_from_moving.matrix().setConstant(kNan);
  estimate.scale.setConstant(kNan);
  estimate.yaw = estimate.shear = estimate.rms = estimate.sigma = kNan;
  return estimate;
}

}  // namespace

AffineEstimate estimateAffine(std::span<const Match> matches, const Eigen::Matrix2d& scale_axes,
                              const AffineOptions& options) {
  checkOptions(options);
  const auto least = static_cast<std::size_t>(options.least);
  if (matches.size() < least) return failure(AffineStatus::kTooFewMatches, matches.size());
  const Problem problem(matches, scale_axes, options);
  AffineEstimate estimate;
  const auto pose =
      options.robust ? problem.robustFit(estimate.sigma) : problem.plainFit(estimate.sigma);
  if (!pose) return failure(AffineStatus::kDegenerate, matches.size());
  estimate.matches = matches.size();
  const std::vector<double> distance = problem.residuals(*pose, 1);
  double sum = 0.0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (options.robust && distance[i] > options.tukey * estimate.sigma) continue;
    sum += distance[i] * distance[i];
    estimate.inliers.push_back(static_cast<std::uint32_t>(i));
  }
  if (estimate.inliers.size() < least) {
    return failure(AffineStatus::kTooFewMatches, matches.size());
  }
  estimate.status = AffineStatus::kOk;
  estimate.rms = std::sqrt(sum / static_cast<double>(estimate.inliers.size()));
  estimate.fixed_from_moving = *pose;
  // In the axes' own frame the map is R(yaw)·diag(scale), shear apart.
  const HorizontalParts parts =
      splitHorizontal(problem.axes().transpose() * pose->linear() * problem.axes());
  estimate.yaw = problem.axes().determinant() < 0.0 ? -parts.yaw : parts.yaw;
  estimate.scale = {parts.scale_x, parts.scale_y};
  estimate.shear = options.model == AffineModel::kFree ? parts.shear : 0.0;
  return estimate;
}

}  // namespace agricolmap::paper
