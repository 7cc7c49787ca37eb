// Strips of a field of plants that are bent and slipped by a known amount.
#include "agricolmap/deform/deform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/deform/file_deformation.hpp"
#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::deform {
namespace {

using Offset = std::function<Eigen::Vector2d(double)>;
using testing::TestField;
using testing::TestScene;

constexpr double kLength = 8.0;
const testing::TestError kError{{0.3, -0.2}, 0.03, 1.02, 0.98};
const TestField kField{.size = 13.0, .other_leaves = 0.2};

refine::VerticalResult flat() {
  refine::VerticalResult heights;
  heights.status = refine::VerticalStatus::kOk;
  return heights;
}

struct BentScene {
  explicit BentScene(const Offset& offset)
      : scene(testing::bentScene(kField, kError, kLength, 5, offset)) {}
  std::optional<Bend> follow(const std::vector<PieceOffset>& pieces = {},
                             const BendOptions& options = {},
                             const std::optional<Path>& path = {}) const {
    const correlation::MapSignals fixed(scene.fixed, {});
    const correlation::MapSignals moving(scene.moving, {});
    const refine::PairSignals signals(fixed, moving, {}, {});
    const Path straight = straightPath(map::stripFrame(signals.moving().at(3)));
    return followBend(signals, scene.pose, flat(), path ? *path : straight, pieces, options);
  }
  /// How far the strip is off, root mean square along its middle [m].
  double errorOf(const std::optional<Bend>& bend, const Offset& offset) const {
    const GridFrame& frame = scene.moving.frame;
    double sum = 0.0, count = 0.0;
    for (double x = 0.05; x < kLength; x += 0.1) {
      const Eigen::Vector2d p = frame.corner + Eigen::Vector2d(x, 0.5 * frame.rows * frame.cell);
      Eigen::Vector2d lies = scene.pose * p;
      if (bend) lies = bend->pose * p + bend->deformation.at(p).head<2>();
      sum += (lies - (scene.pose * p + offset(x))).squaredNorm();
      count += 1.0;
    }
    return std::sqrt(sum / count);
  }
  TestScene scene;
};

const Offset kNone = [](double) { return Eigen::Vector2d(0.0, 0.0); };
const Offset kDrift = [](double x) {
  return Eigen::Vector2d(0.02 * std::sin(0.9 * x), 0.05 * std::cos(0.7 * x));
};
const Offset kSlipped = [](double x) { return Eigen::Vector2d(0.0, x > 5.0 ? 0.3 : 0.0); };

TEST(Deform, FollowsDrift) {
  const BentScene bent(kDrift);
  const auto bend = bent.follow();
  ASSERT_TRUE(bend);
  EXPECT_TRUE(bend->deformation.slips.empty());
  const map::SignalMap map = map::makeSignalMap(bent.scene.moving, 3, {});
  EXPECT_TRUE(moveOfLongestStretch(map, *bend).isApprox(Eigen::Affine2d::Identity()));
  const double before = bent.errorOf({}, kDrift);
  EXPECT_LT(bent.errorOf(bend, kDrift), std::min(0.008, 0.3 * before));
  EXPECT_NE(describe(*bend).find("bend"), std::string::npos);
}

TEST(Deform, FollowsDriftAlongAPathThatTurns) {
  const BentScene bent(kDrift);
  const GridFrame& frame = bent.scene.moving.frame;
  const Eigen::Vector2d start = frame.corner + Eigen::Vector2d(0.0, 0.5 * frame.rows * frame.cell);
  const Path path(
      {start, start + Eigen::Vector2d(0.5 * kLength, 0.6), start + Eigen::Vector2d(kLength, -0.3)});
  const auto bend = bent.follow({}, {}, path);
  ASSERT_TRUE(bend);
  EXPECT_EQ(bend->deformation.path().corners(), path.corners());
  EXPECT_LT(bent.errorOf(bend, kDrift), 0.01);
}

TEST(Deform, InventsNoneWhereNothingBends) {
  const BentScene straight(kNone);
  const auto bend = straight.follow();
  if (bend) {
    EXPECT_LT(straight.errorOf(bend, kNone), 0.003);
  }
  EXPECT_FALSE(straight.follow({}, {.min_gain = 6.0}));
}

TEST(Deform, FollowsASlipAndTellsWhereItIs) {
  const BentScene slipped(kSlipped);
  std::vector<PieceOffset> pieces;
  for (double x = 0.4; x < kLength; x += 0.8) {
    pieces.push_back({x, x > 5.2 ? Eigen::Vector2d(0.01, 0.28) : Eigen::Vector2d(0.0, 0.01)});
  }
  const auto bend = slipped.follow(pieces);
  ASSERT_TRUE(bend);
  ASSERT_EQ(bend->deformation.slips.size(), 1U);
  const Slip& slip = bend->deformation.slips.front();
  EXPECT_NEAR(slip.offset.norm(), 0.3, 0.03);
  EXPECT_NEAR(slip.along, 5.0, 0.15);
  EXPECT_LT(slipped.errorOf(bend, kSlipped), 0.05);
  EXPECT_NE(describe(*bend).find("slip"), std::string::npos);
  // The whole's affine is turned by the slip, that of the part before it is not.
  const map::SignalMap map = map::makeSignalMap(slipped.scene.moving, 3, {});
  const Eigen::Matrix2d part = (bend->pose * moveOfLongestStretch(map, *bend)).linear();
  const Eigen::Matrix2d truth = slipped.scene.pose.linear();
  EXPECT_GT((bend->pose.linear() - truth).norm(), 0.03);
  EXPECT_LT((part - truth).norm(), 0.01);
}

TEST(Deform, SlipsAreInOrderAlongThePath) {
  const Offset twice = [](double x) {
    return Eigen::Vector2d(0.0, x < 2.7 ? -0.3 : x > 5.3 ? 0.3 : 0.0);
  };
  // The second is known before, the first is found.
  std::vector<PieceOffset> pieces;
  for (double x = 0.4; x < kLength; x += 0.8) {
    pieces.push_back({x, x > 5.3 ? Eigen::Vector2d(0.0, 0.3) : Eigen::Vector2d(0.0, 0.0)});
  }
  const auto bend = BentScene(twice).follow(pieces);
  ASSERT_TRUE(bend);
  ASSERT_EQ(bend->deformation.slips.size(), 2U);
  EXPECT_NEAR(bend->deformation.slips.front().along, 2.7, 0.3);
  EXPECT_NEAR(bend->deformation.slips.back().along, 5.3, 0.3);
}

TEST(Deform, StraightenedMapIsWhatTheStripWouldBe) {
  const BentScene bent(kDrift);
  const auto bend = bent.follow();
  ASSERT_TRUE(bend);
  const map::GridMap straight = straightened(bent.scene.moving, *bend);
  const correlation::MapSignals fixed(bent.scene.fixed, {});
  const correlation::MapSignals before(bent.scene.moving, {}), after(straight, {});
  const refine::PairSignals was(fixed, before, {}, {}), is(fixed, after, {}, {});
  EXPECT_GT(is.score().significance(bend->pose), was.score().significance(bent.scene.pose));
}

TEST(Deform, DoesNotDependOnTheNumberOfThreads) {
  const BentScene bent(kDrift);
  const auto many = bent.follow();
  const ThreadLimit limit(1);
  const auto one = bent.follow();
  ASSERT_TRUE(many && one);
  EXPECT_EQ(many->deformation.coefficients, one->deformation.coefficients);
  EXPECT_EQ(many->pose.matrix(), one->pose.matrix());
}

TEST(Deformation, TurnsWhatLiesAsideOfABentPath) {
  const Path path({{0.0, 0.0}, {10.0, 0.0}});
  const SplineBasis basis(10.0, 1.0);
  Deformation deformation(path, Eigen::Matrix2d::Identity(), basis);
  for (int i = 0; i < basis.size(); ++i) deformation.coefficients(i, 1) = 0.01 * basis.place(i);
  const Eigen::Vector3d beside = deformation.at({4.0, 1.0});
  EXPECT_NEAR(beside.x(), -0.01, 1e-12);
  EXPECT_NEAR(beside.y(), 0.04, 1e-12);
}

TEST(BendThrough, GoesWhereThePathDoes) {
  const Path path({{0.0, 0.0}, {10.0, 0.0}});
  const Eigen::Affine2d pose(Eigen::Rotation2Dd(0.5) * Eigen::Scaling(1.1, 0.9));
  const auto laid = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return p + Eigen::Vector3d(0.0, 0.2 * std::sin(0.5 * p.x()), 0.05 * std::cos(0.4 * p.x()));
  };
  const Bend bend = bendThrough(path, pose, 1.25, 0.005, laid);
  for (double x = 0.0; x <= 10.0; x += 0.3) {
    const Eigen::Vector3d point(x, 0.0, 0.0);
    EXPECT_LT((unbent(point, bend.deformation, pose) - laid(point)).norm(), 0.001) << x;
  }
  EXPECT_NEAR(std::sqrt(bend.deformation.covarianceAt({5.0, 0.0})(0, 0)), 0.005, 0.003);
}

