#include "agricolmap/deform/deformation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace agricolmap::deform {
namespace {

/// What cells on the wrong side of a slip may pull the parts by, per axis [m]; from development.
constexpr double kBesideSlips = 0.008;
/// How far a slip is misplaced on average, of the deviation of its place.
constexpr double kMisplaced = 0.8;

}  // namespace

Deformation::Deformation(Path path, const Eigen::Matrix2d& turn, const SplineBasis& basis)
    : coefficients(Eigen::MatrixX3d::Zero(basis.size(), 3)),
      path_(std::move(path)),
      turn_(turn),
      basis_(basis) {}

Eigen::Vector3d Deformation::at(const Eigen::Vector2d& moving) const {
  const PathPlace place = path_.place(moving);
  const SplineBasis::At at = basis_.at(place.along);
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (int i = 0; i < 4; ++i) {
    displacement += at.value[i] * coefficients.row(at.first + i).transpose();
    slope += at.slope[i] * coefficients.row(at.first + i).head<2>().transpose();
  }
  const Eigen::Vector2d ahead = turn_ * place.tangent;
  const double heading = ahead.x() * slope.y() - ahead.y() * slope.x();
  displacement.head<2>() -= place.aside * heading * ahead;
  for (const Slip& slip : slips) {
    if (place.along >= slip.along) displacement.head<2>() += slip.offset;
  }
  return displacement;
}

Eigen::Matrix2d Deformation::covarianceAt(const Eigen::Vector2d& moving) const {
  const PathPlace place = path_.place(moving);
  const SplineBasis::At at = basis_.at(place.along);
  const Eigen::Vector2d ahead = turn_ * place.tangent;
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  Eigen::Matrix2Xd j = Eigen::Matrix2Xd::Zero(2, covariance.cols());
  for (int i = 0; i < 4; ++i) {
    j.middleCols<2>(unknownOf(at.first + i)) = at.value[i] * Eigen::Matrix2d::Identity() -
                                               place.aside * at.slope[i] * ahead * left.transpose();
  }
  for (std::size_t k = 0; k < slips.size(); ++k) {
    if (place.along < slips[k].along) continue;
    j.middleCols<2>(unknownOf(basis_.size() + static_cast<int>(k))).setIdentity();
  }
  Eigen::Matrix2d result = j * covariance * j.transpose();
  if (!slips.empty()) result += kBesideSlips * kBesideSlips * Eigen::Matrix2d::Identity();
  // Beside a slip it is not known which side of it a point is on.
  for (const Slip& slip : slips) {
    if (slip.place_deviation <= 0.0) continue;
    const double u = std::abs(place.along - slip.along) / slip.place_deviation;
    const double wrong = 0.5 * std::erfc(u / std::numbers::sqrt2);
    result += wrong * slip.offset * slip.offset.transpose();
  }
  return result;
}

Eigen::Vector3d Deformation::onPath(double along) const {
  const SplineBasis::At at = basis_.at(along);
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    displacement += at.value[i] * coefficients.row(at.first + i).transpose();
  }
  for (const Slip& slip : slips) {
    if (along >= slip.along) displacement.head<2>() += slip.offset;
  }
  return displacement;
}

double overlapAt(const Deformation& deformation, const Slip& slip) {
  return std::max(0.0, slip.offset.dot(deformation.tangent(slip.along)));
}

double slipRms(const Deformation& deformation) {
  double sum = 0.0;
  for (const Slip& slip : deformation.slips) {
    const double overlap = overlapAt(deformation, slip);
    sum += slip.offset.squaredNorm() * (kMisplaced * slip.place_deviation + overlap);
  }
  return std::sqrt(sum / deformation.path().length());
}

}  // namespace agricolmap::deform
