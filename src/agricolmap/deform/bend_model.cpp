#include "agricolmap/deform/bend_model.hpp"

#include <utility>

namespace agricolmap::deform {
namespace {

Eigen::MatrixXd bendingOf(const SplineBasis& basis, int size) {
  Eigen::MatrixXd bending = Eigen::MatrixXd::Zero(size, size);
  // Second derivatives at the nodes, each for the node's share of the path.
  const double h = basis.spacing();
  const double curve[3] = {1.0, -2.0, 1.0};
  for (int node = 0; node + 2 < basis.size(); ++node) {
    const bool end = node == 0 || node + 3 == basis.size();
    const double share = (end ? 0.5 : 1.0) * h / (h * h * h * h);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int axis = 0; axis < 2; ++axis) {
          bending(2 * (node + i) + axis, 2 * (node + j) + axis) += share * curve[i] * curve[j];
        }
      }
    }
  }
  return bending;
}

}  // namespace

BendModel::BendModel(const SplineBasis& basis, std::vector<double> slips, const StripBins& bins)
    : bins_(bins), basis_(basis), slips_(std::move(slips)) {
  bending_ = bendingOf(basis, size());
  straight_ = Eigen::MatrixXd::Zero(size(), 4);
  for (int i = 0; i < basis_.size(); ++i) {
    const double along = basis_.place(i) / basis_.length() - 0.5;
    straight_.block<2, 2>(unknownOf(i), 0).setIdentity();
    straight_.block<2, 2>(unknownOf(i), 2) = along * Eigen::Matrix2d::Identity();
  }
}

std::vector<BinMotion> BendModel::motions(const Eigen::VectorXd& coefficients) const {
  const BinLayout& layout = bins_.layout();
  std::vector<BinMotion> motions(static_cast<std::size_t>(layout.size()));
  for (int bin = 0; bin < layout.size(); ++bin) {
    BinMotion& motion = motions[static_cast<std::size_t>(bin)];
    const double middle = layout.middle(bin);
    const SplineBasis::At at = basis_.at(middle);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector2d c = coefficients.segment<2>(unknownOf(at.first + i));
      motion.shift += at.value[static_cast<std::size_t>(i)] * c;
      motion.slope += at.slope[static_cast<std::size_t>(i)] * c;
    }
    for (std::size_t k = 0; k < slips_.size(); ++k) {
      if (middle < slips_[k]) continue;
      motion.shift += coefficients.segment<2>(unknownOf(basis_.size() + static_cast<int>(k)));
    }
  }
  return motions;
}

Equations BendModel::none() const {
  return {Eigen::MatrixXd::Zero(size(), size()), Eigen::VectorXd::Zero(size())};
}

void BendModel::add(int bin, const BinSums& sums, Equations& equations) const {
  const double middle = bins_.layout().middle(bin);
  const SplineBasis::At at = basis_.at(middle);
  const Eigen::Vector2d& ahead = bins_.ahead(bin);
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  // Derivatives of (along, across, heading): to the four coefficients, which lie side by side, and
  // to each slip.
  Eigen::Matrix<double, 3, 8> j;
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    j.col(unknownOf(i)) << at.value[k] * ahead.x(), at.value[k] * left.x(), at.slope[k] * left.x();
    j.col(unknownOf(i) + 1) << at.value[k] * ahead.y(), at.value[k] * left.y(),
        at.slope[k] * left.y();
  }
  Eigen::Matrix<double, 3, 2> jump = Eigen::Matrix<double, 3, 2>::Zero();
  jump.row(0) = ahead.transpose();
  jump.row(1) = left.transpose();
  const Eigen::Index first = unknownOf(at.first);
  const Eigen::Matrix<double, 3, 8> weighted = sums.normal * j;
  equations.right.segment<8>(first) += j.transpose() * sums.right;
  equations.normal.block<8, 8>(first, first) += j.transpose() * weighted;
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    if (middle < slips_[k]) continue;
    const Eigen::Index slip = unknownOf(basis_.size() + static_cast<int>(k));
    equations.right.segment<2>(slip) += jump.transpose() * sums.right;
    const Eigen::Matrix<double, 2, 8> mixed = jump.transpose() * weighted;
    equations.normal.block<2, 8>(slip, first) += mixed;
    equations.normal.block<8, 2>(first, slip) += mixed.transpose();
    for (std::size_t m = 0; m < slips_.size(); ++m) {
      if (middle < slips_[m]) continue;
      equations.normal.block<2, 2>(slip, unknownOf(basis_.size() + static_cast<int>(m))) +=
          jump.transpose() * sums.normal * jump;
    }
  }
}

}  // namespace agricolmap::deform
