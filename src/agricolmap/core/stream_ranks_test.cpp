#include "agricolmap/core/stream_ranks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap {
namespace {

/// What sorting would give.
float atRank(const Cloud& cloud, Eigen::Index axis, std::size_t rank) {
  std::vector<float> values;
  for (const Eigen::Vector3f& point : cloud.xyz) values.push_back(point[axis]);
  return valueAtRank(values, rank);
}

void expectSorted(const Cloud& cloud, std::size_t tail) {
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const Box3 box = boxWithoutTails(CloudStream(cloud), tail);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(box.min[axis], atRank(cloud, axis, tail));
      EXPECT_EQ(box.max[axis], atRank(cloud, axis, cloud.size() - 1 - tail));
    }
  }
}

/// Below and above zero, many alike, tiny and huge, and in more batches than one.
TEST(StreamRanks, AreThoseOfSortedCoordinates) {
  Random random(11);
  Cloud cloud;
  for (std::size_t i = 0; i < PointStream::kBatch + 5000; ++i) {
    cloud.xyz.emplace_back(static_cast<float>(random.uniform(-30.0, 90.0)),
                           static_cast<float>(i % 7) - 3.0F,
                           std::ldexp(i % 2 == 0 ? 1.0F : -1.0F, static_cast<int>(i % 200) - 100));
  }
  for (const std::size_t tail : {std::size_t{0}, cloud.size() / 1000, cloud.size() / 2 - 1}) {
    expectSorted(cloud, tail);
  }
}

TEST(StreamRanks, FewPointsHaveRanksToo) {
  Cloud cloud;
  cloud.xyz = {{1.0F, -0.0F, -5.0F}};
  expectSorted(cloud, 0);
  cloud.xyz.emplace_back(0.0F, 0.0F, std::numeric_limits<float>::denorm_min());
  cloud.xyz.emplace_back(-1.0F, 3.0F, std::numeric_limits<float>::max());
  expectSorted(cloud, 0);
  expectSorted(cloud, 1);
  EXPECT_THROW(boxWithoutTails(CloudStream(cloud), 2), UsageError);
  EXPECT_THROW(boxWithoutTails(CloudStream(Cloud()), 0), UsageError);
}

}  // namespace
}  // namespace agricolmap
