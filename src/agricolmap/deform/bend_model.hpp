// The spline and the slips as one linear model: from coefficients to how bins move, and from the
// bins' sums back to equations for the coefficients.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/deform/spline.hpp"
#include "agricolmap/deform/strip_bins.hpp"

namespace agricolmap::deform {

/// normal · change = right, of a Gauss–Newton step.
struct Equations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
};

/// Coefficients are x and y of the spline's first, of its second, …, then of the slips' offsets.
class BendModel {
 public:
  /// `slips`: path lengths from which on they count.
  BendModel(const SplineBasis& basis, std::vector<double> slips, const StripBins& bins);

  int size() const { return 2 * (basis_.size() + static_cast<int>(slips_.size())); }
  const SplineBasis& basis() const { return basis_; }
  const std::vector<double>& slips() const { return slips_; }
  std::vector<BinMotion> motions(const Eigen::VectorXd& coefficients) const;
  /// From the bins that take part: `use(bin)`.
  template <typename Use>
  Equations equations(const std::vector<BinSums>& sums, const Use& use) const {
    Equations equations = none();
    for (int bin = 0; bin < bins_.layout().size(); ++bin) {
      if (use(bin)) add(bin, sums[static_cast<std::size_t>(bin)], equations);
    }
    return equations;
  }
  /// Integral of the squared second derivative over the path, as a quadratic form [1/m]: how much
  /// heading and speed must have wandered.
  const Eigen::MatrixXd& bending() const { return bending_; }
  /// Columns: the coefficients of what bends nothing: shift, turn and stretch along the path.
  const Eigen::MatrixXd& straight() const { return straight_; }

 private:
  Equations none() const;
  void add(int bin, const BinSums& sums, Equations& equations) const;

  const StripBins& bins_;
  SplineBasis basis_;
  std::vector<double> slips_;
  Eigen::MatrixXd bending_;
  Eigen::MatrixXd straight_;
};

}  // namespace agricolmap::deform
