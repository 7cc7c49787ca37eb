#include "agricolmap/io/cloud/tiled_stream.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "agricolmap/core/random.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

Cloud randomCloud(std::size_t points, bool coloured) {
  Random random(3);
  Cloud cloud;
  cloud.name = "random";
  cloud.origin = {500000, 5400000, 300};
  for (std::size_t i = 0; i < points; ++i) {
    cloud.xyz.emplace_back(random.uniform(-40, 60), random.uniform(-20, 30), random.uniform(-1, 1));
    if (coloured) cloud.rgb.push_back({static_cast<std::uint8_t>(random.below(256)), 7, 9});
  }
  return cloud;
}

struct Gathered {
  std::vector<Eigen::Vector3f> xyz;
  std::vector<Rgb> rgb;
  void add(const PointBatch& batch) {
    xyz.insert(xyz.end(), batch.xyz.begin(), batch.xyz.end());
    rgb.insert(rgb.end(), batch.rgb.begin(), batch.rgb.end());
  }
  bool operator==(const Gathered& other) const { return xyz == other.xyz && rgb == other.rgb; }
};

/// The points that `frame_from_local` brings into the window, of those that `pass` hands out.
template <typename Pass>
Gathered inside(const Eigen::Affine3d& frame_from_local, const Eigen::AlignedBox2d& window,
                const Pass& pass) {
  Gathered found;
  pass([&](const PointBatch& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Eigen::Vector3d p = frame_from_local * batch.xyz[i].cast<double>();
      if (!window.contains(p.head<2>())) continue;
      found.xyz.push_back(batch.xyz[i]);
      if (!batch.rgb.empty()) found.rgb.push_back(batch.rgb[i]);
    }
  });
  return found;
}

Eigen::Affine3d tilted() {
  return Eigen::Translation3d(3.0, -2.0, 40.0) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
}

TEST(TiledStream, HandsOutTheSameBatches) {
  for (const bool coloured : {true, false}) {
    const Cloud cloud = randomCloud(PointStream::kBatch + 12345, coloured);
    const CloudStream source(cloud);
    const TiledStream tiled(source);
    EXPECT_EQ(tiled.facts().points, cloud.size());
    EXPECT_EQ(tiled.facts().coloured, coloured);
    EXPECT_EQ(tiled.box().max, boundingBox(cloud).max);
    std::size_t next = 0;
    Gathered all;
    tiled.pass([&](const PointBatch& batch) {
      EXPECT_EQ(batch.first, next);
      EXPECT_EQ(batch.rgb.size(), coloured ? batch.size() : 0U);
      next += batch.size();
      all.add(batch);
    });
    EXPECT_TRUE(all == (Gathered{cloud.xyz, cloud.rgb}));
  }
}

TEST(TiledStream, HandsOutAPartInItsOrderAndLittleElse) {
  const Cloud cloud = randomCloud(PointStream::kBatch + 12345, true);
  const CloudStream source(cloud);
  const TiledStream tiled(source);
  const Eigen::Affine3d frame = tilted();
  const Eigen::AlignedBox2d window(Eigen::Vector2d(5.0, 1.0), Eigen::Vector2d(14.0, 6.0));
  std::size_t handed = 0;
  const Gathered part = inside(frame, window, [&](const auto& visit) {
    tiled.passNear(frame, window, [&](const PointBatch& batch) {
      handed += batch.size();
      visit(batch);
    });
  });
  const Gathered expected = inside(frame, window, [&](const auto& visit) { source.pass(visit); });
  ASSERT_FALSE(expected.xyz.empty());
  EXPECT_TRUE(part == expected);
  EXPECT_LT(handed, cloud.size() / 4);
}

TEST(TiledStream, HandsOutNothingBesideTheCloud) {
  const Cloud cloud = randomCloud(1000, true);
  const TiledStream tiled{CloudStream(cloud)};
  for (const double x : {-500.0, 500.0}) {
    const Eigen::AlignedBox2d window(Eigen::Vector2d(x, 0.0), Eigen::Vector2d(x + 5.0, 5.0));
    tiled.passNear(Eigen::Affine3d::Identity(), window,
                   [](const PointBatch&) { ADD_FAILURE() << "no point lies there"; });
  }
}

TEST(TiledStream, IsPassedBySeveralThreads) {
  const Cloud cloud = randomCloud(200'000, true);
  const TiledStream tiled{CloudStream(cloud)};
  const auto pass = [&](const auto& visit) { tiled.pass(visit); };
  const Eigen::AlignedBox2d window(Eigen::Vector2d(-40.0, -20.0), Eigen::Vector2d(60.0, 30.0));
  std::vector<Gathered> found(4);
  {
    std::vector<std::jthread> threads;
    for (Gathered& one : found) {
      threads.emplace_back([&] { one = inside(Eigen::Affine3d::Identity(), window, pass); });
    }
  }
  for (const Gathered& one : found) EXPECT_TRUE(one == (Gathered{cloud.xyz, cloud.rgb}));
}

TEST(TiledStream, SaysWhereItFindsNoRoom) {
  const Cloud cloud = randomCloud(10, false);
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("TMPDIR", "/nowhere/at/all", 1);
  test::expectError<OutputError>([&] { TiledStream{CloudStream(cloud)}; }, {"/nowhere/at/all"});
  before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
}

}  // namespace
}  // namespace agricolmap::io
