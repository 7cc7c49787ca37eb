#include "agricolmap/core/point_stream.hpp"

#include <gtest/gtest.h>

namespace agricolmap {
namespace {

Cloud numbered(std::size_t count, bool coloured) {
  Cloud cloud;
  cloud.name = "numbered";
  for (std::size_t i = 0; i < count; ++i) {
    cloud.xyz.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    if (coloured) cloud.rgb.push_back({static_cast<std::uint8_t>(i), 0, 0});
  }
  return cloud;
}

TEST(CloudStream, HandsOutEveryPointOnceInWholeBatches) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{7}, PointStream::kBatch, 2 * PointStream::kBatch + 5}) {
    const Cloud cloud = numbered(count, count != 7);
    const CloudStream stream(cloud);
    EXPECT_EQ(stream.facts().points, count);
    std::size_t next = 0;
    stream.pass([&](const PointBatch& batch) {
      EXPECT_EQ(batch.first, next);
      EXPECT_EQ(batch.xyz.data(), cloud.xyz.data() + next);
      EXPECT_EQ(batch.rgb.size(), cloud.hasColour() ? batch.size() : 0U);
      next += batch.size();
      EXPECT_EQ(batch.size(), next < count ? PointStream::kBatch : batch.size());
    });
    EXPECT_EQ(next, count);
  }
}

}  // namespace
}  // namespace agricolmap
