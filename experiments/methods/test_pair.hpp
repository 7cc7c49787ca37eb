// What the tests of all methods share: a small simulated pair with exact truth, and a guess that is
// wrong by as much as a test says.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "agricolmap/core/transform.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/pipeline/pair_maps.hpp"
#include "agricolmap/simulate/simulate.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments::testing {

/// By how much a guess is wrong, about the middle of the moving cloud.
struct GuessError {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]
  double heading = 0.0;                             ///< [rad]
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();  ///< along the moving file's axes
};

/// A strip of 6 m in a field of sugar beets of 14 m, made once.
inline const simulate::SimulatedPair& smallPair() {
  static const simulate::SimulatedPair pair = [] {
    simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
    options.field.width = 14.0;
    options.field.height = 14.0;
    options.ugv.length = 6.0;
    options.seed = 31;
    return simulate::simulatePair(options);
  }();
  return pair;
}

/// The truth, off by `error`: what the guess would be if nothing else were wrong with it.
inline Eigen::Affine3d guessOff(const simulate::SimulatedPair& pair, const GuessError& error) {
  const Eigen::Vector3d middle = pipeline::meanOf(pair.ugv);
  const Eigen::Vector3d there = pair.best_affine * middle;
  const Eigen::Translation3d shift(error.shift.x(), error.shift.y(), 0.0);
  return shift * Eigen::Translation3d(there) *
         Eigen::AngleAxisd(error.heading, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-there) *
         pair.best_affine * Eigen::Translation3d(middle) *
         Eigen::Scaling(error.scale.x(), error.scale.y(), 1.0) * Eigen::Translation3d(-middle);
}

inline MethodInput inputOf(const simulate::SimulatedPair& pair, const GuessError& error,
                           const PriorUncertainty& prior) {
  return {.fixed = pair.uav, .moving = pair.ugv, .guess = guessOff(pair, error), .prior = prior};
}

/// Errors of an outcome that has a transform.
inline evaluate::RegistrationErrors errorsOf(const MethodOutcome& outcome,
                                             const simulate::SimulatedPair& pair) {
  return evaluate::evaluateTransform(*outcome.fixed_from_moving, {pair.best_affine, pair.truth},
                                     pair.ugv);
}

/// Runs the method on the small pair and expects it within the paper's limits.
inline void expectRight(const Method& method, const GuessError& error,
                        const PriorUncertainty& prior) {
  const MethodOutcome outcome = method.run(inputOf(smallPair(), error, prior));
  ASSERT_TRUE(outcome.fixed_from_moving.has_value()) << method.name << ": " << outcome.why;
  const evaluate::RegistrationErrors errors = errorsOf(outcome, smallPair());
  EXPECT_TRUE(errors.within({})) << method.name << ": RMS " << errors.rms << " m ("
                                 << errors.rms_horizontal << " horizontal), e_t "
                                 << errors.translation << " m, e_r " << errors.rotation
                                 << " rad, e_s " << errors.scale << " " << outcome.why;
}

/// Runs a local method from where it cannot be right, and expects that it is not.
inline void expectLost(const Method& method, const GuessError& error) {
  const MethodOutcome outcome = method.run(inputOf(smallPair(), error, {}));
  if (outcome.fixed_from_moving) {
    EXPECT_FALSE(errorsOf(outcome, smallPair()).within({})) << method.name;
  }
}

/// An empty map, and one without plants, are clear failures and never the guess handed back.
inline void expectFailsOnEmptyMaps(const Method& method) {
  const simulate::SimulatedPair& pair = smallPair();
  Cloud none;
  none.name = "none.ply";
  MethodInput input{.fixed = none, .moving = pair.ugv, .guess = pair.best_affine};
  input.truth = pair.best_affine;
  const MethodOutcome empty = method.run(input);
  EXPECT_FALSE(empty.fixed_from_moving.has_value()) << method.name;
  EXPECT_FALSE(empty.accepted);
  EXPECT_NE(empty.why.find("none.ply"), std::string::npos) << empty.why;
  // The strip lies far outside the fixed map.
  const Eigen::Affine3d away = Eigen::Translation3d(500.0, 0.0, 0.0) * pair.best_affine;
  MethodInput outside{.fixed = pair.uav, .moving = pair.ugv, .guess = away};
  outside.truth = pair.best_affine;
  const MethodOutcome nothing = method.run(outside);
  EXPECT_FALSE(nothing.fixed_from_moving.has_value()) << method.name;
  EXPECT_FALSE(nothing.why.empty());
}

}  // namespace agricolmap::experiments::testing
