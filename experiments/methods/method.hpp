// A registration method: one interface for the product and for its peers, so that all of them get
// the same clouds, the same guess and the same limits.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/search_space.hpp"
#include "experiments/methods/method_times.hpp"
#include "experiments/pairs/coverage.hpp"

namespace agricolmap::experiments {

/// What every method is given. The clouds must outlive the call.
struct MethodInput {
  const Cloud& fixed;
  const Cloud& moving;
  Eigen::Affine3d guess = Eigen::Affine3d::Identity();  ///< moving file → fixed file [m]
  PriorUncertainty prior = {};                          ///< how wrong the guess may be
  /// The true transform, moving file → fixed file: its horizontal scales are what `-oracle-scale`
  /// variants know, and right matches are counted by it. Methods proper never use it.
  std::optional<Eigen::Affine3d> truth = std::nullopt;
  /// A match this near to the truth is right [m]: two cells of the paper's grid map.
  double right_match = 0.04;
};

/// What a method found. No transform: it has no answer, and `why` says why.
struct MethodOutcome {
  std::optional<Eigen::Affine3d> fixed_from_moving;  ///< moving file → fixed file [m]
  bool accepted = false;   ///< whether the method itself stands by its transform
  bool ambiguous = false;  ///< it does not, as others are as good
  std::string why;         ///< in plain words when it does not
  MethodTimes times;       ///< seconds per stage
  /// Numbers that the method tells of its answer, by their column in rows.csv (runner/row.hpp).
  std::vector<std::pair<std::string, double>> facts;
  std::optional<StatedError> stated;  ///< how wrong it says that it may be
  /// Where it lays the moving cloud point by point, fixed file, if not by the transform alone.
  std::optional<Cloud> aligned;
  /// Of a point of the moving file then: covariance of where it lies in the plane [m²].
  std::function<Eigen::Matrix2d(const Eigen::Vector3d&)> place_covariance;
  std::vector<Eigen::Vector3d> slips;  ///< where it says that the odometry slipped, fixed file [m]
};

/// What whoever runs a method must know of it.
struct Traits {
  bool rigid = false;           ///< leaves the guess's scale error as it is
  bool matches_points = false;  ///< tells `matches`, and may tell `rematches`
  bool needs_guess = true;      ///< cannot search everywhere or for a unit
};

struct Method {
  std::string name;
  std::string about;  ///< one line
  Traits traits = {};
  /// Fills an outcome; may throw InputError.
  std::function<void(const MethodInput&, MethodOutcome&)> attempt;
  /// All options, in a text that differs when one does; empty where only the source has any.
  std::string options = {};

  /// Registers. Clouds that cannot be used, too, are an outcome without a transform: never an
  /// exception and never the guess handed back. Throws Interrupted.
  MethodOutcome run(const MethodInput& input) const;
};

/// Names of all methods that are built in, the product's first. Its presets take options besides:
/// `default:KEY=VALUE:KEY=VALUE`.
std::vector<std::string> methodNames();
/// Throws UsageError, listing the known names, for an unknown one.
Method makeMethod(const std::string& name);

/// The method with the true horizontal scales applied to its guess beforehand, about the middle of
/// the moving cloud, so that its scale is not the reason why it loses. Named `…-oracle-scale`.
Method withOracleScale(Method method);

}  // namespace agricolmap::experiments
