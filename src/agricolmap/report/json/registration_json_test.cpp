#include "agricolmap/report/json/registration_json.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/report/test_registration.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

RegistrationReportInfo testInfo() {
  RegistrationReportInfo info;
  info.version = "1.2.3";
  info.seed = std::numeric_limits<std::uint64_t>::max();
  info.command_line = "agricolmap register uav.ply \xFF.ply";
  info.preset = "default";
  info.prior.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  info.prior_source = "offset.xyz of both clouds";
  info.options = {{"grid", {{"cell", 0.02}}}};
  info.threads = 2;
  info.pictures = {"flow.png"};
  return info;
}

Cloud testCloud(const std::string& name, bool coloured) {
  Cloud cloud;
  cloud.name = name;
  cloud.origin = {432000.1, 5200000.2, 400.3};
  cloud.xyz = {{0.0F, 0.0F, 0.0F}, {1.0F, 2.0F, 0.5F}};
  if (coloured) cloud.rgb = {{1, 2, 3}, {4, 5, 6}};
  cloud.dropped_points = 3;
  cloud.warnings = {name + ": 3 points were left out"};
  return cloud;
}

Json reportOf(const pipeline::Registration& registration) {
  Monitor monitor;
  for (const Stage stage : {Stage::kLevel, Stage::kGrid}) {
    monitor.run(stage, [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
  }
  const Cloud uav = testCloud("uav.ply", false);
  // As text and back, as every reader gets it.
  return Json::parse(registrationJson(CloudStream(uav), testCloud("\xFF.ply", true), registration,
                                      monitor, testInfo())
                         .dump(2));
}

TEST(RegistrationJson, AcceptedHasEverything) {
  pipeline::Registration registration = testing::testRegistration();
  registration.maps.frames.moving_footprint.left_out = 20;
  const Json json = reportOf(registration);
  EXPECT_EQ(json["status"], "accepted");
  EXPECT_EQ(json["reasons"].size(), 2U);
  EXPECT_EQ(json["warnings"],
            (Json{"uav.ply: 3 points were left out", "\xEF\xBF\xBD.ply: 3 points were left out"}));
  for (const char* key :
       {"yaw_deg", "tilt_x_deg", "tilt_y_deg", "scale_x", "scale_y", "scale_z", "shear"}) {
    EXPECT_TRUE(json["transform"]["parts"][key].is_number()) << key;
  }
  EXPECT_NEAR(json["transform"]["parts"]["yaw_deg"], degrees(0.06), 1e-9);
  EXPECT_EQ(json["transform"]["parts"]["shift_m"], (Json{0.9, -0.6, 0.12}));
  EXPECT_EQ(json["counts"]["inliers"], 200);
  EXPECT_EQ(json["counts"]["matches"], 400);
  EXPECT_EQ(json["counts"]["inlier_share"], 0.5);
  EXPECT_EQ(json["evidence"]["blocks"].size(), 5U);
  EXPECT_EQ(json["evidence"]["agreeing_blocks"], 4);
  EXPECT_NEAR(json["residuals"]["match_rms_m"], 0.02 * std::sqrt(2.0), 0.005);
  EXPECT_EQ(json["residuals"]["vertical"]["status"], "ok");
  EXPECT_EQ(json["residuals"]["vertical"]["residual_m"], 0.013);
  const Json& stages = json["times"]["stages"];
  EXPECT_EQ(stages.size(), 2U);
  EXPECT_GT(stages["level_s"], 0.001);
  // What the stages add up to, and next to nothing more.
  EXPECT_GE(json["times"]["total_s"],
            stages["level_s"].get<double>() + stages["grid_s"].get<double>());
  EXPECT_EQ(json["fixed"]["points"], 2);
  EXPECT_EQ(json["fixed"]["dropped_points"], 3);
  EXPECT_EQ(json["fixed"]["stray_points"], 0);
  EXPECT_EQ(json["moving"]["stray_points"], 20);
  EXPECT_EQ(json["fixed"]["has_colour"], false);
  EXPECT_EQ(json["moving"]["has_colour"], true);
  EXPECT_EQ(json["moving"]["box_max_m"][1], 5200002.2);
  EXPECT_EQ(json["seed"].get<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(json["options"]["grid"]["cell"], 0.02);
  EXPECT_GT(json["peak_memory_bytes"], 1 << 20);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["prior"]["matrix"][1][3], 0.2);
  EXPECT_EQ(json["moving"]["path"], "\xEF\xBF\xBD.ply");
}

TEST(RegistrationJson, SaysWhichPartsLieElsewhere) {
  pipeline::Registration registration = testing::testRegistration();
  EXPECT_TRUE(reportOf(registration)["evidence"]["parts"]["displaced"].empty());
  verdict::PartsReport& parts = registration.placed->evidence.parts;
  parts.displaced = {
      {.begin = 2.0, .end = 6.0, .offset = {0.1, -0.3}, .significance = 8.5, .uniqueness = 2.5}};
  parts.rms = 0.26;
  const Json json = reportOf(registration)["evidence"]["parts"];
  EXPECT_EQ(json["rms_m"], 0.26);
  EXPECT_EQ(json["along"], (Json{1.0, 0.0}));
  EXPECT_EQ(json["displaced"], Json({{{"begin_m", 2.0},
                                      {"end_m", 6.0},
                                      {"offset_m", {0.1, -0.3}},
                                      {"significance", 8.5},
                                      {"uniqueness", 2.5}}}));
}

TEST(RegistrationJson, SaysWhetherHeightsAreLimitedAndWhy) {
  pipeline::Registration registration = testing::testRegistration();
  registration.verdict.heights = {.status = verdict::HeightsStatus::kMeasured, .deviation = 0.014};
  Json heights = reportOf(registration)["heights"];
  EXPECT_EQ(heights["status"], "measured");
  EXPECT_TRUE(heights["limit"].is_null());
  EXPECT_EQ(heights["deviation_m"], 0.014);
  EXPECT_EQ(heights["vertical_scale"], "assumed");
  EXPECT_TRUE(heights["measured_scale"].is_null());
  registration.placed->heights.measured_scale = {.value = 0.93, .deviation = 0.01};
  heights = reportOf(registration)["heights"];
  EXPECT_EQ(heights["vertical_scale"], "measured");
  EXPECT_EQ(heights["measured_scale"], 0.93);
  EXPECT_EQ(heights["scale_deviation"], 0.01);
  registration.verdict.heights = {.limit = verdict::HeightsLimit::kFlat};
  heights = reportOf(registration)["heights"];
  EXPECT_EQ(heights["status"], "limited");
  EXPECT_EQ(heights["limit"], "flat");
  EXPECT_TRUE(heights["deviation_m"].is_null());
}

TEST(RegistrationJson, MatricesRoundTripToTheLastBit) {
  const pipeline::Registration registration = testing::testRegistration();
  const Json json = reportOf(registration);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      EXPECT_EQ(json["transform"]["matrix"][r][c].get<double>(),
                registration.transform->fixed_from_moving.matrix()(r, c));
      EXPECT_EQ(json["transform"]["local"]["matrix"][r][c].get<double>(),
                registration.transform->local_fixed_from_moving.matrix()(r, c));
    }
  }
}

