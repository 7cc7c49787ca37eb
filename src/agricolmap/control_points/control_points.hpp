// The true transformation from pairs of places that somebody picked by hand in both maps, as the
// authors of the paper did for their data (Sec. V-A), with the residuals that a surveyor asks for.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace agricolmap::control_points {

/// What a pair is for.
enum class PairUse {
  kControl,  ///< determines the transformation
  kCheck,    ///< only tells how good it is
};

/// The same place in both maps, file coordinates [m], of any size (UTM).
struct ControlPair {
  std::string name;
  Eigen::Vector3d moving = Eigen::Vector3d::Zero();
  Eigen::Vector3d fixed = Eigen::Vector3d::Zero();
  PairUse use = PairUse::kControl;
};

/// What the transformation may consist of.
enum class ControlModel {
  kScales,  ///< rotation, a scale along the moving file's x and y (1 along z), shift: Eq. 3
  kAffine,  ///< any affine
};
std::string_view toString(ControlModel model);

struct ControlOptions {
  ControlModel model = ControlModel::kScales;
  double tukey = 4.685;  ///< where the biweight reaches 0, in deviations of the residuals
  int seed = 1;          ///< of the minimal fits, where there are too many to try all
};

/// Linear part = rotation · [1 kxy kxz; 0 1 kyz; 0 0 1] · diag(scale).
struct ControlParts {
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw as in offset.xyz [rad]
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();   ///< along the moving file's axes
  Eigen::Vector3d shear = Eigen::Vector3d::Zero();   ///< kxy, kxz, kyz; 0 in the model of scales
};

/// How one pair fits. Residuals are transformed moving place − fixed place, fixed file axes [m].
struct PairResidual {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  /// The same when the pair itself is left out of the fit; NaN for check points, and where the
  /// others do not determine the transformation.
  Eigen::Vector3d left_out = Eigen::Vector3d::Zero();
  double weight = 0.0;   ///< in the fit, 0 to 1
  bool outlier = false;  ///< too far off for the noise that the control pairs have
};

/// Residuals of several pairs, per axis of the fixed file [m]; NaN when there is no pair.
struct AxisErrors {
  std::size_t count = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();
  double horizontal() const { return rms.head<2>().norm(); }
  double spatial() const { return rms.norm(); }
};

struct ControlEstimate {
  ControlModel model = ControlModel::kScales;
  Eigen::Affine3d fixed_from_moving = Eigen::Affine3d::Identity();  ///< file coordinates
  ControlParts parts;
  /// Standard deviations of the parts by the jackknife; NaN when a pair cannot be spared.
  ControlParts deviations;
  double sigma_horizontal = 0.0;        ///< robust deviation of a horizontal coordinate [m]
  double sigma_vertical = 0.0;          ///< and of the height [m]
  std::vector<PairResidual> residuals;  ///< one per given pair, in order
  AxisErrors control;                   ///< control pairs that are no outliers
  AxisErrors left_out;                  ///< the same pairs, each left out in turn
  AxisErrors check;                     ///< all check points, outliers included
  std::vector<std::string> warnings;    ///< why not to trust it too much, in plain words
};

/// Control pairs that the model needs: one more than determine it, or nothing would show a mistake.
std::size_t neededPairs(ControlModel model);

/// Robust least squares over the control pairs.
///
/// Starts from the minimal fit whose residuals' middle order statistic is smallest (least median of
/// squares, Rousseeuw 1984), then reweights with Tukey's biweight at that fit's deviation and once
/// more at the deviation found so (horizontal and vertical deviations apart: heights are never
/// picked better than places, and often worse). Just under half of many pairs may be wrong; of six
/// or seven, one; of fewer, none. `source` is named in messages. Deterministic. Throws InputError
/// when there are too few control pairs, or when they lie on a spot or a line (for the affine: in a
/// plane), or fit only a mirrored map.
ControlEstimate estimateFromPairs(std::span<const ControlPair> pairs, const ControlOptions& options,
                                  const std::string& source);

}  // namespace agricolmap::control_points
