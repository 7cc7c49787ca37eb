// Stage 5: the preliminary transform from matched points (paper Sec. IV, Eq. 3).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/locate/association.hpp"

namespace agricolmap::paper {

/// What the transform may consist of.
enum class AffineModel {
  kScaledRotation,  ///< rotation, a scale along each file axis, shift: all that flat data can tell
  kFree,            ///< any 2-D affine map, shear included
};

struct AffineOptions {
  AffineModel model = AffineModel::kScaledRotation;
  /// Sets outliers aside; without it this is the paper's least squares over all matches.
  bool robust = true;
  double tukey = 4.685;  ///< where the biweight reaches 0, in deviations of the residuals
  int least = 8;         ///< matches needed, before and after outliers are set aside
  int starts = 200;      ///< random minimal fits to start from
  int seed = 1;
};
void describe(OptionTable& table, AffineOptions& options);

enum class AffineStatus {
  kOk,
  kTooFewMatches,  ///< fewer than `least` matches, or fewer that agree
  kDegenerate,     ///< the matches lie on a spot or a line, or fit only a mirrored map
};
std::string_view name(AffineStatus status);

/// Everything but `status` and `matches` is NaN or empty unless `ok()`.
struct AffineEstimate {
  AffineStatus status = AffineStatus::kTooFewMatches;
  std::size_t matches = 0;             ///< given
  Eigen::Affine2d fixed_from_moving;   ///< levelled frames [m]
  double yaw = 0.0;                    ///< of the first scale axis [rad]
  Eigen::Vector2d scale;               ///< along the scale axes
  double shear = 0.0;                  ///< of the free model, as in HorizontalParts; else 0
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
/// Withstands just under half outliers. Deterministic. Without `robust` it is one fit to all
/// matches, which then all are inliers.
AffineEstimate estimateAffine(std::span<const Match> matches, const Eigen::Matrix2d& scale_axes,
                              const AffineOptions& options);

}  // namespace agricolmap::paper
