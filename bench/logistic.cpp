#include "logistic.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/error.hpp"

namespace agricolmap::campaign {
namespace {

constexpr std::size_t kBins = 10;

double logistic(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

std::vector<Statement> sorted(std::vector<Statement> statements) {
  std::stable_sort(
      statements.begin(), statements.end(),
      [](const Statement& a, const Statement& b) { return a.probability < b.probability; });
  return statements;
}

/// Minimises −log likelihood + ½ Σ penalty · weight² by Newton's method with step halving.
Eigen::VectorXd penalisedFit(const Eigen::MatrixXd& design, const Eigen::VectorXd& right,
                             const Eigen::VectorXd& penalty) {
  Eigen::VectorXd beta = Eigen::VectorXd::Zero(design.cols());
  const auto cost = [&](const Eigen::VectorXd& b) {
    // −log likelihood, log(1 + e^z) − y z, safe for large |z|.
    const Eigen::ArrayXd z = (design * b).array();
    const Eigen::ArrayXd soft = z.max(0.0) + (1.0 + (-z.abs()).exp()).log();
    return (soft - right.array() * z).sum() + 0.5 * penalty.dot(b.cwiseAbs2());
  };
  double now = cost(beta);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Eigen::ArrayXd p = (design * beta).array().unaryExpr(&logistic);
    const Eigen::VectorXd gradient =
        design.transpose() * (p.matrix() - right) + penalty.cwiseProduct(beta);
    const Eigen::VectorXd weight = (p * (1.0 - p)).max(1e-12).matrix();
    Eigen::MatrixXd hessian = design.transpose() * weight.asDiagonal() * design;
    hessian.diagonal() += penalty;
    const Eigen::VectorXd step = hessian.ldlt().solve(gradient);
    double length = 1.0;
    double next = cost(beta - step);
    while (next > now && length > 1e-6) {
      length *= 0.5;
      next = cost(beta - length * step);
    }
    beta -= length * step;
    const bool done = now - next < 1e-12 * (1.0 + std::abs(now));
    now = next;
    if (done) break;
  }
  return beta;
}

ReliabilityBin binOf(const std::vector<Statement>& all, std::size_t begin, std::size_t end) {
  ReliabilityBin bin;
  bin.low = all[begin].probability;
  bin.high = all[end - 1].probability;
  bin.count = end - begin;
  for (std::size_t i = begin; i < end; ++i) {
    bin.right += all[i].right ? 1 : 0;
    bin.mean_probability += all[i].probability;
  }
  bin.mean_probability /= static_cast<double>(bin.count);
  bin.interval = wilsonInterval(bin.right, bin.count);
  return bin;
}

}  // namespace

double LogisticModel::probability(const Eigen::VectorXd& features) const {
  return logistic(logit(features));
}

LogisticModel fitLogistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& right,
                          double ridge, const Eigen::VectorXd& signs) {
  const Eigen::Index n = features.rows();
  const Eigen::Index k = features.cols();
  if (n == 0 || right.sum() == 0.0 || right.sum() == static_cast<double>(n)) {
    throw InputError("a regression needs right and wrong answers; there are none of one kind");
  }
  const Eigen::RowVectorXd mean = features.colwise().mean();
  Eigen::RowVectorXd spread =
      ((features.rowwise() - mean).colwise().squaredNorm() / static_cast<double>(n)).cwiseSqrt();
  for (double& s : spread) s = std::max(s, 1e-9);
  Eigen::MatrixXd design(n, k + 1);
  design.col(0).setOnes();
  design.rightCols(k) = (features.rowwise() - mean).array().rowwise() / spread.array();
  Eigen::VectorXd penalty = Eigen::VectorXd::Constant(k + 1, ridge);
  penalty(0) = 0.0;
  Eigen::VectorXd beta = penalisedFit(design, right, penalty);
  // One at a time, the strongest first: of two features that say the same, one may then do.
  while (signs.size() == k) {
    Eigen::Index worst = 0;
    const double contradiction = beta.tail(k).cwiseProduct(signs).minCoeff(&worst);
    if (contradiction >= 0.0) break;
    design.col(worst + 1).setZero();
    beta = penalisedFit(design, right, penalty);
    beta(worst + 1) = 0.0;
  }
  LogisticModel model;
  model.weights = beta.tail(k).cwiseQuotient(spread.transpose());
  model.intercept = beta(0) - model.weights.dot(mean.transpose());
  return model;
}

double areaUnderCurve(const std::vector<Statement>& statements) {
  const std::vector<Statement> all = sorted(statements);
  double won = 0.0;
  double right = 0.0;
  double wrong = 0.0;
  for (std::size_t begin = 0; begin < all.size();) {
    double right_here = 0.0;
    double wrong_here = 0.0;
    std::size_t end = begin;
    for (; end < all.size() && all[end].probability == all[begin].probability; ++end) {
      (all[end].right ? right_here : wrong_here) += 1.0;
    }
    won += right_here * (wrong + 0.5 * wrong_here);
    right += right_here;
    wrong += wrong_here;
    begin = end;
  }
  return won / (right * wrong);
}

std::vector<ReliabilityBin> reliability(const std::vector<Statement>& statements) {
  const std::vector<Statement> all = sorted(statements);
  std::vector<ReliabilityBin> bins;
  std::size_t begin = 0;
  for (std::size_t b = 0; b < kBins; ++b) {
    const double high = static_cast<double>(b + 1) / kBins;
    std::size_t end = begin;
    while (end < all.size() && (all[end].probability < high || b + 1 == kBins)) ++end;
    if (end > begin) {
      bins.push_back(binOf(all, begin, end));
      bins.back().low = high - 1.0 / kBins;
      bins.back().high = high;
    }
    begin = end;
  }
  return bins;
}

double calibrationError(const std::vector<Statement>& statements, bool equal_mass) {
  if (statements.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<Statement> all = sorted(statements);
  std::vector<ReliabilityBin> bins;
  if (equal_mass) {
    for (std::size_t b = 0; b < kBins; ++b) {
      const std::size_t begin = b * all.size() / kBins;
      const std::size_t end = (b + 1) * all.size() / kBins;
      if (end > begin) bins.push_back(binOf(all, begin, end));
    }
  } else {
    bins = reliability(all);
  }
  double sum = 0.0;
  for (const ReliabilityBin& bin : bins) {
    sum += std::abs(static_cast<double>(bin.right) -
                    bin.mean_probability * static_cast<double>(bin.count));
  }
  return sum / static_cast<double>(all.size());
}

double brierScore(const std::vector<Statement>& statements) {
  double sum = 0.0;
  for (const Statement& one : statements) {
    const double difference = one.probability - (one.right ? 1.0 : 0.0);
    sum += difference * difference;
  }
  return sum / static_cast<double>(statements.size());
}

AcceptThreshold chooseThreshold(const std::vector<Statement>& statements, double margin) {
  AcceptThreshold chosen;
  for (const Statement& one : statements) {
    if (!one.right) chosen.highest_wrong = std::max(chosen.highest_wrong, one.probability);
  }
  const double wrong = std::clamp(chosen.highest_wrong, 1e-9, 1.0 - 1e-9);
  chosen.probability = std::max(0.5, logistic(std::log(wrong / (1.0 - wrong)) + margin));
  for (const Statement& one : statements) {
    if (!one.right) continue;
    ++chosen.right;
    chosen.refused += one.probability < chosen.probability ? 1 : 0;
  }
  return chosen;
}

}  // namespace agricolmap::campaign
