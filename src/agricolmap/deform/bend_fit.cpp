#include "agricolmap/deform/bend_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "agricolmap/deform/left_out.hpp"

namespace agricolmap::deform {
namespace {

constexpr int kSteps = 6;
constexpr double kDone = 3e-4;  // [m]
/// Heading and speed wander by the square root of so much over a metre of path [1/m]: what
/// stiffness is tried.
constexpr double kLeastWander = 1e-7;
constexpr double kMostWander = 2e-2;

Eigen::VectorXd solve(Eigen::MatrixXd normal, const Eigen::VectorXd& right) {
  // What no cell tells of stays as it is.
  normal.diagonal().array() += 1e-9 * (1.0 + normal.trace() / static_cast<double>(right.size()));
  return normal.ldlt().solve(right);
}

const auto kAll = [](int) { return true; };

template <typename Use>
Eigen::VectorXd descend(const StripBins& bins, const BendModel& model, Eigen::VectorXd at,
                        double stiffness, const refine::Noise& noise, const Use& use, int steps) {
  const Eigen::MatrixXd penalty = stiffness * model.bending();
  for (int step = 0; step < steps; ++step) {
    const Equations equations = model.equations(bins.sums(model.motions(at), noise), use);
    const Eigen::VectorXd change =
        solve(equations.normal + penalty, equations.right - penalty * at);
    at += change;
    if (!(change.cwiseAbs().maxCoeff() > kDone)) break;
  }
  return at;
}

/// The same without any bend.
template <typename Use>
Eigen::VectorXd descendStraight(const StripBins& bins, const BendModel& model,
                                const refine::Noise& noise, const Use& use, int steps) {
  const Eigen::MatrixXd& basis = model.straight();
  Eigen::VectorXd at = Eigen::VectorXd::Zero(model.size());
  for (int step = 0; step < steps; ++step) {
    const Equations equations = model.equations(bins.sums(model.motions(at), noise), use);
    Eigen::MatrixXd normal = basis.transpose() * equations.normal * basis;
    normal.diagonal().array() += 1e-9 * (1.0 + normal.trace());
    const Eigen::VectorXd change = basis * normal.ldlt().solve(basis.transpose() * equations.right);
    at += change;
    if (!(change.cwiseAbs().maxCoeff() > kDone)) break;
  }
  return at;
}

/// How much more the blocks, each alone, would rather move than the noise of their cells says.
double noiseOf(const std::vector<BinSums>& sums, const LeftOutBlocks& blocks) {
  std::vector<BinSums> all(static_cast<std::size_t>(blocks.count()));
  for (std::size_t bin = 0; bin < sums.size(); ++bin) {
    all[static_cast<std::size_t>(blocks.of(static_cast<int>(bin)))] += sums[bin];
  }
  std::vector<double> squares;
  for (const BinSums& block : all) {
    const Eigen::Matrix2d normal = block.normal.topLeftCorner<2, 2>();
    if (!(normal.determinant() > 1e-9)) continue;
    const Eigen::Vector2d right = block.right.head<2>();
    squares.push_back(0.5 * right.dot(normal.ldlt().solve(right)));
  }
  if (squares.empty()) return 1.0;
  double mean = 0.0;
  for (const double square : squares) mean += square;
  return std::max(1.0, mean / static_cast<double>(squares.size()));
}

/// Equations of one fold's blocks, and of all the others.
struct Fold {
  Equations in;
  Equations out;
};

std::vector<Fold> foldsOf(const BendModel& model, const std::vector<BinSums>& sums,
                          const LeftOutBlocks& blocks) {
  std::vector<Fold> folds;
  for (int fold = 0; fold < LeftOutBlocks::kFolds; ++fold) {
    folds.push_back({model.equations(sums, [&](int bin) { return blocks.fold(bin) != fold; }),
                     model.equations(sums, [&](int bin) { return blocks.fold(bin) == fold; })});
  }
  return folds;
}

/// Cost of the left-out blocks to second order, of the best with this stiffness.
double leftOutCost(const std::vector<Fold>& folds, const Eigen::MatrixXd& penalty,
                   const Eigen::VectorXd& at) {
  double cost = 0.0;
  for (const Fold& fold : folds) {
    const Eigen::VectorXd change = solve(fold.in.normal + penalty, fold.in.right - penalty * at);
    cost += 0.5 * change.dot(fold.out.normal * change) - change.dot(fold.out.right);
  }
  return cost;
}

/// How little the path may have wandered, as left-out blocks would have it.
double stiffnessFor(const BendModel& model, const std::vector<BinSums>& sums,
                    const LeftOutBlocks& blocks, const Eigen::VectorXd& at, double noise) {
  const std::vector<Fold> folds = foldsOf(model, sums, blocks);
  double least = std::numeric_limits<double>::infinity();
  double best = 0.0;
  for (double wander = kLeastWander; wander < kMostWander; wander *= 3.0) {
    const double cost = leftOutCost(folds, noise / wander * model.bending(), at);
    if (cost >= least) continue;
    least = cost;
    best = 1.0 / wander;
  }
  return best;
}

}  // namespace

Eigen::VectorXd bendTo(const StripBins& bins, const BendModel& model, Eigen::VectorXd start,
                       double stiffness, refine::Noise& noise) {
  bins.updateNoise(model.motions(start), noise);
  bins.updateNoise(model.motions(start), noise);
  const LeftOutBlocks blocks(bins.layout());
  for (int round = 0; round < 2; ++round) {
    const double inflation = noiseOf(bins.sums(model.motions(start), noise), blocks);
    start = descend(bins, model, std::move(start), stiffness * inflation, noise, kAll, kSteps / 2);
    bins.updateNoise(model.motions(start), noise);
  }
  return start;
}

BendFit fitBend(const StripBins& bins, const BendModel& model, const Eigen::VectorXd& start) {
  const LeftOutBlocks blocks(bins.layout());
  BendFit fit;
  refine::Noise noise;
  Eigen::VectorXd at = start;
  for (int round = 0; round < 2; ++round) {
    bins.updateNoise(model.motions(at), noise);
    const std::vector<BinSums> sums = bins.sums(model.motions(at), noise);
    fit.noise = noiseOf(sums, blocks);
    fit.stiffness = stiffnessFor(model, sums, blocks, at, fit.noise);
    at = descend(bins, model, std::move(at), fit.stiffness * fit.noise, noise, kAll, kSteps);
  }
  bins.updateNoise(model.motions(at), noise);
  fit.coefficients = at;
  fit.residual = noise;
  // Against the best that does not bend, on blocks that neither has seen.
  std::vector<double> gains(static_cast<std::size_t>(blocks.count()), 0.0);
  for (int fold = 0; fold < LeftOutBlocks::kFolds; ++fold) {
    const auto in = [&](int bin) { return blocks.fold(bin) != fold; };
    const Eigen::VectorXd bent = descend(bins, model, at, fit.stiffness * fit.noise, noise, in, 2);
    const Eigen::VectorXd straight = descendStraight(bins, model, noise, in, kSteps);
    const std::vector<BinSums> of_bent = bins.sums(model.motions(bent), noise);
    const std::vector<BinSums> of_straight = bins.sums(model.motions(straight), noise);
    for (int bin = 0; bin < bins.layout().size(); ++bin) {
      if (in(bin)) continue;
      const auto b = static_cast<std::size_t>(bin);
      gains[static_cast<std::size_t>(blocks.of(bin))] += of_straight[b].cost - of_bent[b].cost;
    }
  }
  fit.gain = significanceOf(gains);
  const std::vector<BinSums> sums = bins.sums(model.motions(at), noise);
  fit.noise = noiseOf(sums, blocks);
  fit.evidence = std::accumulate(gains.begin(), gains.end(), 0.0) / fit.noise;
  Eigen::MatrixXd normal =
      model.equations(sums, kAll).normal / fit.noise + fit.stiffness * model.bending();
  normal.diagonal().array() += 1e-9 * (1.0 + normal.trace() / static_cast<double>(model.size()));
  fit.covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(model.size(), model.size()));
  return fit;
}

}  // namespace agricolmap::deform
