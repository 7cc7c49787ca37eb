#include "agricolmap/control_points/control_points.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/control_points/control_points_report.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::control_points {
namespace {

const Eigen::Vector3d kMovingOrigin(5012.0, -380.0, 7.0);
const Eigen::Vector3d kFixedOrigin(432017.25, 5255321.75, 412.5);

/// A strip of 10 × 2.2 m with relief, turned, tilted and scaled along its own axes, into UTM.
Eigen::Affine3d trueScales(double yaw_deg, double tilt_deg) {
  Eigen::Affine3d fixed_from_moving = Eigen::Affine3d::Identity();
  fixed_from_moving.linear() =
      (Eigen::AngleAxisd(radians(yaw_deg), Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(radians(tilt_deg), Eigen::Vector3d(0.6, 0.8, 0.0)))
          .toRotationMatrix() *
      Eigen::Vector3d(1.21, 0.83, 1.0).asDiagonal();
  fixed_from_moving.translation() = kFixedOrigin - fixed_from_moving.linear() * kMovingOrigin;
  return fixed_from_moving;
}

std::vector<ControlPair> picked(const Eigen::Affine3d& truth, int count, double noise,
                                std::uint64_t seed, double relief = 0.1) {
  Random random(seed);
  std::vector<ControlPair> pairs;
  for (int i = 0; i < count; ++i) {
    ControlPair pair;
    pair.name = fmt::format("p{}", i);
    pair.moving = kMovingOrigin + Eigen::Vector3d(random.uniform(-5.0, 5.0),
                                                  random.uniform(-1.1, 1.1), random.normal(relief));
    pair.fixed = truth * pair.moving + Eigen::Vector3d(random.normal(noise), random.normal(noise),
                                                       random.normal(2.0 * noise));
    pairs.push_back(pair);
  }
  return pairs;
}

/// How far apart two transformations put the corners of the strip [m].
double apart(const Eigen::Affine3d& a, const Eigen::Affine3d& b) {
  double worst = 0.0;
  for (const double x : {-5.0, 5.0}) {
    for (const double y : {-1.1, 1.1}) {
      const Eigen::Vector3d corner = kMovingOrigin + Eigen::Vector3d(x, y, 0.0);
      worst = std::max(worst, (a * corner - b * corner).norm());
    }
  }
  return worst;
}

ControlEstimate estimate(const std::vector<ControlPair>& pairs,
                         ControlModel model = ControlModel::kScales) {
  return estimateFromPairs(pairs, {.model = model}, "pairs.csv");
}

bool warns(const ControlEstimate& result, const std::string& part) {
  return std::any_of(result.warnings.begin(), result.warnings.end(),
                     [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

TEST(ControlPoints, ExactPairsGiveTheExactTransformation) {
  for (const double yaw : {0.0, 12.0, -170.0}) {
    for (const double tilt : {0.0, 3.0, 35.0}) {
      const Eigen::Affine3d truth = trueScales(yaw, tilt);
      const ControlEstimate result = estimate(picked(truth, 8, 0.0, 1));
      // UTM northings have nine digits before what a double can hold: 1e-9 m.
      EXPECT_LT(apart(result.fixed_from_moving, truth), 2e-8) << yaw << " " << tilt;
      EXPECT_NEAR(result.parts.scale.x(), 1.21, 1e-8);
      EXPECT_NEAR(result.parts.scale.y(), 0.83, 1e-8);
      EXPECT_NEAR(result.parts.scale.z(), 1.0, 1e-12);
      EXPECT_LT(result.parts.shear.norm(), 1e-12);
      EXPECT_LT(result.left_out.spatial(), 1e-7);
      for (const PairResidual& r : result.residuals) EXPECT_FALSE(r.outlier);
    }
  }
}

TEST(ControlPoints, AnglesAreThoseOfOffsetFiles) {
  const ControlEstimate result = estimate(picked(trueScales(30.0, 0.0), 8, 0.0, 1));
  EXPECT_NEAR(result.parts.angles.z(), radians(30.0), 1e-8);
  EXPECT_NEAR(result.parts.angles.x(), 0.0, 1e-7);
  EXPECT_NEAR(result.parts.angles.y(), 0.0, 1e-7);
}

TEST(ControlPoints, GrossMistakesAreSetAside) {
  const Eigen::Affine3d truth = trueScales(12.0, 2.0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<ControlPair> pairs = picked(truth, 12, 0.01, seed);
    pairs[2].fixed.x() += 0.30;   // the next plant
    pairs[7].fixed.y() -= 0.50;   // the next row
    pairs[11].fixed.z() += 0.40;  // a leaf for the ground
    const ControlEstimate result = estimate(pairs);
    EXPECT_LT(apart(result.fixed_from_moving, truth), 0.08) << seed;
    for (const std::size_t i : {2, 7, 11}) {
      EXPECT_TRUE(result.residuals[i].outlier) << seed << " " << i;
      EXPECT_EQ(result.residuals[i].weight, 0.0);
    }
    EXPECT_GE(result.control.count, 7U);
    EXPECT_TRUE(warns(result, "p2, p7, p11") || result.control.count < 9) << seed;
  }
}

/// Of `count` pairs each, over many seeds: how often honest ones were set aside and wrong ones
/// found, with `wrong` of them off by the distance to the next plant.
struct Judgement {
  double honest_called = 0.0;
  double wrong_found = 0.0;
};
Judgement judgedOver(int count, int wrong) {
  constexpr int kSeeds = 60;
  Judgement judgement;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    std::vector<ControlPair> pairs = picked(trueScales(-8.0, 1.0), count, 0.01, seed);
    for (int i = 0; i < wrong; ++i) pairs[static_cast<std::size_t>(2 * i)].fixed.x() += 0.2;
    const ControlEstimate result = estimate(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool is_wrong = i % 2 == 0 && i < 2 * static_cast<std::size_t>(wrong);
      const double called = result.residuals[i].outlier ? 1.0 / kSeeds : 0.0;
      if (is_wrong) {
        judgement.wrong_found += called / wrong;
      } else {
        judgement.honest_called += called / (count - wrong);
      }
    }
  }
  return judgement;
}

TEST(ControlPoints, HonestPairsAreSeldomCalledOutliers) {
  for (const auto& [count, wrong] : std::vector<std::pair<int, int>>{{4, 0},
                                                                     {5, 0},
                                                                     {6, 0},
                                                                     {8, 0},
                                                                     {12, 0},
                                                                     {20, 0},
                                                                     {6, 1},
                                                                     {8, 1},
                                                                     {10, 2},
                                                                     {14, 4},
                                                                     {20, 6}}) {
    const Judgement judgement = judgedOver(count, wrong);
    EXPECT_LT(judgement.honest_called, 0.01) << wrong << " wrong of " << count;
    if (wrong > 0) {
      EXPECT_GT(judgement.wrong_found, 0.95) << wrong << " wrong of " << count;
    }
  }
}

TEST(ControlPoints, LeftOutResidualsAreThoseOfAFitWithoutThePair) {
  std::vector<ControlPair> pairs = picked(trueScales(12.0, 1.0), 9, 0.004, 3);
  const ControlEstimate all = estimate(pairs);
  // A pair as check point is one that is left out; only the weights of the others may differ a bit.
  pairs[4].use = PairUse::kCheck;
  const ControlEstimate without = estimate(pairs);
  EXPECT_LT((all.residuals[4].left_out - without.residuals[4].residual).norm(), 0.003);
  EXPECT_GT(all.left_out.spatial(), all.control.spatial());
  EXPECT_EQ(without.check.count, 1U);
  EXPECT_TRUE(std::isnan(without.residuals[4].left_out.x()));
  EXPECT_EQ(without.residuals[4].weight, 0.0);
}

TEST(ControlPoints, CheckPointsDoNotPull) {
  const Eigen::Affine3d truth = trueScales(12.0, 1.0);
  std::vector<ControlPair> pairs = picked(truth, 14, 0.0, 5);
  for (const std::size_t i : {1, 5, 9, 13}) {
    pairs[i].use = PairUse::kCheck;
    pairs[i].fixed += Eigen::Vector3d(0.03, -0.04, 0.12);
  }
  const ControlEstimate result = estimate(pairs);
  EXPECT_LT(apart(result.fixed_from_moving, truth), 2e-8);
  EXPECT_EQ(result.check.count, 4U);
  // Residuals are transformed − fixed.
  EXPECT_NEAR((result.check.mean - Eigen::Vector3d(-0.03, 0.04, -0.12)).norm(), 0.0, 1e-7);
  EXPECT_NEAR(result.check.rms.z(), 0.12, 1e-7);
  EXPECT_NEAR(result.check.horizontal(), 0.05, 1e-7);
  EXPECT_NEAR(result.check.spatial(), 0.13, 1e-7);
  EXPECT_TRUE(warns(result, "p1, p5, p9, p13"));
  EXPECT_FALSE(warns(result, "no check points"));
}

TEST(ControlPoints, DeviationsTellHowWellAScaleIsKnown) {
  const Eigen::Affine3d truth = trueScales(12.0, 0.0);
  double square = 0.0;
  double claimed = 0.0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const ControlEstimate result = estimate(picked(truth, 15, 0.01, seed));
    square += std::pow(result.parts.scale.y() - 0.83, 2) / kRuns;
    claimed += std::pow(result.deviations.scale.y(), 2) / kRuns;
  }
  EXPECT_NEAR(std::sqrt(claimed / square), 1.0, 0.35);
}

TEST(ControlPoints, WarnsWhereThereAreTooFewPairs) {
  const Eigen::Affine3d truth = trueScales(12.0, 0.0);
  const ControlEstimate few = estimate(picked(truth, 4, 0.02, 2));
  EXPECT_TRUE(warns(few, "too few"));
  EXPECT_TRUE(warns(few, "no check points"));
  const ControlEstimate many = estimate(picked(truth, 24, 0.01, 2));
  EXPECT_FALSE(warns(many, "too few"));
  const ControlEstimate loose = estimate(picked(truth, 24, 0.15, 2));
  EXPECT_TRUE(warns(loose, "moving file's y"));
  EXPECT_TRUE(warns(loose, "no truth to measure"));
}

TEST(ControlPoints, AFullAffineTakesShearAndVerticalScale) {
  Eigen::Affine3d truth = trueScales(12.0, 2.0);
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 0.05;
  shear(1, 2) = -0.02;
  truth.linear() = truth.linear() * shear * Eigen::Vector3d(1.0, 1.0, 1.1).asDiagonal();
  truth.translation() = kFixedOrigin - truth.linear() * kMovingOrigin;
  std::vector<ControlPair> pairs = picked(truth, 12, 0.0, 7, 0.4);
  const ControlEstimate exact = estimate(pairs, ControlModel::kAffine);
  EXPECT_LT(apart(exact.fixed_from_moving, truth), 2e-8);
  EXPECT_NEAR(exact.parts.scale.z(), 1.1, 0.01);
  EXPECT_GT(std::abs(exact.parts.shear.x()), 0.03);
  pairs[3].fixed.x() += 0.4;
  const ControlEstimate result = estimate(pairs, ControlModel::kAffine);
  EXPECT_TRUE(result.residuals[3].outlier);
  EXPECT_LT(apart(result.fixed_from_moving, truth), 1e-7);
  // The model of scales cannot follow the shear and says so by its residuals.
  EXPECT_GT(estimate(picked(truth, 12, 0.0, 7, 0.4)).control.spatial(), 0.02);
}

TEST(ControlPoints, PairsThatDetermineNothingAreRefused) {
  const Eigen::Affine3d truth = trueScales(12.0, 0.0);
  const std::vector<ControlPair> good = picked(truth, 8, 0.0, 1);
  const auto fails = [](std::vector<ControlPair> pairs, ControlModel model,
                        std::initializer_list<const char*> parts) {
    test::expectError<InputError>([&] { estimate(pairs, model); }, parts);
  };
  fails({good.begin(), good.begin() + 3}, ControlModel::kScales,
        {"pairs.csv", "3 control pairs", "needs 4"});
  fails({}, ControlModel::kScales, {"0 control pairs"});
  std::vector<ControlPair> pairs = good;
  for (ControlPair& pair : pairs) pair.moving = good[0].moving;
  fails(pairs, ControlModel::kScales, {"on one spot"});
  pairs = good;
  for (ControlPair& pair : pairs) {
    pair.moving.y() = kMovingOrigin.y() + 0.3 * (pair.moving.x() - kMovingOrigin.x());
    pair.fixed = truth * pair.moving;
  }
  fails(pairs, ControlModel::kScales, {"on a line", "scale across"});
  // Only one pair off the line: there is an answer, but nothing that could show a mistake.
  pairs.push_back(good[1]);
  pairs.back().name = "lonely";
  EXPECT_TRUE(warns(estimate(pairs), "without lonely the others"));
  fails(picked(truth, 8, 0.0, 1, 0.01), ControlModel::kAffine, {"in a plane", "'scales'"});
  pairs = good;
  for (ControlPair& pair : pairs) std::swap(pair.fixed.x(), pair.fixed.y());
  fails(pairs, ControlModel::kScales, {"mirrored", "easting"});
}

TEST(ControlPoints, SameOnAnyNumberOfThreads) {
  // More than are tried in all combinations, so that random ones are drawn.
  std::vector<ControlPair> pairs = picked(trueScales(12.0, 1.0), 60, 0.01, 9);
  for (std::size_t i = 0; i < pairs.size(); i += 4) pairs[i].fixed.x() += 0.2;
  std::string first;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const ControlEstimate result = estimate(pairs);
    const std::string text =
        controlPointsJson(pairs, result, "a").dump() + residualsCsv(pairs, result);
    if (first.empty()) first = text;
    EXPECT_EQ(text, first);
  }
}

TEST(ControlPoints, ReportsStandUpToAnyName) {
  std::vector<ControlPair> pairs = picked(trueScales(12.0, 1.0), 8, 0.01, 9);
  pairs[0].name = "post, \"north\"";
  pairs[1].name = "Pf\xE4hl";  // Latin-1, no UTF-8
  const ControlEstimate result = estimate(pairs);
  const std::string csv = residualsCsv(pairs, result);
  EXPECT_NE(csv.find("\n\"post, \"\"north\"\"\",control,no,"), std::string::npos) << csv;
  const nlohmann::ordered_json json = controlPointsJson(pairs, result, "pairs.csv");
  EXPECT_NO_THROW(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  EXPECT_TRUE(json["check"].is_null());
  EXPECT_EQ(json["pairs"].size(), 8U);
  EXPECT_EQ(json["matrix"].size(), 4U);
  const std::string table = residualsTable(pairs, result);
  EXPECT_NE(table.find("RMSE left out"), std::string::npos);
  EXPECT_NE(table.find("Pf\xE4hl"), std::string::npos);
}

}  // namespace
}  // namespace agricolmap::control_points
