#include "agricolmap/core/affine_fit.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap {
namespace {

/// More than one chunk of the sums.
Cloud strip(double relief) {
  Random random(4);
  Cloud cloud;
  cloud.origin = {432000.0, 5200000.0, 400.0};
  for (int i = 0; i < 40000; ++i) {
    cloud.xyz.emplace_back(static_cast<float>(random.uniform(0.0, 10.0)),
                           static_cast<float>(random.uniform(0.0, 2.0)),
                           static_cast<float>(random.normal(relief)));
  }
  return cloud;
}

std::vector<Eigen::Vector3d> mapped(const Cloud& cloud, const Eigen::Affine3d& affine) {
  std::vector<Eigen::Vector3d> targets;
  for (std::size_t i = 0; i < cloud.size(); ++i) targets.push_back(affine * cloud.filePoint(i));
  return targets;
}

double worst(const Cloud& cloud, const Eigen::Affine3d& affine,
             const std::vector<Eigen::Vector3d>& targets) {
  double largest = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    largest = std::max(largest, (affine * cloud.filePoint(i) - targets[i]).norm());
  }
  return largest;
}

Eigen::Affine3d shearedAffine() {
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.linear() << 0.9, -0.2, 0.01, 0.25, 1.1, 0.0, 0.02, -0.01, 1.0;
  affine.translation() << 352000.0, 4815000.0, 120.0;
  return affine;
}

TEST(FitAffine, RecoversAnAffineInUtmCoordinates) {
  const Cloud cloud = strip(0.05);
  const std::vector<Eigen::Vector3d> targets = mapped(cloud, shearedAffine());
  const Eigen::Affine3d fit = fitAffine(cloud, targets);
  EXPECT_LT(worst(cloud, fit, targets), 1e-6);
  EXPECT_TRUE(fit.linear().isApprox(shearedAffine().linear(), 1e-6));
  const ThreadLimit limit(1);
  EXPECT_EQ(fitAffine(cloud, targets).matrix(), fit.matrix());
}

TEST(FitAffine, MapsThePointsOfAFlatCloud) {
  const Cloud cloud = strip(0.0);
  const std::vector<Eigen::Vector3d> targets = mapped(cloud, shearedAffine());
  EXPECT_LT(worst(cloud, fitAffine(cloud, targets), targets), 1e-6);
}

TEST(FitAffine, IsTheLeastSumOfSquares) {
  const Cloud cloud = strip(0.05);
  std::vector<Eigen::Vector3d> targets = mapped(cloud, shearedAffine());
  Random random(5);
  for (Eigen::Vector3d& t : targets) t += Eigen::Vector3d::Constant(random.normal(0.1));
  const Eigen::Affine3d fit = fitAffine(cloud, targets);
  // At the least sum the residuals are perpendicular to the points and to a shift.
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3d along = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d residual = targets[i] - fit * cloud.filePoint(i);
    shift += residual;
    along += residual * cloud.xyz[i].cast<double>().transpose();
  }
  const auto count = static_cast<double>(cloud.size());
  EXPECT_LT(shift.norm() / count, 1e-8);
  EXPECT_LT(along.norm() / count, 1e-7);
}

TEST(FitAffine, RefusesTooFewPointsAndOtherNumbers) {
  Cloud cloud = strip(0.05);
  std::vector<Eigen::Vector3d> targets = mapped(cloud, shearedAffine());
  targets.pop_back();
  EXPECT_THROW(fitAffine(cloud, targets), InputError);
  cloud.xyz.resize(3);
  targets.resize(3);
  EXPECT_THROW(fitAffine(cloud, targets), InputError);
  EXPECT_THROW(fitAffine({}, {}), InputError);
  EXPECT_EQ(meanPoint({}), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace agricolmap
