#include "agricolmap/verdict/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "agricolmap/verdict/probability.hpp"

namespace agricolmap::verdict {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A registration that everything speaks for.
Finding clearFinding() {
  Finding finding;
  finding.overlap = 1.0;
  finding.evidence.significance = 24.0;
  finding.evidence.uniqueness = 4.5;
  finding.evidence.decoys = {4.6, 4.9};
  finding.evidence.blocks.resize(16);
  finding.evidence.agreeing = 15;
  PoseUncertainty uncertainty;
  uncertainty.expected_rms = 0.008;
  uncertainty.local_rms = 0.009;
  uncertainty.height_deviation = 0.012;
  finding.uncertainty = uncertainty;
  finding.rivals = {5.0, 4.0};
  return finding;
}

/// One that nothing does: a strip of another field.
Finding chanceFinding() {
  Finding finding = clearFinding();
  finding.evidence.significance = 4.5;
  finding.evidence.uniqueness = 1.0;
  finding.evidence.agreeing = 1;
  finding.uncertainty->expected_rms = 0.03;
  finding.uncertainty->local_rms = 0.06;
  finding.rivals = {4.4, 4.3, 4.1};
  return finding;
}

TEST(Verdict, AcceptsWhatEverythingSpeaksFor) {
  const Verdict verdict = judge(clearFinding(), {}, {});
  EXPECT_EQ(verdict.status, Status::kAccepted);
  EXPECT_GT(verdict.plane_probability, 0.95);
  EXPECT_GE(verdict.reasons.size(), 3U);
}

TEST(Verdict, SaysWhetherASlipOrItsBlocksMakeTheError) {
  Finding finding = clearFinding();
  finding.uncertainty->expected_rms = 0.09;
  const auto reasonsOf = [&] {
    std::string all;
    for (const std::string& reason : judge(finding, {}, {}).reasons) all += reason + "\n";
    return all;
  };
  EXPECT_THAT(reasonsOf(), HasSubstr("contradict one another"));
  finding.slip_rms = 0.085;
  EXPECT_THAT(reasonsOf(), HasSubstr("where the strip slipped"));
  EXPECT_THAT(reasonsOf(), ::testing::Not(HasSubstr("contradict one another")));
  // Of what is hardly a place at all an error means nothing.
  finding = chanceFinding();
  finding.uncertainty->expected_rms = 0.09;
  EXPECT_THAT(reasonsOf(), ::testing::Not(HasSubstr("must be expected")));
}

TEST(Verdict, ChanceIsRejectedThoughItsRivalsAreEqual) {
  const Verdict verdict = judge(chanceFinding(), {}, {});
  EXPECT_EQ(verdict.status, Status::kRejected);
  EXPECT_LT(verdict.plane_probability, 0.05);
  EXPECT_THAT(verdict.reasons.front(), HasSubstr("another place scores a"));
}

TEST(Verdict, AFileThatIsMirroredIsNamedFirst) {
  Finding mirrored = chanceFinding();
  mirrored.evidence.decoys = {27.0, 4.6};
  mirrored.overlap = 0.1;  // of the wrong place, which says nothing
  const Verdict verdict = judge(mirrored, {}, {});
  EXPECT_EQ(verdict.status, Status::kRejected);
  EXPECT_THAT(verdict.reasons.front(), HasSubstr("mirrored copy"));
  // What was not measured accuses nobody.
  mirrored.evidence.decoys.clear();
  EXPECT_THAT(judge(mirrored, {}, {}).reasons.front(), Not(HasSubstr("mirrored copy")));
}

TEST(Verdict, APlaceWithoutDecoysCountsAsIfTheyHadReachedWhatTheyHardlyEverDo) {
  Finding finding = clearFinding();
  const double measured = judge(finding, {}, {}).place_probability;
  finding.evidence.decoys.clear();
  EXPECT_LT(judge(finding, {}, {}).place_probability, measured);
  EXPECT_EQ(judge(finding, {}, {}).status, Status::kAccepted);
  finding.evidence.significance = 6.0;
  EXPECT_LT(finding.evidence.decoyRatio(), 1.0);
}

TEST(Verdict, EqualPlacesThatFitAreAmbiguous) {
  Finding finding = clearFinding();
  finding.evidence.uniqueness = 1.02;
  finding.rivals = {23.5, 22.0, 5.0};
  const Verdict verdict = judge(finding, {}, {});
  EXPECT_EQ(verdict.status, Status::kAmbiguous);
  EXPECT_LE(verdict.plane_probability, 1.0 / 3.0);
  EXPECT_THAT(verdict.reasons.front(), HasSubstr("3 places"));
}

TEST(Verdict, ContradictionsOutweighAllEvidence) {
  Finding beside = clearFinding();
  beside.overlap = 0.1;
  EXPECT_EQ(judge(beside, {}, {}).status, Status::kRejected);
  Finding stretched = clearFinding();
  stretched.pose.linear() << 1.7, 0.0, 0.0, 1.0;
  EXPECT_EQ(judge(stretched, {}, {}).plane_probability, 0.0);
  Finding turned = clearFinding();
  turned.pose.linear() = Eigen::Rotation2Dd(0.5).toRotationMatrix();
  EXPECT_THAT(judge(turned, {}, {}).reasons.front(), HasSubstr("heading"));
}

TEST(Verdict, APartThatLiesElsewhereIsNamedAndNotAccepted) {
  Finding finding = clearFinding();
  PartsReport& parts = finding.evidence.parts;
  parts.length = 10.0;
  parts.displaced = {{.begin = 6.0, .end = 10.0, .offset = {0.0, 0.31}}};
  parts.rms = 0.196;
  parts.probability = 0.001;
  const Verdict slipped = judge(finding, {}, {});
  EXPECT_EQ(slipped.status, Status::kRejected);
  EXPECT_THAT(slipped.reasons.front(),
              HasSubstr("the 4.0 m at the strip's eastern end lie 0.31 m further north"));
  EXPECT_LT(slipped.plane_probability, 0.01);
}

TEST(Verdict, APartThatLeavesTheWholeWithinItsLimitIsOnlyNamed) {
  Finding finding = clearFinding();
  PartsReport& parts = finding.evidence.parts;
  parts.length = 10.0;
  parts.displaced = {{.begin = 9.0, .end = 10.0, .offset = {0.0, 0.09}}};
  parts.rms = 0.028;
  parts.probability = 0.001;
  const Verdict verdict = judge(finding, {}, {});
  EXPECT_EQ(verdict.status, Status::kAccepted);
  EXPECT_EQ(verdict.plane_probability, judge(clearFinding(), {}, {}).plane_probability);
  EXPECT_THAT(verdict.reasons, ::testing::Contains(HasSubstr("0.09 m further north")));
}

TEST(Verdict, LimitedHeightsAreSaidFirstAndRefuseOnlyWhereTheyAreRequired) {
  Finding finding = clearFinding();
  finding.heights = {.status = HeightsStatus::kMeasured, .deviation = 0.012};
  const Verdict measured = judge(finding, {}, {});
  EXPECT_EQ(headline(measured), "accepted");
  finding.heights = {.limit = HeightsLimit::kNoGround, .deviation = 0.08, .bias = 0.07};
  finding.uncertainty->height_deviation = 0.08;
  Verdict limited = judge(finding, {}, {});
  EXPECT_EQ(limited.status, Status::kAccepted);
  EXPECT_EQ(limited.plane_probability, measured.plane_probability);
  EXPECT_EQ(headline(limited),
            "accepted in the plane, heights limited: no ground is seen under the plants, heights "
            "may be off by 8 "
            "cm");
  requireHeights(limited);
  EXPECT_EQ(limited.status, Status::kRejected);
  EXPECT_EQ(headline(limited), "rejected");
  EXPECT_THAT(limited.reasons.front(), HasSubstr("heights are required"));
  Verdict kept = measured;
  requireHeights(kept);
  EXPECT_EQ(kept.status, Status::kAccepted);
}

TEST(Verdict, WithoutAnUncertaintyThereIsLessToTrust) {
  Finding finding = clearFinding();
  const double known = judge(finding, {}, {}).plane_probability;
  finding.uncertainty.reset();
  EXPECT_LT(judge(finding, {}, {}).plane_probability, known);
}

TEST(Probability, StaysWithinItsBoundsForAnything) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, -1.0, 1e300, infinite, nan}) {
    const VerdictFacts facts{value, value, value, value, value, value, value, value};
    const double probability = planeProbability(facts);
    EXPECT_GE(probability, 0.0) << value;
    EXPECT_LE(probability, 1.0) << value;
  }
}

TEST(Probability, GrowsWithUniquenessAndAgreement) {
  VerdictFacts facts = factsOf(clearFinding());
  const double whole = planeProbability(facts);
  facts.uniqueness = 1.2;
  EXPECT_LT(planeProbability(facts), whole);
  facts = factsOf(clearFinding());
  facts.agreeing = 3.0;
  EXPECT_LT(planeProbability(facts), whole);
}

}  // namespace
}  // namespace agricolmap::verdict
