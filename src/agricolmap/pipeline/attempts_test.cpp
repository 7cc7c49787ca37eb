#include "agricolmap/pipeline/attempts.hpp"

#include <gtest/gtest.h>

namespace agricolmap::pipeline {
namespace {

constexpr double kRival = 0.8;

Outcome outcome(verdict::Status status, double significance, double rival = 0.0) {
  Outcome made;
  made.placed.emplace();
  made.verdict.status = status;
  made.verdict.plane_probability = status == verdict::Status::kAccepted ? 0.9 : 0.4;
  made.placed->evidence.significance = significance;
  if (rival > 0.0) made.rivals = {{.significance = rival}};
  return made;
}

TEST(Supersedes, AnAcceptedOutcomeReplacesARejectedOne) {
  EXPECT_TRUE(supersedes(outcome(verdict::Status::kAccepted, 9.0),
                         outcome(verdict::Status::kRejected, 10.0), kRival));
  EXPECT_FALSE(supersedes(outcome(verdict::Status::kRejected, 10.0),
                          outcome(verdict::Status::kAccepted, 9.0), kRival));
}

TEST(Supersedes, PlacesThatCouldNotBeToldApartAreNotForgotten) {
  const Outcome ambiguous = outcome(verdict::Status::kAmbiguous, 10.0, 9.5);
  // A later search that merely missed the other place.
  EXPECT_FALSE(supersedes(outcome(verdict::Status::kAccepted, 10.0), ambiguous, kRival));
  EXPECT_FALSE(supersedes(outcome(verdict::Status::kAccepted, 12.0), ambiguous, kRival));
  EXPECT_FALSE(supersedes(outcome(verdict::Status::kRejected, 20.0), ambiguous, kRival));
}

TEST(Supersedes, APlaceThatNoneOfThemRivalsReplacesThem) {
  const Outcome ambiguous = outcome(verdict::Status::kAmbiguous, 8.7, 7.3);
  EXPECT_TRUE(supersedes(outcome(verdict::Status::kAccepted, 17.4), ambiguous, kRival));
  // The straightened best may be less significant than a rival was.
  EXPECT_FALSE(supersedes(outcome(verdict::Status::kAccepted, 17.4),
                          outcome(verdict::Status::kAmbiguous, 8.7, 16.0), kRival));
}

}  // namespace
}  // namespace agricolmap::pipeline
