#include "agricolmap/evaluate/metrics.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::evaluate {
namespace {

Cloud strip() {
  Random random(2);
  Cloud cloud;
  cloud.origin = {432000, 5200000, 400};
  for (int i = 0; i < 5000; ++i) {
    cloud.xyz.emplace_back(static_cast<float>(random.uniform(-5, 5)),
                           static_cast<float>(random.uniform(-1, 1)),
                           static_cast<float>(random.uniform(0, 0.2)));
  }
  return cloud;
}

Eigen::Affine3d someAffine() {
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                    Eigen::Vector3d(1.2, 0.8, 1.0).asDiagonal();
  affine.translation() = Eigen::Vector3d(3, -2, 0.5);
  return affine;
}

TEST(Metrics, TruthHasNoError) {
  const Cloud cloud = strip();
  const Truth truth{someAffine(), {}};
  const RegistrationErrors errors = evaluateTransform(truth.best_affine, truth, cloud);
  EXPECT_LT(errors.rms, 1e-8);
  EXPECT_LT(errors.scale, 1e-12);
  EXPECT_TRUE(errors.within({}));
}

TEST(Metrics, ShiftAndScaleAreSeenWhereTheyAre) {
  const Cloud cloud = strip();
  const Truth truth{someAffine(), {}};
  const RegistrationErrors shifted =
      evaluateTransform(Eigen::Translation3d(0.03, 0, 0.04) * truth.best_affine, truth, cloud);
  EXPECT_NEAR(shifted.rms, 0.05, 1e-6);
  EXPECT_NEAR(shifted.rms_horizontal, 0.03, 1e-6);
  EXPECT_NEAR(shifted.translation, 0.05, 1e-6);
  EXPECT_NEAR(shifted.rotation, 0.0, 1e-6);
  Eigen::Affine3d scaled = truth.best_affine;
  scaled.linear().col(0) *= 1.05;
  EXPECT_NEAR(evaluateTransform(scaled, truth, cloud).scale, 0.05, 1e-9);
}

TEST(Metrics, ShearOfWhatAFlatMapDoesNotShowIsNoRotation) {
  const Cloud cloud = strip();
  Eigen::Affine3d sheared = someAffine();
  sheared.linear().col(2) += 0.3 * sheared.linear().col(0);
  EXPECT_NEAR(evaluateTransform(sheared, {someAffine(), {}}, cloud).rotation, 0.0, 1e-6);
}

TEST(Metrics, NumbersOfPointsMustAgree) {
  const Cloud cloud = strip();
  const Truth truth{someAffine(), {Eigen::Vector3d::Zero()}};
  EXPECT_THROW(evaluateTransform(someAffine(), truth, cloud), InputError);
  EXPECT_THROW(evaluateTransform(someAffine(), {}, {}), InputError);
}

}  // namespace
}  // namespace agricolmap::evaluate
