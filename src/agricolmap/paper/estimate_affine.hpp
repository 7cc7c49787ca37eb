// Stage refine: the preliminary transform from matched points (paper Sec. IV, Eq. 3): rotation, a
// scale along each file axis and a shift, all that flat data can tell.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string_view>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/placement.hpp"

namespace agricolmap::paper {

struct AffineOptions {
  /// Sets outliers aside; without it this is the paper's least squares over all matches.
  bool robust = true;
  double tukey = 4.685;  ///< where the biweight reaches 0, in deviations of the residuals
  int least = 8;         ///< matches needed, before and after outliers are set aside
  int starts = 200;      ///< random minimal fits to start from
  int seed = 1;          ///< not listed: the registration has one
};
void listOptions(OptionTable& table, AffineOptions& options);

enum class AffineStatus {
  kOk,
  kTooFewMatches,  ///< fewer than `least` matches, or fewer that agree
  kDegenerate,     ///< the matches lie on a spot or a line, or fit only a mirrored map
};
std::string_view toString(AffineStatus status);

struct AffineEstimate {
  AffineStatus status = AffineStatus::kTooFewMatches;
  Eigen::Affine2d fixed_from_moving;  ///< levelled frames [m]; NaN unless ok()
  bool ok() const { return status == AffineStatus::kOk; }
};

/// Robust estimate of p = M·q + t from matches (q moving, p fixed); `scale_axes` as in SearchSpace.
///
/// Starts from the random minimal fit with the smallest median residual (least median of squares,
/// Rousseeuw 1984), then reweights with Tukey's biweight: the deviation is the median residual
/// distance over 1.1774, as of a 2-D normal. Each fit is in closed form (fitScaledRotation).
/// Withstands just under half outliers. Deterministic. Without `robust` it is one fit to all
/// matches, which then all are inliers.
AffineEstimate estimateAffine(std::span<const Match> matches, const Eigen::Matrix2d& scale_axes,
                              const AffineOptions& options);

}  // namespace agricolmap::paper
