// Features on maps: that they match what is the same, and the chains that rest on them.
#include "experiments/methods/features/features.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "agricolmap/core/random.hpp"
#include "agricolmap/map/test_field.hpp"
#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

using agricolmap::testing::growField;
using agricolmap::testing::TestField;
using agricolmap::testing::viewOf;

/// Two views of one field: the moving one a strip, laid `shift` off.
struct Views {
  map::GridMap fixed;
  map::GridMap moving;
  Eigen::Vector2d shift{0.42, -0.26};
  SearchSpace space;
};

Views makeViews() {
  TestField field;
  field.size = 8.0;
  const auto truth = growField(field);
  Views views;
  views.fixed = viewOf(truth, field, map::Box2(Eigen::Vector2d(0, 0), Eigen::Vector2d(8, 8)),
                       Eigen::Affine2d::Identity(), 0.01, 1);
  Eigen::Affine2d field_from_moving = Eigen::Affine2d::Identity();
  field_from_moving.translation() = views.shift;
  views.moving = viewOf(truth, field, map::Box2(Eigen::Vector2d(2, 2), Eigen::Vector2d(6, 4)),
                        field_from_moving, 0.01, 2);
  views.space.centre = {4.0, 3.0};
  views.space.uncertainty = {.translation = 1.0, .heading_deg = 2.0, .scale = 0.05};
  return views;
}

double rightShare(const std::vector<Match>& matches, const Eigen::Vector2d& shift) {
  double right = 0.0;
  for (const Match& match : matches) {
    if ((match.fixed - match.moving - shift).norm() < 0.06) right += 1.0;
  }
  return matches.empty() ? 0.0 : right / static_cast<double>(matches.size());
}

class Extractors : public ::testing::TestWithParam<Extract> {};

TEST_P(Extractors, MatchWhatIsTheSame) {
  const Views views = makeViews();
  const Features fixed = GetParam()(exgImage(views.fixed));
  const Features moving = GetParam()(exgImage(views.moving));
  EXPECT_GT(moving.size(), 50U);
  const std::vector<Match> matches =
      matchFeatures(fixed, views.fixed.frame, moving, views.moving.frame, views.space, 1.0);
  EXPECT_GT(matches.size(), 40U);
  EXPECT_GT(rightShare(matches, views.shift), 0.4);
}

TEST_P(Extractors, FindNothingInAPictureOfOneShade) {
  map::GridMap flat = makeViews().moving;
  for (float& value : flat.exg) value = 0.1F;
  EXPECT_EQ(GetParam()(exgImage(flat)).size(), 0U);
}

INSTANTIATE_TEST_SUITE_P(All, Extractors,
                         ::testing::Values(surfFeatures, orbFeatures, fastBriefFeatures,
                                           siftFeatures));

TEST(Brief, IsBlindToBrightnessAndKnowsItsPlace) {
  cv::Mat picture(80, 80, CV_8U);
  Random random(4);
  for (int i = 0; i < 80 * 80; ++i) {
    picture.data[i] = static_cast<std::uint8_t>(random.below(120));
  }
  const cv::Mat brighter = picture + 100;
  const Eigen::Vector2d here(40.0, 40.0);
  const cv::Mat bits = briefOf(picture, {here, Eigen::Vector2d(40.0, 44.0)});
  EXPECT_EQ(cv::norm(bits.row(0), briefOf(brighter, {here}), cv::NORM_HAMMING), 0.0);
  EXPECT_GT(cv::norm(bits.row(0), bits.row(1), cv::NORM_HAMMING), 0.0);
}

TEST(ExgImage, FillsHolesWithoutBorders) {
  Views views = makeViews();
  for (int r = 0; r < views.moving.frame.rows; ++r) {
    for (int c = 100; c < views.moving.frame.cols; ++c) views.moving.weight(r, c) = 0.0F;
  }
  const ExgImage image = exgImage(views.moving);
  EXPECT_EQ(image.known.at<std::uint8_t>(50, 120), 0);
  for (int r = 1; r < image.grey.rows; ++r) {
    EXPECT_LT(
        std::abs(image.grey.at<std::uint8_t>(r, 130) - image.grey.at<std::uint8_t>(r - 1, 130)),
        60);
  }
}

TEST(FeatureChains, AreRightFromNearby) {
  testing::GuessError error;
  error.shift = {0.25, -0.2};
  PriorUncertainty prior;
  prior.translation = 1.0;
  prior.heading_deg = 3.0;
  prior.scale = 0.05;
  testing::expectRight(makeMethod("surf"), error, prior);
  testing::expectRight(makeMethod("orb"), error, prior);
  testing::expectRight(makeMethod("fast-brief"), error, prior);
}

TEST(FeatureChains, FailOnEmptyMaps) {
  testing::expectFailsOnEmptyMaps(makeMethod("surf"));
  testing::expectFailsOnEmptyMaps(makeMethod("orb"));
  testing::expectFailsOnEmptyMaps(makeMethod("fast-brief"));
}

}  // namespace
}  // namespace agricolmap::experiments
