#include "agricolmap/paper/estimate_affine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "agricolmap/core/random.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/core/scaled_rotation.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, AffineOptions& options) {
  table.flag("robust", options.robust,
             "set outliers aside; off: least squares over all matches, as in the paper");
  table.number("tukey", options.tukey, 2.0, 20.0, "deviations", "residual that gets no weight");
  table.integer("least", options.least, 4, 1000000, "", "matches needed");
  table.integer("starts", options.starts, 1, 100000, "", "random minimal fits to start from");
}

std::string_view toString(AffineStatus status) {
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
constexpr double kLeastSigma = 1e-6;  ///< keeps exact data from dividing by zero [m]

/// One problem: the matches, and how a map is fitted to some of them.
class Problem {
 public:
  Problem(std::span<const Match> matches, const Eigen::Matrix2d& axes, const AffineOptions& options)
      : matches_(matches), axes_(orthonormalAxes(axes)), options_(options) {}

  std::optional<Eigen::Affine2d> fit(std::span<const Match> matches,
                                     std::span<const double> weights) const {
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
      sigma = sigmaOf(distance);
      for (std::size_t i = 0; i < weights.size(); ++i) {
        weights[i] = tukeyWeight(distance[i] / (options_.tukey * sigma));
      }
      const auto next = fit(matches_, weights);
      if (!next) return std::nullopt;
      const double change = (next->matrix() - pose.matrix()).norm();
      pose = *next;
      if (change < 1e-10) break;
    }
    sigma = sigmaOf(residuals(pose, 1));
    return pose;
  }

  std::optional<Eigen::Affine2d> robustFit(double& sigma) const {
    const auto from = start();
    return from ? refine(*from, sigma) : std::nullopt;
  }

  std::optional<Eigen::Affine2d> plainFit() const { return fit(matches_, {}); }

 private:
  static double sigmaOf(std::vector<double> distances) {
    return std::max(kLeastSigma, median(distances) / kMedianInPlane);
  }

  std::span<const Match> matches_;
  Eigen::Matrix2d axes_;
  const AffineOptions& options_;
};

AffineEstimate failure(AffineStatus status) {
  AffineEstimate estimate{status, {}};
  estimate.fixed_from_moving.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  return estimate;
}

}  // namespace

AffineEstimate estimateAffine(std::span<const Match> matches, const Eigen::Matrix2d& scale_axes,
                              const AffineOptions& options) {
  const auto least = static_cast<std::size_t>(options.least);
  if (matches.size() < least) return failure(AffineStatus::kTooFewMatches);
  const Problem problem(matches, scale_axes, options);
  if (!options.robust) {
    const auto plain = problem.plainFit();
    return plain ? AffineEstimate{AffineStatus::kOk, *plain} : failure(AffineStatus::kDegenerate);
  }
  double sigma = 0.0;
  const auto pose = problem.robustFit(sigma);
  if (!pose) return failure(AffineStatus::kDegenerate);
  const std::vector<double> distance = problem.residuals(*pose, 1);
  const auto agreeing = std::count_if(distance.begin(), distance.end(),
                                      [&](double d) { return d <= options.tukey * sigma; });
  if (static_cast<std::size_t>(agreeing) < least) return failure(AffineStatus::kTooFewMatches);
  return {AffineStatus::kOk, *pose};
}

}  // namespace agricolmap::paper
