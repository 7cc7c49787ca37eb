#include "agricolmap/locate/hypotheses.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/angles.hpp"

namespace agricolmap::locate {
namespace {

/// Points just outside the limits are drawn in to them when they are this near, in radii.
constexpr double kRim = 0.6;

/// The lattice in the coordinates where the metric is the unit matrix, over the parameters that are
/// free at all.
class Lattice {
 public:
  Lattice(const Eigen::Vector3d& limits, const Eigen::Matrix3d& metric, double radius)
      : limits_(limits), metric_(metric), radius_(radius) {
    for (int i = 0; i < 3; ++i) {
      if (limits[i] > 0.0) free_.push_back(i);
    }
    const auto n = static_cast<Eigen::Index>(free_.size());
    if (n == 0) return;
    Eigen::MatrixXd reduced(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        reduced(i, j) =
            metric(free_[static_cast<std::size_t>(i)], free_[static_cast<std::size_t>(j)]);
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(reduced);
    const Eigen::VectorXd roots = eigen.eigenvalues().cwiseMax(1e-12).cwiseSqrt();
    parameters_from_unit_ = eigen.eigenvectors() * roots.cwiseInverse().asDiagonal();
    unit_from_parameters_ = roots.asDiagonal() * eigen.eigenvectors().transpose();
    // Side of the cube for a covering radius of `radius` in three dimensions: a·√5/4 = radius.
    side_ = radius * 4.0 / std::sqrt(5.0);
  }

  std::vector<Eigen::Vector3d> points() const {
    std::vector<Eigen::Vector3d> found;
    const auto n = static_cast<Eigen::Index>(free_.size());
    if (n == 0) return {Eigen::Vector3d::Zero()};
    Eigen::VectorXd limit(n);
    for (Eigen::Index i = 0; i < n; ++i) limit[i] = limits_[free_[static_cast<std::size_t>(i)]];
    const Eigen::VectorXd reach = unit_from_parameters_.cwiseAbs() * limit;
    const Eigen::VectorXi most =
        (reach / side_).unaryExpr([](double v) { return std::ceil(v) + 1.0; }).cast<int>();
    for (const double offset : {0.0, 0.5}) {
      Eigen::VectorXi index = -most;
      while (true) {
        add((index.cast<double>().array() + offset).matrix() * side_, limit, found);
        Eigen::Index axis = 0;
        while (axis < n && ++index[axis] > most[axis]) index[axis] = -most[axis], ++axis;
        if (axis == n) break;
      }
    }
    return found;
  }

 private:
  void add(const Eigen::VectorXd& unit, const Eigen::VectorXd& limit,
           std::vector<Eigen::Vector3d>& found) const {
    const Eigen::VectorXd parameters = parameters_from_unit_ * unit;
    const Eigen::VectorXd inside = parameters.cwiseMax(-limit).cwiseMin(limit);
    if ((unit_from_parameters_ * (parameters - inside)).norm() > kRim * radius_) return;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < free_.size(); ++i) {
      point[free_[i]] = inside[static_cast<Eigen::Index>(i)];
    }
    found.push_back(point);
  }

  Eigen::Vector3d limits_;
  Eigen::Matrix3d metric_;
  double radius_;
  double side_ = 0.0;
  std::vector<int> free_;
  Eigen::MatrixXd parameters_from_unit_;
  Eigen::MatrixXd unit_from_parameters_;
};

}  // namespace

Eigen::Matrix3d displacementMetric(const Eigen::Matrix2d& axes, const Eigen::Vector2d& half_extent,
                                   const Eigen::Matrix2d& scale_axes) {
  // Displacement of p: yaw·Jp + a·e₁e₁ᵀp + b·e₂e₂ᵀp; the mean of ppᵀ over the rectangle is known.
  const Eigen::Matrix2d spread =
      axes * half_extent.cwiseAbs2().asDiagonal() * axes.transpose() / 3.0;
  Eigen::Matrix2d generator[3];
  generator[0] << 0.0, -1.0, 1.0, 0.0;
  generator[1] = scale_axes.col(0) * scale_axes.col(0).transpose();
  generator[2] = scale_axes.col(1) * scale_axes.col(1).transpose();
  Eigen::Matrix3d metric;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      metric(i, j) = (generator[i] * spread * generator[j].transpose()).trace();
    }
  }
  return metric;
}

std::vector<Hypothesis> coverSpace(const PriorUncertainty& uncertainty,
                                   const Eigen::Matrix3d& metric, double radius) {
  const double scale_limit = logScaleLimit(uncertainty);
  const Eigen::Vector3d limits(radians(uncertainty.heading_deg), scale_limit, scale_limit);
  std::vector<Hypothesis> hypotheses;
  for (const Eigen::Vector3d& p : Lattice(limits, metric, radius).points()) {
    hypotheses.push_back(Hypothesis::fromVector(p));
  }
  return hypotheses;
}

NearestHypothesis::NearestHypothesis(const std::vector<Hypothesis>& among,
                                     const Eigen::Matrix3d& metric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(metric);
  unit_from_parameters_ = eigen.eigenvalues().cwiseMax(1e-12).cwiseSqrt().asDiagonal() *
                          eigen.eigenvectors().transpose();
  Eigen::AlignedBox3d box;
  for (const Hypothesis& hypothesis : among) {
    points_.emplace_back(unit_from_parameters_ * hypothesis.vector());
    box.extend(points_.back());
  }
  // About one hypothesis a bin, were they spread over the box; what is not free has no width.
  double volume = 1.0;
  double dimensions = 0.0;
  for (const double width : box.sizes()) {
    if (width < 1e-6) continue;
    volume *= width;
    dimensions += 1.0;
  }
  if (dimensions > 0.0) {
    side_ = std::pow(volume / static_cast<double>(points_.size()), 1.0 / dimensions);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) bins_[binOf(points_[i])].push_back(i);
}

NearestHypothesis::Bin NearestHypothesis::binOf(const Eigen::Vector3d& unit) const {
  const Eigen::Vector3d bin = (unit / side_).array().floor();
  return {static_cast<int>(bin.x()), static_cast<int>(bin.y()), static_cast<int>(bin.z())};
}

std::size_t NearestHypothesis::of(const Hypothesis& hypothesis) const {
  const Eigen::Vector3d at = unit_from_parameters_ * hypothesis.vector();
  const Bin middle = binOf(at);
  std::size_t best = 0;
  double nearest = std::numeric_limits<double>::infinity();
  const auto look = [&](const Bin& bin) {
    const auto found = bins_.find(bin);
    if (found == bins_.end()) return;
    for (const std::size_t i : found->second) {
      const double distance = (points_[i] - at).squaredNorm();
      if (distance < nearest || (distance == nearest && i < best)) nearest = distance, best = i;
    }
  };
  // Shells of bins; what lies in the next shell is at least `shell` sides away.
  for (int shell = 0; nearest > std::pow(std::max(0, shell - 1) * side_, 2); ++shell) {
    for (int x = -shell; x <= shell; ++x) {
      for (int y = -shell; y <= shell; ++y) {
        const bool face = std::abs(x) == shell || std::abs(y) == shell;
        for (int z = -shell; z <= shell; z += face ? 1 : std::max(1, 2 * shell)) {
          look({middle[0] + x, middle[1] + y, middle[2] + z});
        }
      }
    }
  }
  return best;
}

}  // namespace agricolmap::locate
