#include "agricolmap/verdict/remedies.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace agricolmap::verdict {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A strip of 6 x 2 m whose peak is hardly higher than the next.
Finding unsureFinding() {
  Finding finding;
  finding.overlap = 1.0;
  finding.evidence.significance = 9.0;
  finding.evidence.uniqueness = 1.5;
  finding.evidence.decoys = {5.0};
  finding.evidence.blocks.resize(12);
  finding.evidence.agreeing = 6;
  finding.evidence.strip.half_extent = {3.0, 1.0};
  return finding;
}

std::vector<std::string> adviceFor(const Finding& finding, const SearchSpace& space = {}) {
  Verdict verdict;
  verdict.place_probability = 0.4;
  return remediesFor(verdict, finding, space, {});
}

TEST(Remedies, AcceptedNeedsNone) {
  Verdict verdict;
  verdict.status = Status::kAccepted;
  EXPECT_THAT(remediesFor(verdict, unsureFinding(), {}, {}), IsEmpty());
}

TEST(Remedies, HowMuchFurtherToDriveFollowsFromThePeak) {
  // (1.8 / 1.5)^2 = 1.44 times 6 m.
  EXPECT_THAT(adviceFor(unsureFinding()), Contains(HasSubstr("drive about 3 m further")));
}

TEST(Remedies, APeakThatMayBeChancePromisesNoLength) {
  Finding finding = unsureFinding();
  finding.evidence.uniqueness = 1.0;
  EXPECT_THAT(adviceFor(finding), AllOf(Each(Not(HasSubstr("further"))),
                                        Contains(HasSubstr("a larger strip than 6.0 x 2.0 m"))));
}

TEST(Remedies, OneRowWantsASecondPass) {
  Finding finding = unsureFinding();
  finding.evidence.strip.half_extent = {5.0, 0.3};
  EXPECT_THAT(adviceFor(finding), Contains(HasSubstr("second pass")));
  EXPECT_THAT(adviceFor(unsureFinding()), Each(Not(HasSubstr("second pass"))));
}

TEST(Remedies, WhatTheGuessLeavesOpenIsNamed) {
  SearchSpace space;
  EXPECT_THAT(adviceFor(unsureFinding(), space), Contains(HasSubstr("better than 5 m")));
  space.uncertainty.translation = 0.5;
  EXPECT_THAT(adviceFor(unsureFinding(), space), Each(Not(HasSubstr("guess"))));
  space.uncertainty = PriorUncertainty::none();
  EXPECT_THAT(adviceFor(unsureFinding(), space), Contains(HasSubstr("about where the strip lies")));
}

TEST(Remedies, AnswersBeyondTheGuessNameTheLimit) {
  Finding finding = unsureFinding();
  finding.pose.linear() *= 1.9;
  EXPECT_THAT(adviceFor(finding), Contains(HasSubstr("units")));
  finding.pose.linear() = Eigen::Rotation2Dd(0.5).toRotationMatrix();
  EXPECT_THAT(adviceFor(finding), Contains(HasSubstr("error of heading")));
  finding.overlap = 0.1;
  EXPECT_THAT(adviceFor(finding), Contains(HasSubstr("shows the whole strip")));
}

TEST(Remedies, AGuessBesideTheMapIsToldBeforeAllElse) {
  Finding finding = unsureFinding();
  finding.guessed_overlap = 0.08;
  const auto advice = adviceFor(finding);
  EXPECT_THAT(advice.front(), HasSubstr("lays 8 % of the strip on it"));
  // A narrower one would only be more wrong.
  EXPECT_THAT(advice, Each(Not(HasSubstr("better than"))));
}

TEST(Remedies, AnAnswerAsFarOffAsAllowedAsksForMore) {
  Finding finding = unsureFinding();
  finding.pose.translation() = Eigen::Vector2d(4.9, 0.0);
  EXPECT_THAT(adviceFor(finding).front(), HasSubstr("wrong by more than 5 m, say so"));
  finding.pose = Eigen::Rotation2Dd(0.197);  // 11.3 degrees
  EXPECT_THAT(adviceFor(finding).front(), HasSubstr("wrong by more than 11.5 deg, say so"));
  finding.pose = Eigen::Rotation2Dd(0.1);
  EXPECT_THAT(adviceFor(finding), Each(Not(HasSubstr("wrong by more than"))));
  SearchSpace nowhere;
  nowhere.uncertainty = PriorUncertainty::none();
  finding.pose = Eigen::Rotation2Dd(3.1);
  EXPECT_THAT(adviceFor(finding, nowhere), Each(Not(HasSubstr("wrong by more than"))));
}

TEST(Remedies, WhatFitsNowhereMayBeOfElsewhere) {
  Verdict verdict;
  verdict.place_probability = 0.1;
  EXPECT_THAT(remediesFor(verdict, unsureFinding(), {}, {}),
              Contains(HasSubstr("of the same field")));
  EXPECT_THAT(adviceFor(unsureFinding()), Each(Not(HasSubstr("of the same field"))));
}

TEST(Remedies, PartsOfWhatCannotBeRightAreNoAdvice) {
  Finding finding = unsureFinding();
  finding.evidence.parts.rms = 0.3;
  EXPECT_THAT(adviceFor(finding), Contains(HasSubstr("in parts")));
  finding.pose.linear() = Eigen::Rotation2Dd(0.5).toRotationMatrix();
  EXPECT_THAT(adviceFor(finding), Each(Not(HasSubstr("in parts"))));
}

TEST(Remedies, ARightPlaceThatDoesNotFitNeedsOtherMaps) {
  Verdict verdict;
  verdict.place_probability = 0.97;
  EXPECT_THAT(remediesFor(verdict, unsureFinding(), {}, {}),
              AllOf(Contains(HasSubstr("nearer in time")), Each(Not(HasSubstr("further")))));
}

TEST(Remedies, NothingFoundNamesPlaceGuessAndScale) {
  EXPECT_THAT(remediesForNothing({}),
              AllOf(Contains(HasSubstr("same place")), Contains(HasSubstr("5 m")),
                    Contains(HasSubstr("unit"))));
}

}  // namespace
}  // namespace agricolmap::verdict
