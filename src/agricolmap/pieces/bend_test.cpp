#include "agricolmap/pieces/bend.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace agricolmap::pieces {
namespace {

const deform::Path kStraight({{0.0, 0.0}, {40.0, 0.0}});

TEST(Bend, PassesThroughItsNodesAndGoesStraightOnBeyond) {
  const Bend bend(kStraight,
                  {{4.0, {0.1, 0.0, 0.0}}, {20.0, {0.0, 0.4, 0.2}}, {36.0, {0.1, 0.8, 0.4}}});
  EXPECT_LT((bend.bent({20.0, 0.0, 1.0}) - Eigen::Vector3d(20.0, 0.4, 1.2)).norm(), 1e-12);
  EXPECT_LT((bend.bent({4.0, 0.0, 0.0}) - Eigen::Vector3d(4.1, 0.0, 0.0)).norm(), 1e-12);
  const Eigen::Vector3d end = bend.bent({40.0, 0.0, 0.0}), last = bend.bent({38.0, 0.0, 0.0});
  const Eigen::Vector3d node = bend.bent({36.0, 0.0, 0.0});
  EXPECT_LT((end - last - (last - node)).norm(), 1e-9);
}

TEST(Bend, IsSmoothAndWhatLiesBesideThePathTurnsWithIt) {
  std::vector<BendNode> nodes;
  for (double s = 0.0; s <= 40.0; s += 4.0) {
    nodes.push_back({s, {0.0, 0.5 * std::sin(0.1 * s), 0.0}});
  }
  const Bend bend(kStraight, nodes);
  for (double s = 6.0; s < 34.0; s += 0.7) {
    EXPECT_NEAR(bend.bent({s, 0.0, 0.0}).y(), 0.5 * std::sin(0.1 * s), 2e-3) << s;
    const Eigen::Vector3d middle = bend.bent({s, 0.0, 0.0}), left = bend.bent({s, 1.0, 0.0});
    EXPECT_NEAR((left - middle).norm(), 1.0, 1e-9);
    EXPECT_NEAR(left.x() - middle.x(), -0.05 * std::cos(0.1 * s), 2e-3) << s;
  }
  EXPECT_NEAR(bend.bentPath().length(), 40.0, 0.2);
}

TEST(Bend, MovesACloudInItsLevelledFrame) {
  Cloud cloud;
  cloud.origin = {100.0, 200.0, 0.0};
  cloud.xyz = {{0.0F, 10.0F, 1.0F}};
  // The levelled x axis is the file's y axis.
  Eigen::Affine3d levelled = Eigen::Affine3d::Identity();
  levelled.linear() << 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const Bend bend(kStraight, {{0.0, {0.0, 0.0, 0.0}}, {20.0, {0.0, 1.0, 0.0}}});
  const Cloud bent = bentCloud(cloud, levelled, bend);
  EXPECT_EQ(bent.origin, cloud.origin);
  EXPECT_LT((bent.xyz[0] - Eigen::Vector3f(-0.5F, 10.0F, 1.0F)).norm(), 1e-5F);
}

}  // namespace
}  // namespace agricolmap::pieces
