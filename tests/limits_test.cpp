// Every option of a registration at both of its limits, on a pair so small that all of them take
// minutes: a result or a clear error, never a crash, never a number that is none.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "agricolmap/config/text.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap {
namespace {

using pipeline::Registration;
using pipeline::RegistrationOptions;

/// What one registration of so small a pair may hold at most [bytes]; more is a limit that no
/// machine meets. The sanitizers reserve far more than they use.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr rlim_t kMostMemory = rlim_t{4} << 30;
#else
constexpr rlim_t kMostMemory = RLIM_INFINITY;
#endif

const simulate::SimulatedPair& tinyPair() {
  static const simulate::SimulatedPair pair = [] {
    simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
    options.field.width = 8.0;
    options.field.height = 8.0;
    options.uav.gsd = 0.025;
    options.ugv.length = 4.0;
    options.ugv.width = 1.5;
    options.ugv.spacing = 0.012;
    options.seed = 5;
    return simulate::simulatePair(options);
  }();
  return pair;
}

Registration registerTiny(const RegistrationOptions& options) {
  const simulate::SimulatedPair& pair = tinyPair();
  Monitor monitor;
  return pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, options, monitor);
}

std::vector<std::string> allPaths() {
  RegistrationOptions options;
  std::vector<std::string> paths;
  const OptionTable table = optionTable(options);
  for (const OptionField& field : table.fields()) paths.push_back(field.path);
  return paths;
}

/// Its limits; of a choice all values.
std::vector<std::string> extremesOf(const OptionField& field) {
  if (const auto* choice = std::get_if<ChoiceRef>(&field.value)) return choice->names;
  if (std::holds_alternative<bool*>(field.value)) return {"false", "true"};
  return {fmt::format("{}", field.low), fmt::format("{}", field.high)};
}

constexpr std::array kPresets = {"default", "paper", "paper-literal"};

RegistrationOptions quickPreset(const char* name) {
  RegistrationOptions options = pipeline::preset(name);
  options.cpd.published.max_points = 400;  // all pairs of them are visited: minutes by default
  return options;
}

/// The preset under which the option at `path` has an effect.
RegistrationOptions presetFor(const std::string& path) {
  for (const char* name : kPresets) {
    const RegistrationOptions options = quickPreset(name);
    if (pipeline::missingFor(options, path).empty()) return options;
  }
  throw UsageError(path + " has an effect under no preset");
}

void expectSound(const Registration& result) {
  EXPECT_FALSE(result.verdict.reasons.empty());
  for (const double p : {result.verdict.plane_probability, result.verdict.place_probability}) {
    EXPECT_GE(p, 0.0);
    EXPECT_LE(p, 1.0);
  }
  ASSERT_EQ(result.transform.has_value(), result.placed.has_value());
  if (!result.transform) {
    EXPECT_EQ(result.verdict.status, verdict::Status::kRejected);
    return;
  }
  EXPECT_TRUE(result.transform->fixed_from_moving.matrix().allFinite());
  EXPECT_TRUE(std::isfinite(result.placed->evidence.significance));
  EXPECT_TRUE(std::isfinite(result.placed->evidence.uniqueness));
}

class LimitsTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const rlimit limit{kMostMemory, kMostMemory};
    if (kMostMemory == RLIM_INFINITY) return;
    ASSERT_EQ(::setrlimit(RLIMIT_AS, &limit), 0);
  }
};

TEST_P(LimitsTest, GivesAResultOrAClearError) {
  RegistrationOptions options = presetFor(GetParam());
  const OptionTable table = optionTable(options);
  const OptionField& field = *table.find(GetParam());
  const std::string usual = config::optionText(field);
  for (const std::string& value : extremesOf(field)) {
    SCOPED_TRACE(field.path + " = " + value);
    config::parseOption(field, value)();
    if (config::optionText(field) == usual) continue;  // tried by ThePairIsOneThatCanBeRegistered
    try {
      expectSound(registerTiny(options));
    } catch (const Error& error) {
      // Any other exception, running out of memory among them, fails the test.
      EXPECT_TRUE(error.kind() == ErrorKind::kUsage || error.kind() == ErrorKind::kInput);
      EXPECT_FALSE(std::string(error.what()).empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Options, LimitsTest, testing::ValuesIn(allPaths()),
                         [](const testing::TestParamInfo<std::string>& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST(Limits, ThePairIsOneThatCanBeRegistered) {
  for (const char* name : kPresets) {
    SCOPED_TRACE(name);
    const Registration result = registerTiny(quickPreset(name));
    EXPECT_TRUE(result.transform);
    expectSound(result);
  }
}

/// With every option at a limit that has no effect by missingFor().
TEST(Limits, WhatIsRefusedForDoingNothingDoesNothing) {
  for (const char* name : {"default", "paper"}) {
    const RegistrationOptions usual = pipeline::preset(name);
    const Registration before = registerTiny(usual);
    for (const bool high : {false, true}) {
      RegistrationOptions options = usual;
      const OptionTable table = optionTable(options);
      for (const OptionField& field : table.fields()) {
        const std::vector<std::string> extremes = extremesOf(field);
        if (pipeline::missingFor(usual, field.path).empty()) continue;
        config::parseOption(field, high ? extremes.back() : extremes.front())();
      }
      const Registration after = registerTiny(options);
      ASSERT_TRUE(before.transform && after.transform) << name;
      EXPECT_EQ(after.transform->fixed_from_moving.matrix(),
                before.transform->fixed_from_moving.matrix())
          << name;
      EXPECT_EQ(after.verdict.plane_probability, before.verdict.plane_probability) << name;
    }
  }
}

}  // namespace
}  // namespace agricolmap
