// Logistic regression and how well its probabilities hold.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "campaign_summary.hpp"

namespace agricolmap::campaign {

/// P(right | x) = 1 / (1 + exp(−intercept − weights·x)).
struct LogisticModel {
  double intercept = 0.0;
  Eigen::VectorXd weights;

  double logit(const Eigen::VectorXd& features) const { return intercept + weights.dot(features); }
  double probability(const Eigen::VectorXd& features) const;
};

/// Maximum likelihood with the penalty `ridge`/2 · Σ(weight · deviation of its feature)², by
/// Newton's method. One row of `features` per sample; `right` has zeros and ones. Throws InputError
/// when there are no samples of one kind.
///
/// `signs`, one per feature or none at all: a feature whose weight would have the other sign is
/// left out (weight 0), so that more evidence never makes a registration less probable.
LogisticModel fitLogistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& right,
                          double ridge, const Eigen::VectorXd& signs = {});

/// A probability that was stated, and what came true.
struct Statement {
  double probability = 0.0;
  bool right = false;
};

/// Chance that a right one is stated more probable than a wrong one, ties by half (Mann–Whitney);
/// NaN without one of either.
double areaUnderCurve(const std::vector<Statement>& statements);

struct ReliabilityBin {
  double low = 0.0;  ///< range of the statements
  double high = 0.0;
  std::size_t count = 0;
  std::size_t right = 0;
  double mean_probability = 0.0;
  Interval interval;  ///< of the share of right ones
};

/// Ten bins of equal width, those without statements left out.
std::vector<ReliabilityBin> reliability(const std::vector<Statement>& statements);
/// Mean over the statements of |share right − mean probability| of their bins, equal in number or
/// in width.
double calibrationError(const std::vector<Statement>& statements, bool equal_mass);
/// Mean squared difference of statement and outcome.
double brierScore(const std::vector<Statement>& statements);

/// From where on answers may be accepted.
struct AcceptThreshold {
  double probability = 0.0;
  double highest_wrong = 0.0;  ///< 0 when nothing is wrong
  std::size_t right = 0;
  std::size_t refused = 0;  ///< right ones below the threshold
  double refusalRate() const {
    return right == 0 ? 0.0 : static_cast<double>(refused) / static_cast<double>(right);
  }
};
/// The lowest threshold that accepts nothing wrong, with `margin` added to the logit of the highest
/// wrong statement; never below one half.
AcceptThreshold chooseThreshold(const std::vector<Statement>& statements, double margin);

}  // namespace agricolmap::campaign
