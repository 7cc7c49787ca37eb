// A registration method of the comparison: one interface for the product and for its peers, so that
// all of them get the same clouds, the same guess and the same limits.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/locate/association.hpp"

namespace agricolmap::experiments {

/// What every method is given. The clouds must outlive the call.
struct MethodInput {
  const Cloud& fixed;
  const Cloud& moving;
  Eigen::Affine3d guess = Eigen::Affine3d::Identity();  ///< moving file → fixed file [m]
  PriorUncertainty prior = {};                          ///< how wrong the guess may be
  /// The true transform, moving file → fixed file: read by `-oracle-scale` variants, which take its
  /// horizontal scales and nothing else. Methods proper never see it.
  std::optional<Eigen::Affine3d> truth = std::nullopt;
  /// After which a method that improves step by step hands back what it has [s]. Others run to
  /// their end; whoever starts them may end them.
  double time_limit = 600.0;
};

/// A pair of points that the data association took for one and the same, in file coordinates [m].
/// Heights are those of the two ground planes: the association is a matter of the plane.
struct MatchedPair {
  Eigen::Vector3d moving;
  Eigen::Vector3d fixed;
};

/// Matches, and how many of them the method took for coherent.
struct MatchSet {
  std::vector<MatchedPair> pairs;  ///< before anything coherent was chosen from them
  std::size_t inliers = 0;
};

/// What a method found. No transform: it has no answer, and `why` says why.
struct MethodOutcome {
  std::optional<Eigen::Affine3d> fixed_from_moving;  ///< moving file → fixed file [m]
  bool accepted = false;            ///< whether the method itself stands by its transform
  std::string why;                  ///< in plain words when it does not
  StageTimes times;                 ///< seconds per stage
  std::optional<MatchSet> matches;  ///< of methods that match points
  /// Of those that match again from what the first matching gave: what the result is fitted to.
  std::optional<MatchSet> rematches;
};

class Method {
 public:
  Method() = default;
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  virtual std::string name() const = 0;
  virtual std::string about() const = 0;  ///< one line
  /// Registers. Clouds that cannot be used, too, are an outcome without a transform: never an
  /// exception and never the guess handed back. Throws Interrupted.
  MethodOutcome run(const MethodInput& input) const;

 protected:
  /// Fills `outcome`; may throw InputError.
  virtual void attempt(const MethodInput& input, MethodOutcome& outcome) const = 0;
};

/// Names of all methods, the product's first.
std::vector<std::string> methodNames();
/// Throws UsageError, listing the known names, for an unknown one.
std::unique_ptr<Method> makeMethod(const std::string& name);

/// The method with the true horizontal scales applied to its guess beforehand, about the middle of
/// the moving cloud, so that its scale is not the reason why it loses. Named `…-oracle-scale`.
std::unique_ptr<Method> withOracleScale(std::unique_ptr<Method> method);

}  // namespace agricolmap::experiments
