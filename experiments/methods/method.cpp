#include "experiments/methods/method.hpp"

#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/pipeline/pair_maps.hpp"

namespace agricolmap::experiments {
namespace {

/// The guess with the true scales along the moving file's x and y axes.
Eigen::Affine3d withTrueScales(const Eigen::Affine3d& guess, const Eigen::Affine3d& truth,
                               const Eigen::Vector3d& middle) {
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  for (int axis = 0; axis < 2; ++axis) {
    scale[axis] = truth.linear().col(axis).norm() / guess.linear().col(axis).norm();
  }
  return guess * Eigen::Translation3d(middle) * Eigen::Scaling(scale) *
         Eigen::Translation3d(-middle);
}

}  // namespace

MethodOutcome Method::run(const MethodInput& input) const {
  MethodOutcome outcome;
  try {
    for (const Cloud* cloud : {&input.fixed, &input.moving}) {
      if (cloud->empty()) throw InputError(cloud->name + ": has no points");
    }
    attempt(input, outcome);
  } catch (const InputError& error) {
    outcome.fixed_from_moving.reset();
    outcome.accepted = false;
    outcome.why = error.what();
  }
  return outcome;
}

Method withOracleScale(Method method) {
  Method helped = method;
  helped.name += "-oracle-scale";
  helped.about += "; the true horizontal scales are given to it";
  helped.traits.rigid = false;
  helped.attempt = [method = std::move(method)](const MethodInput& input, MethodOutcome& outcome) {
    if (!input.truth) {
      throw UsageError(method.name + "-oracle-scale: needs the true transform, for its scales");
    }
    MethodInput known = input;
    known.guess = withTrueScales(input.guess, *input.truth, pipeline::meanOf(input.moving));
    known.truth.reset();
    known.prior.scale = 0.0;
    outcome = method.run(known);
  };
  return helped;
}

}  // namespace agricolmap::experiments