TEST(SlipRms, PartsPushedIntoOneAnotherCannotBeToldApartWhereTheyOverlap) {
  Deformation deformation(Path({{0.0, 0.0}, {10.0, 0.0}}), Eigen::Matrix2d::Identity(),
                          SplineBasis(10.0, 1.0));
  EXPECT_EQ(slipRms(deformation), 0.0);
  // What was driven on by 30 cm too little lies over what came before: half of 60 cm are wrong.
  deformation.slips = {{.along = 5.0, .offset = {0.3, 0.0}, .deviation = 0.0}};
  EXPECT_NEAR(slipRms(deformation), 0.3 * std::sqrt(0.3 / 10.0), 1e-9);
  EXPECT_NE(describe({.deformation = deformation}).find("over each other there for 0.30 m"),
            std::string::npos);
  // Pulled apart there is nothing between them that could be wrong.
  deformation.slips.front().offset = {-0.3, 0.0};
  EXPECT_EQ(slipRms(deformation), 0.0);
  deformation.slips.front().place_deviation = 0.06;
  EXPECT_GT(slipRms(deformation), 0.01);
}

TEST(FileDeformation, IsTheDeformationInTheFiles) {
  const Path path({{0.0, 0.0}, {4.0, 1.0}, {8.0, 0.5}});
  Deformation deformation(path, rotation2(0.2), SplineBasis(path.length(), 1.1));
  Random random(3);
  for (double& value : deformation.coefficients.reshaped()) value = random.normal(0.05);
  deformation.slips.push_back({.along = 5.0, .offset = {0.2, -0.1}});
  Eigen::Affine3d levelled_from_moving(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                                       Eigen::Translation3d(-400000.0, -5e6, -100.0));
  Eigen::Matrix3d fixed_from_displacement;
  fixed_from_displacement << 1.1, 0.1, 0.0, -0.1, 0.9, 0.02, 0.0, 0.03, 1.0;
  const FileDeformation function(deformation, levelled_from_moving, fixed_from_displacement);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d levelled(random.uniform(-3.0, 11.0), random.uniform(-3.0, 3.0), 0.1);
    const Eigen::Vector3d point = levelled_from_moving.inverse() * levelled;
    const Eigen::Vector2d place = (levelled_from_moving * point).head<2>();
    EXPECT_LT((function.at(point) - fixed_from_displacement * deformation.at(place)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace agricolmap::deform
