// Stage 5: the preliminary transform from matched points (paper Sec. IV, Eq. 3): rotation, a scale
// along each file axis and a shift, all that flat data can tell.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/locate/association.hpp"

namespace agricolmap::paper {

struct AffineOptions {
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

/// Everything but `status` and `matches` is NaN or empty unless `ok()`.
struct AffineEstimate {
  AffineStatus status = AffineStatus::kTooFewMatches;
  std::size_t matches = 0;             ///< given
  Eigen::Affine2d fixed_from_moving;   ///< levelled frames [m]
  double yaw = 0.0;                    ///< of the first scale axis [rad]
  Eigen::Vector2d scale;               ///< along the scale axes
  std::vector<std::uint32_t> inliers;  ///< indices of matches within tukey·sigma
  double rms = 0.0;                    ///< of the inliers' residual distances [m]
  double sigma = 0.0;                  ///< robust deviation of a residual's coordinate [m]
  bool ok() const { return status == AffineStatus::kOk; }
};

/// Robust estimate of p = M·q + t from matches (q moving, p fixed); `scale_axes` as in SearchSpace.
///
/// Starts from the random minimal fit with the smallest median residual (least median of squares,
/// Rousseeuw 1984), then reweights with Tukey's biweight: the deviation is the median residual
/// distance over 1.1774, as of a 2-D normal. Each fit is in closed form (fitScaledRotation).
/// Withstands just under half outliers. Deterministic.
AffineEstimate estimateAffine(std::span<const Match> matches, const Eigen::Matrix2d& scale_axes,
                              const AffineOptions& options);

}  // namespace agricolmap::paper
