#include "agricolmap/deform/rise_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/deform/left_out.hpp"

namespace agricolmap::deform {
namespace {

constexpr double kBin = 0.3;             // length along the path [m]
constexpr double kLow = 0.25;            // share of a bin's cells that stand for its ground
constexpr double kLowest = 0.05;         // and these for its lowest
constexpr double kFlat = 0.03;           // ground rises by no more between the two [m]
constexpr std::size_t kLeastCells = 30;  // of a bin
constexpr double kLeastShare = 0.6;      // of the bins
constexpr double kRobust = 2.5;          // deviations (Tukey)
constexpr int kRounds = 4;

/// A cell that both maps see.
struct Pair {
  float moving;
  float fixed;
  float difference;  ///< fixed − the whole's heights, in the moving map's scale, − moving
};

/// Difference of the grounds in a bin; NaN where it is not seen.
double groundDifference(std::vector<Pair>& pairs) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (pairs.size() < kLeastCells) return none;
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b) { return a.moving < b.moving; });
  const auto at = [&](double share) {
    return static_cast<std::size_t>(share * static_cast<double>(pairs.size()));
  };
  const std::size_t low = std::max<std::size_t>(at(kLow), 5);
  if (static_cast<double>(pairs[low].moving - pairs[at(kLowest)].moving) > kFlat) return none;
  std::vector<float> fixed, differences;
  for (std::size_t i = 0; i < low; ++i) {
    fixed.push_back(pairs[i].fixed);
    differences.push_back(pairs[i].difference);
  }
  const float lowest = quantile(fixed, 0.1);
  if (static_cast<double>(quantile(fixed, 0.9) - lowest) > 2.0 * kFlat) return none;
  return static_cast<double>(median(differences));
}

std::vector<double> groundDifferences(const map::GridMap& fixed, const map::GridMap& moving,
                                      const Eigen::Affine2d& pose,
                                      const refine::VerticalResult& heights,
                                      const Deformation& deformation, const BinLayout& layout) {
  std::vector<std::vector<Pair>> bins(static_cast<std::size_t>(layout.size()));
  for (int r = 0; r < moving.frame.rows; r += 2) {
    for (int c = 0; c < moving.frame.cols; c += 2) {
      if (!moving.valid(r, c)) continue;
      const Eigen::Vector2d p = moving.frame.centre(r, c);
      const PathPlace place = deformation.path().place(p);
      const Eigen::Vector2d lies = pose * p + deformation.at(p).head<2>();
      const Eigen::Vector2d cell = fixed.frame.cellOf(lies);
      const int row = static_cast<int>(std::lround(cell.y()));
      const int col = static_cast<int>(std::lround(cell.x()));
      if (!fixed.weight.contains(row, col) || !fixed.valid(row, col)) continue;
      const int along =
          std::clamp(static_cast<int>(place.along / layout.step()), 0, layout.count - 1);
      const auto whole =
          static_cast<float>(heights.offset + heights.slope.dot(lies - heights.about));
      const float here = moving.height(r, c), there = fixed.height(row, col);
      bins[static_cast<std::size_t>(place.aside >= 0.0 ? layout.count + along : along)].push_back(
          {here, there, (there - whole) / static_cast<float>(heights.scale) - here});
    }
  }
  std::vector<double> differences;
  for (std::vector<Pair>& bin : bins) differences.push_back(groundDifference(bin));
  return differences;
}

