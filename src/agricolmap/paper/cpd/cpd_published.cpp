#include "agricolmap/paper/cpd/cpd_published.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, PublishedCpdOptions& options) {
  table.number("outlier_share", options.outlier_share, 0.001, 0.95, "",
               "share of fixed points expected to have no counterpart, w in CPD");
  table.integer("max_points", options.max_points, 100, 100000, "",
                "points per cloud; more are merged to squares");
  table.integer("max_iterations", options.max_iterations, 1, 10000, "", "most iterations");
  table.number("tolerance", options.tolerance, 1e-9, 0.1, "m",
               "change of sigma and of any point that ends it");
}

namespace {

constexpr Eigen::Index kBatch = 8;  ///< data points whose kernels are computed together
constexpr std::size_t kChunk = 256;
/// Least variance of the centroids in any direction [m²].
constexpr double kMinVariance = 1e-8;
/// σ² of clouds that fit exactly falls to what single precision leaves [m²].
constexpr double kLeastSigma2 = 1e-10;

/// Sums over all pairs, p the posterior of a pair.
struct PairSums {
  double weight = 0.0;                               ///< Σ p
  Eigen::Vector3d fixed = Eigen::Vector3d::Zero();   ///< Σ p·x
  Eigen::Vector3d moving = Eigen::Vector3d::Zero();  ///< Σ p·y
  double fixed2 = 0.0;                               ///< Σ p·|x|²
  Eigen::Matrix3d moving2 = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  ///< Σ p·x·yᵀ
  PairSums& operator+=(const PairSums& other) {
    weight += other.weight;
    fixed += other.fixed;
    moving += other.moving;
    fixed2 += other.fixed2;
    moving2 += other.moving2;
    cross += other.cross;
    return *this;
  }
};

/// The centroids where the state puts them, and per centroid y: 1, y, and the products yᵢ·yⱼ.
struct Centroids {
  static constexpr Eigen::Index kFeatures = 10;
  Eigen::ArrayX3f moved;
  Eigen::Matrix<float, Eigen::Dynamic, kFeatures> features;
};

Centroids centroidsOf(const Eigen::Matrix3Xd& moving, const PublishedCpdState& state) {
  Centroids c;
  c.moved = ((state.linear * moving).colwise() + state.shift).transpose().cast<float>().array();
  c.features.resize(moving.cols(), Centroids::kFeatures);
  c.features.col(0).setOnes();
  c.features.middleCols<3>(1) = moving.transpose().cast<float>();
  Eigen::Index column = 4;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = i; j < 3; ++j) {
      c.features.col(column++) =
          (moving.row(i).array() * moving.row(j).array()).matrix().transpose().cast<float>();
    }
  }
  return c;
}

/// Adds one data point with its kernel sums Σ k, Σ k·y and Σ k·yᵢ·yⱼ.
void addData(const Eigen::Vector3d& x, const Eigen::Matrix<double, 1, 10>& kernels, double outlier,
             PairSums& sums) {
  const Eigen::Matrix<double, 1, 10> p = kernels / (kernels(0) + outlier);
  const Eigen::Vector3d y = p.segment<3>(1).transpose();
  sums.weight += p(0);
  sums.fixed += p(0) * x;
  sums.moving += y;
  sums.fixed2 += p(0) * x.squaredNorm();
  sums.cross += x * y.transpose();
  Eigen::Index column = 4;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = i; j < 3; ++j) {
      sums.moving2(i, j) += p(column);
      if (i != j) sums.moving2(j, i) += p(column);
      ++column;
    }
  }
}

PairSums expectation(const Eigen::Matrix3Xd& fixed, const Centroids& centroids, double variance,
                     double outlier) {
  const auto exponent = static_cast<float>(-0.5 / variance);
  return parallelSum(
      static_cast<std::size_t>(fixed.cols()), kChunk, PairSums{},
      [&](std::size_t begin, std::size_t end) {
        PairSums part;
        Eigen::MatrixXf kernel(centroids.moved.rows(), kBatch);
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end);
             i += kBatch) {
          const Eigen::Index count = std::min(kBatch, static_cast<Eigen::Index>(end) - i);
          for (Eigen::Index k = 0; k < count; ++k) {
            const Eigen::Vector3f x = fixed.col(i + k).cast<float>();
            kernel.col(k).array() = (exponent * ((centroids.moved.col(0) - x(0)).square() +
                                                 (centroids.moved.col(1) - x(1)).square() +
                                                 (centroids.moved.col(2) - x(2)).square()))
                                        .exp();
          }
          const Eigen::Matrix<double, Eigen::Dynamic, 10> sums =
              (kernel.leftCols(count).transpose() * centroids.features).cast<double>();
          for (Eigen::Index k = 0; k < count; ++k) {
            addData(fixed.col(i + k), sums.row(k), outlier, part);
          }
        }
        return part;
      });
}

