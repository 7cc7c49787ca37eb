// The parts of the correlation search, each against what it promises.
#include <gtest/gtest.h>

#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/correlation/map_signals.hpp"
#include "agricolmap/locate/block_search.hpp"
#include "agricolmap/locate/correlation_search.hpp"
#include "agricolmap/locate/polish.hpp"
#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::locate {
namespace {

using testing::TestScene;

constexpr int kFactor = 6;

class SearchPartsTest : public ::testing::Test {
 protected:
  SearchPartsTest() {
    space_.centre = scene_.middle;
    space_.uncertainty.translation = 2.0;
  }
  std::vector<map::Block> blocks() const {
    return map::cutBlocks(moving_.at(kFactor), strip_, 1.4);
  }
  /// The true place as a candidate.
  Candidate truth() const {
    Candidate candidate;
    candidate.hypothesis = {0.05, {1.04, 0.97}};
    candidate.shift = scene_.pose * scene_.middle - scene_.middle;
    return candidate;
  }
  double cell() const { return fixed_.at(kFactor).frame.cell; }

  const TestScene scene_ = testing::testScene({.size = 10.0}, {{0.6, -0.4}, 0.05, 1.04, 0.97});
  const correlation::MapSignals fixed_{scene_.fixed, {}};
  const correlation::MapSignals moving_{scene_.moving, {}};
  const map::StripFrame strip_ = map::stripFrame(moving_.at(kFactor));
  SearchSpace space_;
};

/// Hypotheses about one, near enough for a block to tolerate.
std::vector<Hypothesis> around(const Hypothesis& middle) {
  std::vector<Hypothesis> all;
  for (const double yaw : {-0.03, 0.0, 0.03}) {
    for (const double x : {0.97, 1.0, 1.03}) {
      for (const double y : {0.96, 1.0, 1.04}) {
        all.push_back({middle.yaw + yaw, {middle.scale.x() * x, middle.scale.y() * y}});
      }
    }
  }
  return all;
}

double bestScore(const std::vector<Candidate>& candidates) {
  double best = -1e9;
  for (const Candidate& candidate : candidates) best = std::max(best, candidate.score);
  return best;
}

TEST_F(SearchPartsTest, TheBoundOfTheBlocksLosesNothing) {
  const correlation::MatchedFilter& filter = fixed_.filter(kFactor, {}, 6);
  const Hypothesis coarse = truth().hypothesis;
  const std::vector<Hypothesis> fine = around(coarse);
  const auto searched = [&](int peaks, const std::vector<Hypothesis>& members) {
    return BlockSearch(moving_.at(kFactor), filter, space_, strip_, blocks(), peaks, 0.3)
        .run(coarse, members);
  };
  // Every place of the map looked at, against those that the bound promises most of.
  const double all = bestScore(searched(10000, fine));
  EXPECT_DOUBLE_EQ(bestScore(searched(8, fine)), all);
  // And no hypothesis alone reaches more than all of them together.
  for (const Hypothesis& one : fine) EXPECT_LE(bestScore(searched(10000, {one})), all + 1e-9);
}

TEST_F(SearchPartsTest, BlocksFindTheStrip) {
  const correlation::MatchedFilter& filter = fixed_.filter(kFactor, {}, 6);
  const BlockSearch search(moving_.at(kFactor), filter, space_, strip_, blocks(), 16, 0.3);
  const std::vector<Candidate> found = search.run(truth().hypothesis, around(truth().hypothesis));
  ASSERT_FALSE(found.empty());
  const auto best =
      std::max_element(found.begin(), found.end(),
                       [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
  EXPECT_LT((best->shift - truth().shift).norm(), 1.5 * cell());
}

TEST_F(SearchPartsTest, ClimbingReachesTheTopBesideIt) {
  const correlation::MatchedFilter& filter = fixed_.filter(kFactor, {});
  const Eigen::Matrix3d metric =
      displacementMetric(strip_.axes, strip_.half_extent, space_.scale_axes);
  const Polisher polisher(moving_.at(kFactor), filter, space_, metric, 0.3);
  Candidate start = truth();
  start.hypothesis.yaw += 0.02;
  start.hypothesis.scale.x() *= 0.98;
  start.shift += Eigen::Vector2d(0.8 * cell(), -0.6 * cell());
  const Candidate top = polisher.improve(start);
  EXPECT_GT(top.score, polisher.score(start));
  EXPECT_GE(top.score, polisher.score(truth()) * 0.98);
  EXPECT_LT(poseDistance(strip_.corners(), poseOf(top, space_), scene_.pose), 0.75 * cell());
  // A place beyond the map's edge has no score to climb.
  Candidate outside = truth();
  outside.shift += Eigen::Vector2d(50.0, 0.0);
  EXPECT_EQ(polisher.score(outside), -std::numeric_limits<double>::infinity());
}

TEST_F(SearchPartsTest, DistinctCandidatesAreTheBestOfTheirPlaces) {
  std::vector<Candidate> all;
  for (const auto& [x, score] : {std::pair{0.0, 5.0}, {0.1, 7.0}, {0.5, 6.0}, {2.0, 4.0}}) {
    Candidate candidate = truth();
    candidate.shift.x() += x;
    candidate.score = score;
    all.push_back(candidate);
  }
  const std::vector<Candidate> kept = distinctCandidates(all, 8, 0.3, strip_, space_);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].score, 7.0);
  EXPECT_EQ(kept[1].score, 6.0);
  EXPECT_EQ(kept[2].score, 4.0);
  EXPECT_EQ(distinctCandidates(all, 2, 0.3, strip_, space_).size(), 2U);
  // Corners tell them apart though the middle stays.
  Candidate turned = truth();
  turned.hypothesis.yaw += 0.3;
  EXPECT_EQ(distinctCandidates({truth(), turned}, 8, 0.3, strip_, space_).size(), 2U);
}

TEST_F(SearchPartsTest, WorkBeyondItsLimitIsSaid) {
  CorrelationOptions options;
  const SearchReport usual =
      searchByCorrelation(fixed_, moving_, rowWaves(fixed_, moving_), space_, options).report;
  EXPECT_FALSE(usual.too_much_work);
  options.max_work = 0.5 * usual.work;
  const SearchReport coarser =
      searchByCorrelation(fixed_, moving_, rowWaves(fixed_, moving_), space_, options).report;
  EXPECT_GT(coarser.cell, usual.cell);
  EXPECT_FALSE(coarser.too_much_work);
  options.max_work = 0.001 * usual.work;
  const SearchReport report =
      searchByCorrelation(fixed_, moving_, rowWaves(fixed_, moving_), space_, options).report;
  EXPECT_TRUE(report.too_much_work);
  EXPECT_GT(report.work, options.max_work);
}

TEST(Attempts, BecomeFinerAndThenFreer) {
  const CorrelationOptions options;
  const SearchReport restricted{.rows_on_rows = true};
  const auto first = optionsOfAttempt(options, 0, std::nullopt);
  const auto second = optionsOfAttempt(options, 1, restricted);
  const auto third = optionsOfAttempt(options, 2, restricted);
  ASSERT_TRUE(first && second && third);
  EXPECT_EQ(first->cell, options.cell);
  EXPECT_LT(second->cell, options.cell);
  EXPECT_GT(second->max_work, options.max_work);
  EXPECT_TRUE(second->rows_on_rows);
  EXPECT_FALSE(third->rows_on_rows);
  EXPECT_FALSE(optionsOfAttempt(options, kMostAttempts, restricted));
  // Where rows did not restrict the search, freeing it from them finds nothing new.
  EXPECT_FALSE(optionsOfAttempt(options, 2, SearchReport{.rows_on_rows = false}));
}

}  // namespace
}  // namespace agricolmap::locate
