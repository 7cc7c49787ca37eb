#include "agricolmap/deform/slips.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace agricolmap::deform {
namespace {

/// Pieces jump when they differ by more than this [m], which is more than a cell of the map that
/// they were placed on.
constexpr double kLeastJump = 0.1;
/// What a piece's offset is good to [m].
constexpr double kPieceDeviation = 0.02;
/// A slip has so much of the strip before and behind it [m].
constexpr double kLeastPart = 1.0;
/// Logarithm of how much likelier a further slip must make what is left: it has two numbers of its
/// own and could lie anywhere.
constexpr double kLeastEvidence = 12.0;
/// How far a slip is looked for beside where it was [m].
constexpr double kSlipReach = 1.2;

}  // namespace

std::vector<double> jumpsBetween(const std::vector<PieceOffset>& pieces) {
  std::vector<double> jumps;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    if ((pieces[i].offset - pieces[i - 1].offset).norm() < kLeastJump) continue;
    jumps.push_back(0.5 * (pieces[i].along + pieces[i - 1].along));
  }
  return jumps;
}

Eigen::VectorXd throughPieces(const BendModel& model, const std::vector<PieceOffset>& pieces,
                              double stiffness) {
  Eigen::MatrixXd normal = stiffness * model.bending();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(model.size());
  constexpr double kWeight = 1.0 / (kPieceDeviation * kPieceDeviation);
  for (const PieceOffset& piece : pieces) {
    Eigen::Matrix2Xd j = Eigen::Matrix2Xd::Zero(2, model.size());
    const SplineBasis::At at = model.basis().at(piece.along);
    for (int i = 0; i < 4; ++i) {
      j.middleCols<2>(unknownOf(at.first + i)) =
          at.value[static_cast<std::size_t>(i)] * Eigen::Matrix2d::Identity();
    }
    for (std::size_t k = 0; k < model.slips().size(); ++k) {
      if (piece.along < model.slips()[k]) continue;
      j.middleCols<2>(unknownOf(model.basis().size() + static_cast<int>(k))).setIdentity();
    }
    normal += kWeight * j.transpose() * j;
    right += kWeight * j.transpose() * piece.offset;
  }
  normal.diagonal().array() += 1e-6 * (1.0 + normal.trace() / static_cast<double>(model.size()));
  return normal.ldlt().solve(right);
}

std::optional<double> furtherSlip(const StripBins& bins, const BendModel& model,
                                  const BendFit& fit) {
  const BinLayout& layout = bins.layout();
  const std::vector<BinSums> sums = bins.sums(model.motions(fit.coefficients), fit.residual);
  double best = kLeastEvidence;
  std::optional<double> place;
  const int skip = std::max(1, static_cast<int>(std::lround(0.25 / layout.step())));
  for (int bin = skip; bin < layout.count; bin += skip) {
    const double along = layout.step() * bin;
    if (along < kLeastPart || along > layout.length - kLeastPart) continue;
    const auto near = [&](double slip) { return std::abs(slip - along) < kLeastPart; };
    if (std::any_of(model.slips().begin(), model.slips().end(), near)) continue;
    std::vector<double> slips = model.slips();
    slips.push_back(along);
    const BendModel more(model.basis(), slips, bins);
    Equations equations = more.equations(sums, [](int) { return true; });
    const Eigen::MatrixXd penalty = fit.stiffness * fit.noise * more.bending();
    Eigen::VectorXd at = Eigen::VectorXd::Zero(more.size());
    at.head(model.size()) = fit.coefficients;
    equations.normal += penalty;
    equations.right -= penalty * at;
    equations.normal.diagonal().array() += 1e-9 * (1.0 + equations.normal.trace());
    const double gain =
        0.5 * equations.right.dot(equations.normal.ldlt().solve(equations.right)) / fit.noise;
    if (gain <= best) continue;
    best = gain;
    place = along;
  }
  return place;
}

std::vector<double> placedSlips(const StripBins& bins, const BendModel& model,
                                const Eigen::VectorXd& coefficients, const refine::Noise& noise) {
  const BinLayout& layout = bins.layout();
  std::vector<double> placed = model.slips();
  for (std::size_t k = 0; k < placed.size(); ++k) {
    // The same offsets, with the slip before and behind all of where it may lie.
    std::vector<double> early = placed, late = placed;
    early[k] = -std::numeric_limits<double>::infinity();
    late[k] = std::numeric_limits<double>::infinity();
    const std::vector<BinSums> behind =
        bins.sums(BendModel(model.basis(), early, bins).motions(coefficients), noise);
    const std::vector<BinSums> before =
        bins.sums(BendModel(model.basis(), late, bins).motions(coefficients), noise);
    const double low = std::max(kLeastPart, placed[k] - kSlipReach);
    const double high = std::min(layout.length - kLeastPart, placed[k] + kSlipReach);
    double sum = 0.0, least = std::numeric_limits<double>::infinity();
    for (int bin = 0; bin < layout.count; ++bin) {
      const double along = layout.step() * bin;
      if (along >= low && along <= high && sum < least) {
        least = sum;
        placed[k] = along;
      }
      for (const int half : {bin, bin + layout.count}) {
        const auto b = static_cast<std::size_t>(half);
        sum += before[b].cost - behind[b].cost;
      }
    }
  }
  return placed;
}

}  // namespace agricolmap::deform
