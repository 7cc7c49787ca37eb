// Features on maps: that they match what is the same, and the chains that rest on them.
#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/map/test_field.hpp"
#include "experiments/methods/features/feature_chain.hpp"
#include "experiments/methods/features/opencv_features.hpp"
#include "experiments/methods/features/surf_features.hpp"
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

class Extractors : public ::testing::TestWithParam<int> {
 protected:
  static std::unique_ptr<FeatureExtractor> make() {
    switch (GetParam()) {
      case 0:
        return makeSurf();
      case 1:
        return makeOrb();
      case 2:
        return makeFastBrief();
      default:
        return makeSift();
    }
  }
};

TEST_P(Extractors, MatchWhatIsTheSame) {
  const Views views = makeViews();
  const std::unique_ptr<FeatureExtractor> extractor = make();
  const Features fixed = extractor->extract(exgImage(views.fixed));
  const Features moving = extractor->extract(exgImage(views.moving));
  EXPECT_GT(moving.size(), 50U);
  const std::vector<Match> matches =
      matchFeatures(fixed, views.fixed.frame, moving, views.moving.frame, views.space, {});
  EXPECT_GT(matches.size(), 40U) << extractor->name();
  EXPECT_GT(rightShare(matches, views.shift), 0.4) << extractor->name();
}

TEST_P(Extractors, FindNothingInAPictureOfOneShade) {
  map::GridMap flat = makeViews().moving;
  for (float& value : flat.exg) value = 0.1F;
  EXPECT_EQ(make()->extract(exgImage(flat)).size(), 0U);
}

INSTANTIATE_TEST_SUITE_P(All, Extractors, ::testing::Range(0, 4));

TEST(Brief, IsBlindToBrightnessAndKnowsItsPlace) {
  Raster<std::uint8_t> picture(80, 80);
  Random random(4);
  for (std::uint8_t& value : picture) value = static_cast<std::uint8_t>(random.below(120));
  Raster<std::uint8_t> brighter = picture;
  for (std::uint8_t& value : brighter) value = static_cast<std::uint8_t>(value + 100);
  const Brief brief;
  const auto here = brief.describe(brief.smoothed(picture), 40, 40);
  EXPECT_EQ(here, brief.describe(brief.smoothed(brighter), 40, 40));
  EXPECT_NE(here, brief.describe(brief.smoothed(picture), 44, 40));
}

TEST(ExgImage, FillsHolesWithoutBorders) {
  Views views = makeViews();
  for (int r = 0; r < views.moving.frame.rows; ++r) {
    for (int c = 100; c < views.moving.frame.cols; ++c) views.moving.weight(r, c) = 0.0F;
  }
  const ExgImage image = exgImage(views.moving);
  EXPECT_EQ(image.known(50, 120), 0);
  for (int r = 1; r < image.grey.rows(); ++r) {
    EXPECT_LT(std::abs(image.grey(r, 130) - image.grey(r - 1, 130)), 60);
  }
}

TEST(FeatureChains, AreRightFromNearby) {
  testing::GuessError error;
  error.shift = {0.25, -0.2};
  PriorUncertainty prior;
  prior.translation = 1.0;
  prior.heading_deg = 3.0;
  prior.scale = 0.05;
  testing::expectRight(*makeMethod("surf"), error, prior);
  testing::expectRight(*makeMethod("orb"), error, prior);
  testing::expectRight(*makeMethod("fast-brief"), error, prior);
}

TEST(FeatureChains, FailOnEmptyMaps) {
  testing::expectFailsOnEmptyMaps(*makeMethod("surf"));
  testing::expectFailsOnEmptyMaps(*makeMethod("orb"));
  testing::expectFailsOnEmptyMaps(*makeMethod("fast-brief"));
}

}  // namespace
}  // namespace agricolmap::experiments