PublishedCpdState maximisation(const PairSums& sums, const PublishedCpdState& before) {
  PublishedCpdState state = before;
  state.degenerate = true;
  state.matched = sums.weight;
  if (!(sums.weight > 0.0)) return state;
  const Eigen::Vector3d x = sums.fixed / sums.weight;
  const Eigen::Vector3d y = sums.moving / sums.weight;
  const Eigen::Matrix3d moving2 = sums.moving2 / sums.weight - y * y.transpose();
  const Eigen::Matrix3d cross = sums.cross / sums.weight - x * y.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(moving2, Eigen::EigenvaluesOnly);
  if (!(spread.eigenvalues()(0) > kMinVariance)) return state;
  const Eigen::Matrix3d linear = cross * moving2.inverse();
  const double variance =
      (sums.fixed2 / sums.weight - x.squaredNorm() - (cross * linear.transpose()).trace()) / 3.0;
  if (!linear.allFinite() || !(linear.topLeftCorner<2, 2>().determinant() > 0.0)) return state;
  state.linear = linear;
  state.shift = x - linear * y;
  state.variance = std::max(kLeastSigma2, variance);
  state.degenerate = false;
  return state;
}

}  // namespace

double publishedCpdVariance(const Eigen::Matrix3Xd& fixed, const Eigen::Matrix3Xd& moving) {
  const Eigen::Vector3d x = fixed.rowwise().mean();
  const Eigen::Vector3d y = moving.rowwise().mean();
  const double spread = (fixed.colwise() - x).squaredNorm() / static_cast<double>(fixed.cols()) +
                        (moving.colwise() - y).squaredNorm() / static_cast<double>(moving.cols());
  return (spread + (x - y).squaredNorm()) / 3.0;
}

PublishedCpdState publishedCpdStep(const Eigen::Matrix3Xd& fixed, const Eigen::Matrix3Xd& moving,
                                   const PublishedCpdState& state, double outlier_share) {
  // About the data's mean, so that the kernels' single precision loses nothing.
  const Eigen::Vector3d origin = fixed.rowwise().mean();
  const Eigen::Matrix3Xd data = fixed.colwise() - origin;
  const Eigen::Matrix3Xd points = moving.colwise() - origin;
  PublishedCpdState here = state;
  here.shift += state.linear * origin - origin;
  const double outlier = std::pow(2.0 * std::numbers::pi * here.variance, 1.5) * outlier_share /
                         (1.0 - outlier_share) * static_cast<double>(moving.cols()) /
                         static_cast<double>(fixed.cols());
  const PairSums sums = expectation(data, centroidsOf(points, here), here.variance, outlier);
  PublishedCpdState next = maximisation(sums, here);
  next.shift += origin - next.linear * origin;
  return next;
}

PublishedCpdResult publishedCpd(const Eigen::Matrix3Xd& fixed, const Eigen::Matrix3Xd& moving,
                                const PublishedCpdOptions& options) {
  PublishedCpdResult result;
  result.state.variance = publishedCpdVariance(fixed, moving);
  while (result.iterations < options.max_iterations && !result.converged) {
    const PublishedCpdState next =
        publishedCpdStep(fixed, moving, result.state, options.outlier_share);
    ++result.iterations;
    const Eigen::Matrix3d turn = next.linear - result.state.linear;
    const Eigen::Vector3d step = next.shift - result.state.shift;
    const double motion = ((turn * moving).colwise() + step).colwise().norm().maxCoeff();
    const double narrowed = std::abs(std::sqrt(next.variance) - std::sqrt(result.state.variance));
    result.state = next;
    if (next.degenerate) return result;
    result.converged = std::max(motion, narrowed) <= options.tolerance;
  }
  return result;
}

}  // namespace agricolmap::paper
