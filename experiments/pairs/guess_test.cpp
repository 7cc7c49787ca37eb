// Guesses: wrong by exactly as much as asked, the same for the same seed.
#include "experiments/pairs/guess.hpp"

#include <gtest/gtest.h>

namespace agricolmap::experiments {
namespace {

Cloud squareCloud() {
  Cloud cloud;
  cloud.origin = {464000.0, 5257000.0, 500.0};
  cloud.xyz = {{0.0F, 0.0F, 0.0F}, {4.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {4.0F, 2.0F, 0.2F}};
  return cloud;
}

TEST(Guess, GuessIsWrongByExactlyTheSettingAtTheMiddle) {
  const Cloud cloud = squareCloud();
  const AddedError error{1.0, 5.0, 0.2, 0.3};
  const Eigen::Affine3d exact(Eigen::Translation3d(10.0, -20.0, 1.0));
  const Eigen::Affine3d guess = wrongGuess("joint", error, 7, cloud, exact);
  const Eigen::Vector3d middle = cloud.origin + Eigen::Vector3d(2.0, 1.0, 0.05);
  EXPECT_NEAR((guess * middle - exact * middle).norm(), 5.0, 1e-6);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(guess.linear() * exact.linear().transpose()));
  EXPECT_NEAR(turn.angle(), 0.2, 1e-9);
  EXPECT_TRUE(wrongGuess("joint", error, 7, cloud, exact).isApprox(guess, 0.0))
      << "keyed, not drawn in turn";
  EXPECT_FALSE(wrongGuess("joint", error, 8, cloud, exact).isApprox(guess));
}

TEST(Guess, ScaleErrorKeepsTheMiddleAndFarCoordinates) {
  Cloud cloud = squareCloud();
  const AddedError error{0.3, 0.05, 0.01, 0.3};
  const Eigen::Affine3d scaled = scaleError(error, 3, cloud);
  const Eigen::Vector3d middle = cloud.origin + Eigen::Vector3d(2.0, 1.0, 0.05);
  EXPECT_NEAR((scaled * middle - middle).norm(), 0.0, 1e-6);
  EXPECT_NEAR(std::abs(scaled.linear()(0, 0) - 1.0), 0.3, 1e-12);
  EXPECT_NEAR(std::abs(scaled.linear()(1, 1) - 1.0), 0.3, 1e-12);
  const Eigen::Vector3d before = cloud.filePoint(1);
  transformCloud(cloud, scaled);
  EXPECT_NEAR((cloud.filePoint(1) - scaled * before).norm(), 0.0, 1e-6);
}

TEST(Guess, MethodsAreToldThePapersLimitsOrWider) {
  EXPECT_EQ(toldText(AddedError{5.0, 5.0, 0.0, 0.3}.told()), "5,11.5,30");
  EXPECT_EQ(toldText(AddedError{10.0, 10.0, 0.0, 0.0}.told()), "10,11.5,30");
  EXPECT_EQ(toldText(AddedError{0.4, 0.0, 0.4, 0.0}.told()), "5,23,30");
}

TEST(Guess, NoGuessAndUnknownUnitsAreSaid) {
  PriorUncertainty unit;
  unit.scale_unknown = true;
  EXPECT_EQ(toldText(unit), "5,11.5,30,unit");
  EXPECT_EQ(toldText(PriorUncertainty::none()), "none");
}

}  // namespace
}  // namespace agricolmap::experiments
