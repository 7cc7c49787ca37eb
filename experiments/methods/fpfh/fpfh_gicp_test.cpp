// FPFH and GICP: right from centimetres off, the same twice, clear failures.
#include <gtest/gtest.h>

#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

PriorUncertainty nearPrior() {
  PriorUncertainty prior;
  prior.translation = 0.5;
  prior.heading_deg = 2.0;
  prior.scale = 0.0;
  return prior;
}

TEST(FpfhGicp, IsRightFromNearbyAndTheSameTwice) {
  testing::GuessError error;
  error.shift = {0.02, -0.02};
  const MethodInput input = testing::inputOf(testing::smallPair(), error, nearPrior());
  const MethodOutcome outcome = makeMethod("fpfh-gicp").run(input);
  ASSERT_TRUE(outcome.fixed_from_moving.has_value()) << outcome.why;
  const evaluate::RegistrationErrors errors = testing::errorsOf(outcome, testing::smallPair());
  EXPECT_TRUE(errors.within({})) << "RMS " << errors.rms << " m, horizontal "
                                 << errors.rms_horizontal;
  const MethodOutcome again = makeMethod("fpfh-gicp").run(input);
  ASSERT_TRUE(again.fixed_from_moving.has_value());
  EXPECT_EQ(outcome.fixed_from_moving->matrix(), again.fixed_from_moving->matrix());
}

TEST(FpfhGicp, OracleScaleMendsItsScale) {
  testing::GuessError error;
  error.shift = {0.02, 0.01};
  error.scale = {1.15, 0.9};
  MethodInput input = testing::inputOf(testing::smallPair(), error, nearPrior());
  input.truth = testing::smallPair().best_affine;
  const MethodOutcome outcome = makeMethod("fpfh-gicp-oracle-scale").run(input);
  ASSERT_TRUE(outcome.fixed_from_moving.has_value()) << outcome.why;
  EXPECT_TRUE(testing::errorsOf(outcome, testing::smallPair()).within({}))
      << testing::errorsOf(outcome, testing::smallPair()).rms;
}

TEST(FpfhGicp, FailsOnEmptyMaps) { testing::expectFailsOnEmptyMaps(makeMethod("fpfh-gicp")); }

}  // namespace
}  // namespace agricolmap::experiments
