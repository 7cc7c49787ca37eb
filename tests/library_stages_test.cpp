// The stages one by one, by the public headers and the shared libraries alone.
#include <gtest/gtest.h>

#include <agricolmap/error.hpp>
#include <agricolmap/io.hpp>
#include <agricolmap/stages.hpp>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <vector>

namespace agricolmap {
namespace {

const std::filesystem::path kFolder = std::filesystem::path(AGRICOLMAP_PAIRS) / "same_field";

TEST(Pair, IsRegisteredStageByStage) {
  const auto fixed = std::make_shared<const Cloud>(readCloud(kFolder / "uav/point_cloud.ply"));
  const auto moving = std::make_shared<const Cloud>(readCloud(kFolder / "ugv/point_cloud.ply"));
  const Transform guess = readMatrix(kFolder / "prior.txt");
  const Registration whole = registerClouds(*fixed, *moving, guess);
  ASSERT_TRUE(whole.accepted());

  const Pair pair(fixed, moving, guess);
  const std::vector<Place> places = pair.locate();
  ASSERT_GT(places.size(), 1U);
  EXPECT_GE(places[0].score, places[1].score);
  const Registration judged = pair.judge(places);
  ASSERT_TRUE(judged.accepted());
  const Eigen::Vector3d point = moving->filePoint(moving->size() / 2);
  const Eigen::Vector3d place = *whole.fixed_from_moving * point;
  EXPECT_LT((*judged.fixed_from_moving * point - place).norm(), 1e-4);
  EXPECT_NEAR(judged.evidence.significance, whole.evidence.significance, 0.05);
  const std::vector<Place> refined = pair.refine({{*whole.fixed_from_moving, 0.0}});
  ASSERT_EQ(refined.size(), 1U);
  EXPECT_LT((refined[0].fixed_from_moving * point - place).norm(), 0.02);
  EXPECT_EQ(pair.maps().fixed.height_m.size(), comparedMaps(whole).fixed.height_m.size());
  EXPECT_EQ(pair.judge({}).status, Registration::Status::kRejected);

  std::stop_source stop;
  stop.request_stop();
  Control stopped;
  stopped.stop = stop.get_token();
  EXPECT_THROW(pair.locate(stopped), Interrupted);
  EXPECT_THROW(Pair(fixed, nullptr, guess), UsageError);
  Options options;
  options.setPrior({.scale_unknown = true});
  EXPECT_THROW(Pair(fixed, moving, guess, options), UsageError);
}

}  // namespace
}  // namespace agricolmap