/// A curve through the bins: the spline's coefficients.
class Curve {
 public:
  Curve(const SplineBasis& basis, const BinLayout& layout, const std::vector<double>& values)
      : basis_(basis), layout_(layout), values_(values), weights_(values.size(), 1.0) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isnan(values[i])) weights_[i] = 0.0;
    }
    const double h = basis.spacing();
    bending_ = Eigen::MatrixXd::Zero(basis.size(), basis.size());
    for (int node = 0; node + 2 < basis.size(); ++node) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(basis.size());
      row.segment<3>(node) = Eigen::Vector3d(1.0, -2.0, 1.0);
      bending_ += row * row.transpose() / (h * h * h);
    }
  }

  template <typename Use>
  Eigen::VectorXd fit(double stiffness, const Use& use) const {
    Eigen::MatrixXd normal = stiffness * bending_;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(basis_.size());
    for (int bin = 0; bin < layout_.size(); ++bin) {
      const auto b = static_cast<std::size_t>(bin);
      if (weights_[b] <= 0.0 || !use(bin)) continue;
      const SplineBasis::At at = basis_.at(layout_.middle(bin));
      const Eigen::Map<const Eigen::Vector4d> value(at.value.data());
      normal.block<4, 4>(at.first, at.first) += weights_[b] * value * value.transpose();
      right.segment<4>(at.first) += weights_[b] * values_[b] * value;
    }
    normal.diagonal().array() += 1e-9 * (1.0 + normal.trace());
    return normal.ldlt().solve(right);
  }
  double residual(const Eigen::VectorXd& coefficients, int bin) const {
    const SplineBasis::At at = basis_.at(layout_.middle(bin));
    const Eigen::Map<const Eigen::Vector4d> value(at.value.data());
    return values_[static_cast<std::size_t>(bin)] - value.dot(coefficients.segment<4>(at.first));
  }
  /// What lies far off a curve loses its weight; returns the deviation of the rest.
  double reweight(const Eigen::VectorXd& coefficients) {
    std::vector<double> distances;
    for (int bin = 0; bin < layout_.size(); ++bin) {
      if (!std::isnan(values_[static_cast<std::size_t>(bin)])) {
        distances.push_back(std::abs(residual(coefficients, bin)));
      }
    }
    const double deviation = std::max(1e-4, deviationFrom(distances));
    for (int bin = 0; bin < layout_.size(); ++bin) {
      const auto b = static_cast<std::size_t>(bin);
      if (std::isnan(values_[b])) continue;
      weights_[b] = tukeyWeight(residual(coefficients, bin) / (2.0 * kRobust * deviation));
    }
    return deviation;
  }
  double weight(int bin) const { return weights_[static_cast<std::size_t>(bin)]; }
  const Eigen::MatrixXd& bending() const { return bending_; }
  const BinLayout& layout() const { return layout_; }

 private:
  const SplineBasis& basis_;
  const BinLayout& layout_;
  const std::vector<double>& values_;
  std::vector<double> weights_;
  Eigen::MatrixXd bending_;
};

constexpr double kStraight = 1e9;

/// Squares that each block is left with when it is left out.
std::vector<double> leftOut(const Curve& curve, const LeftOutBlocks& blocks, double stiffness) {
  std::vector<double> squares(static_cast<std::size_t>(blocks.count()), 0.0);
  for (int fold = 0; fold < LeftOutBlocks::kFolds; ++fold) {
    const Eigen::VectorXd fit =
        curve.fit(stiffness, [&](int bin) { return blocks.fold(bin) != fold; });
    for (int bin = 0; bin < curve.layout().size(); ++bin) {
      if (blocks.fold(bin) != fold || curve.weight(bin) <= 0.0) continue;
      squares[static_cast<std::size_t>(blocks.of(bin))] +=
          curve.weight(bin) * std::pow(curve.residual(fit, bin), 2);
    }
  }
  return squares;
}

double sumOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace

std::optional<RiseFit> fitRise(const map::GridMap& fixed, const map::GridMap& moving,
                               const Eigen::Affine2d& pose, const refine::VerticalResult& heights,
                               const Deformation& deformation) {
  const SplineBasis& basis = deformation.basis();
  const BinLayout layout{basis.length(),
                         std::max(8, static_cast<int>(std::lround(basis.length() / kBin)))};
  const std::vector<double> values =
      groundDifferences(fixed, moving, pose, heights, deformation, layout);
  const auto seen =
      std::count_if(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
  if (static_cast<double>(seen) < kLeastShare * layout.size()) return std::nullopt;
  const LeftOutBlocks blocks(layout);
  Curve curve(basis, layout, values);
  const auto all = [](int) { return true; };
  double stiffness = 1.0;
  double deviation = 0.0;
  Eigen::VectorXd fit;
  for (int round = 0; round < kRounds; ++round) {
    double least = std::numeric_limits<double>::infinity();
    for (double trial = 1e-2; trial < 1e5; trial *= 4.0) {
      const double cost = sumOf(leftOut(curve, blocks, trial));
      if (cost >= least) continue;
      least = cost;
      stiffness = trial;
    }
    fit = curve.fit(stiffness, all);
    deviation = curve.reweight(fit);
  }
  std::vector<double> gains = leftOut(curve, blocks, kStraight);
  const std::vector<double> bent = leftOut(curve, blocks, stiffness);
  for (std::size_t i = 0; i < gains.size(); ++i) gains[i] -= bent[i];
  RiseFit rise;
  rise.coefficients = fit;
  rise.gain = significanceOf(gains);
  // Halves side by side err apart; each coefficient rests on about so many bins.
  const double bins = 2.0 * basis.spacing() / layout.step();
  rise.deviation = deviation / std::sqrt(std::max(1.0, bins));
  return rise;
}

}  // namespace agricolmap::deform
