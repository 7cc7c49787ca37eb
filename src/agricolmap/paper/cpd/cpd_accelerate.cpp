#include "agricolmap/paper/cpd/cpd_accelerate.hpp"

#include <Eigen/Cholesky>

namespace agricolmap::paper {

Eigen::VectorXd AndersonMixer::next(const Eigen::VectorXd& point, const Eigen::VectorXd& image,
                                    double limit) {
  const Eigen::VectorXd residual = image - point;
  if (last_point_.size() > 0) {
    point_steps_.push_back(point - last_point_);
    residual_steps_.push_back(residual - last_residual_);
    if (point_steps_.size() > memory_) {
      point_steps_.pop_front();
      residual_steps_.pop_front();
    }
  }
  last_point_ = point;
  last_residual_ = residual;
  const auto count = static_cast<Eigen::Index>(point_steps_.size());
  if (count == 0) return image;
  Eigen::MatrixXd residual_steps(point.size(), count);
  Eigen::MatrixXd point_steps(point.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    residual_steps.col(i) = residual_steps_[static_cast<std::size_t>(i)];
    point_steps.col(i) = point_steps_[static_cast<std::size_t>(i)];
  }
  // The combination of past residuals nearest to the present one, damped against their noise.
  Eigen::MatrixXd normal = residual_steps.transpose() * residual_steps;
  normal.diagonal().array() += 1e-8 * normal.trace() + 1e-30;
  const Eigen::VectorXd mix = normal.ldlt().solve(residual_steps.transpose() * residual);
  Eigen::VectorXd step = residual - (point_steps + residual_steps) * mix;
  const double longest = step.cwiseAbs().maxCoeff();
  if (!step.allFinite() || residual.dot(step) <= 0.0) {
    restart();
    return image;
  }
  if (longest > limit) step *= limit / longest;
  return point + step;
}

void AndersonMixer::restart() {
  point_steps_.clear();
  residual_steps_.clear();
  last_point_.resize(0);
  last_residual_.resize(0);
}

}  // namespace agricolmap::paper