TEST(RegistrationJson, RejectedWithoutAnswer) {
  pipeline::Registration registration;
  registration.verdict = verdict::rejectBecause("nothing coherent in common");
  const Json json = reportOf(registration);
  EXPECT_EQ(json["status"], "rejected");
  EXPECT_EQ(json["reasons"], Json{"nothing coherent in common"});
  EXPECT_TRUE(json["transform"].is_null());
  EXPECT_TRUE(json["residuals"].is_null());
  EXPECT_TRUE(json["evidence"]["blocks"].empty());
}

TEST(RegistrationJson, RejectedWithAnswerKeepsIt) {
  pipeline::Registration registration = testing::testRegistration();
  registration.verdict.status = verdict::Status::kRejected;
  const Json json = reportOf(registration);
  EXPECT_EQ(json["status"], "rejected");
  EXPECT_EQ(json["transform"]["matrix"].size(), 4U);
}

TEST(RegistrationJson, WhatIsNotFiniteIsNull) {
  pipeline::Registration registration = testing::testRegistration();
  registration.placed->correlation = std::numeric_limits<double>::quiet_NaN();
  registration.placed->evidence.uniqueness = std::numeric_limits<double>::infinity();
  registration.placed->evidence.blocks.clear();
  registration.placed->evidence.agreeing = 0;
  const Json json = reportOf(registration);
  EXPECT_TRUE(json["residuals"]["correlation"].is_null());
  EXPECT_TRUE(json["residuals"]["signal"].is_null());
  EXPECT_TRUE(json["residuals"]["block_rms_m"].is_null());
  EXPECT_TRUE(json["evidence"]["uniqueness"].is_null());
}

TEST(RegistrationJson, FailuresToWriteAreOutputErrors) {
  const pipeline::Registration registration = testing::testRegistration();
  const Cloud fixed = testCloud("a", true);
  EXPECT_THROW(writeRegistrationJson("/nonexistent/registration.json", CloudStream(fixed),
                                     testCloud("b", true), registration, Monitor(), testInfo()),
               OutputError);
}

TEST(RegistrationJson, PeakMemoryIsPlausible) {
  EXPECT_GT(peakMemoryBytes(), std::size_t{1} << 20);
  EXPECT_LT(peakMemoryBytes(), std::size_t{1} << 40);
}

}  // namespace
}  // namespace agricolmap::report
