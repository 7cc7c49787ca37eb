#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/test_support.hpp"
#include "experiments/pairs/pair_maker.hpp"
#include "experiments/pairs/suite.hpp"
#include "experiments/pairs/views.hpp"

namespace agricolmap::experiments {
namespace {

std::vector<Suite> allSuites() {
  std::vector<Suite> suites;
  for (const std::string& name : suiteNames()) {
    for (const Settings settings : settingsOf(name)) {
      suites.push_back(makeSuite(name, {.settings = settings}));
    }
  }
  return suites;
}

std::vector<Case> casesOf(const std::string& suite, Settings settings = Settings::kFinal) {
  return makeSuite(suite, {.settings = settings}).cases;
}

TEST(Suites, HaveDistinctNamesAndSoundOptions) {
  for (const Suite& suite : allSuites()) {
    std::set<std::string> names;
    for (const Case& one : suite.cases) {
      EXPECT_TRUE(names.insert(one.name).second) << one.name;
      EXPECT_FALSE(one.dataset.empty()) << one.name;
      for (const int seed : {20003, 20004, 20005}) {
        EXPECT_NO_THROW(checkOptions(one.optionsFor(seed))) << one.name;
      }
    }
  }
  EXPECT_EQ(casesOf("paper").size(), 15U);
  EXPECT_EQ(suiteNames().size(), 17U);
}

TEST(Suites, UnknownNamesListTheKnownOnes) {
  test::expectError<UsageError>([] { makeSuite("rotation", {}); }, {"'rotation'", "heading"});
  test::expectError<UsageError>([] { makeSuite("curves", {.settings = Settings::kDevelop}); },
                                {"'curves'", "'develop'", "it has: final"});
  test::expectError<UsageError>([] { parseSettings("late"); }, {"'late'", "develop, calibrate"});
}

TEST(Suites, EveryTargetIsOfACase) {
  std::set<std::string> names;
  for (const Suite& suite : allSuites()) {
    for (const Case& one : suite.cases) names.insert(one.name);
  }
  std::ifstream file(AGRICOLMAP_TARGETS);
  std::string line;
  std::getline(file, line);
  int targets = 0;
  for (; std::getline(file, line); ++targets) {
    EXPECT_TRUE(names.contains(line.substr(0, line.find(',')))) << line;
  }
  EXPECT_GT(targets, 100);
}

TEST(Cases, FirstCampaignKeepsItsSeedsAndDefaults) {
  for (const Case& one : casesOf("paper")) {
    EXPECT_EQ(one.optionsFor(20017).seed, 20017) << one.name;
    EXPECT_EQ(one.stripOf(20017), 0) << one.name;
    EXPECT_EQ(one.told.translation, PriorUncertainty{}.translation) << one.name;
  }
}

TEST(Settings, OfLocatingAreDisjoint) {
  std::set<std::string> fields[3];
  const Settings settings[] = {Settings::kFinal, Settings::kCalibrate, Settings::kDevelop};
  for (int i = 0; i < 3; ++i) {
    for (const Case& one : casesOf("locate", settings[i])) {
      const simulate::SimulationOptions drawn = one.optionsFor(40);
      fields[i].insert(
          fmt::format("{} {:.4f}", static_cast<int>(one.options.crop), drawn.field.row_spacing));
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (const std::string& one : fields[i]) EXPECT_FALSE(fields[(i + 1) % 3].contains(one)) << one;
  }
}

TEST(Settings, OfDrawnViewsAreDisjoint) {
  for (const PairSource source : {PairSource::kSimulated, PairSource::kBeetMosaic}) {
    const auto develop = viewRanges(Settings::kDevelop, source);
    const auto final = viewRanges(Settings::kFinal, source);
    ASSERT_EQ(develop.size(), final.size());
    for (std::size_t i = 0; i < develop.size(); ++i) {
      ASSERT_EQ(develop[i].path, final[i].path);
      for (const double value : develop[i].values) {
        EXPECT_THAT(final[i].values, ::testing::Not(::testing::Contains(value))) << final[i].path;
      }
    }
  }
}

/// All values that an option may take in any case of a crop.
std::set<std::string> valuesOf(const std::string& suite, Settings settings) {
  std::set<std::string> values;
  for (const Case& one : casesOf(suite, settings)) {
    for (const OptionRange& range : one.ranges) {
      EXPECT_FALSE(range.values.empty()) << range.path;
      for (const double value : range.values) {
        values.insert(fmt::format("{} {} {}", one.dataset, range.path, value));
      }
    }
  }
  return values;
}

TEST(Settings, OfHeightsAreDisjoint) {
  const std::set<std::string> develop = valuesOf("heights", Settings::kDevelop);
  const std::set<std::string> calibrate = valuesOf("heights", Settings::kCalibrate);
  for (const std::string& one : develop) EXPECT_FALSE(calibrate.contains(one)) << one;
  for (const std::string& one : valuesOf("heights", Settings::kFinal)) {
    EXPECT_FALSE(develop.contains(one)) << one;
    EXPECT_FALSE(calibrate.contains(one)) << one;
  }
}

TEST(Settings, OfElsewhereAreDisjoint) {
  const auto ofElsewhere = [](Settings settings) {
    std::set<std::string> values = valuesOf("elsewhere-sim", settings);
    for (const Case& one : casesOf("elsewhere-sim", settings)) {
      values.insert(fmt::format("{} rows {}", one.dataset, one.options.field.row_spacing));
    }
    return values;
  };
  const std::set<std::string> develop = ofElsewhere(Settings::kDevelop);
  const std::set<std::string> calibrate = ofElsewhere(Settings::kCalibrate);
  for (const std::string& one : develop) EXPECT_FALSE(calibrate.contains(one)) << one;
  for (const std::string& one : ofElsewhere(Settings::kFinal)) {
    EXPECT_FALSE(develop.contains(one)) << one;
    EXPECT_FALSE(calibrate.contains(one)) << one;
  }
}

TEST(Settings, OfLongStripsAndTerrainAreDisjoint) {
  for (const char* suite : {"long", "terrain"}) {
    std::set<std::string> values[3];
    const Settings settings[] = {Settings::kFinal, Settings::kCalibrate, Settings::kDevelop};
    for (std::size_t i = 0; i < 3; ++i) {
      for (const Case& one : casesOf(suite, settings[i])) {
        values[i].insert(fmt::format("{} rows {}", one.dataset, one.options.field.row_spacing));
        if (one.options.ugv.length > 15.0)
          values[i].insert(fmt::format("{}", one.options.ugv.drift));
        for (const OptionRange& range : one.ranges) {
          for (const double value : range.values) {
            values[i].insert(fmt::format("{} {}", range.path, value));
          }
        }
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (const std::string& one : values[i]) {
        EXPECT_FALSE(values[(i + 1) % 3].contains(one)) << suite << " " << one;
      }
    }
  }
}

TEST(Cases, LongStripsFitIntoTheirFieldsAtAnyHeading) {
  for (const Case& one : casesOf("long")) {
    const double length = one.options.ugv.length;
    const double width =
        one.options.ugv.width + (one.options.ugv.back ? one.options.ugv.back_aside : 0.0);
    const double widest = std::max(length, (length + width) / std::sqrt(2.0));
    EXPECT_LT(widest + 0.6 + width, one.options.field.width) << one.name;
  }
}

TEST(Cases, ElsewhereHasWrongPlacesForEveryGuess) {
  std::set<std::string> wrong;
  for (const Case& one : casesOf("elsewhere-sim", Settings::kCalibrate)) {
    if (!one.options.other_field && !one.options.mirrored) continue;
    wrong.insert(fmt::format("{} {:.2f} {}", one.options.mirrored, one.told.translation,
                             one.told.scale_unknown));
  }
  EXPECT_EQ(wrong.size(), 8U);  // of another field or mirrored; usual, tight, no guess, no unit
}

TEST(Cases, StripsOfAFieldShareTheDronesView) {
  std::vector<Case> cases = casesOf("locate", Settings::kCalibrate);
  for (Case& one : casesOf("elsewhere-sim")) cases.push_back(std::move(one));
  for (const Case& one : cases) {
    ASSERT_GT(one.strips_per_field, 1);
    const int first = 10 * one.strips_per_field;
    EXPECT_EQ(one.flightText(first), one.flightText(first + 1)) << one.name;
    EXPECT_NE(one.flightText(first), one.flightText(first - 1)) << one.name;
    EXPECT_EQ(one.stripOf(first), 0);
    EXPECT_EQ(one.stripOf(first + 1), 1);
  }
}

TEST(PairMaker, KeepsTheViewAndDoesNotDependOnTheOrder) {
  Case one;
  one.name = "small";
  one.options = simulate::cropPreset(simulate::Crop::kSugarBeet20m);
  one.options.field.width = one.options.field.height = 6.0;
  one.options.ugv.length = 4.0;
  one.options.ugv.width = 1.2;
  one.strips_per_field = 2;
  Case mirrored = one;
  mirrored.options.mirrored = true;
  PairMaker maker("nowhere");
  const Pair first = maker.make(one, 8);
  const Pair second = maker.make(one, 9);
  const Pair wrong = maker.make(mirrored, 9);
  EXPECT_EQ(first.fixed.get(), second.fixed.get());
  EXPECT_EQ(first.fixed.get(), wrong.fixed.get());
  EXPECT_NE(first.moving.xyz, second.moving.xyz);
  EXPECT_TRUE(second.overlaps);
  EXPECT_FALSE(wrong.overlaps);
  PairMaker other("nowhere");
  const Pair again = other.make(one, 9);
  EXPECT_EQ(again.moving.xyz, second.moving.xyz);
  EXPECT_EQ(again.fixed->xyz, second.fixed->xyz);
  EXPECT_NE(maker.make(one, 10).fixed->xyz, second.fixed->xyz);
}

/// Needs the shared data; the mosaic's place and heights must survive cutting and shifting.
TEST(Cases, SoybeanTruthLiesOnTheImportedCloud) {
  PairMaker maker(AGRICOLMAP_SHARED_DIR);
  const std::string missing =
      maker.unavailable({.name = {}, .dataset = {}, .source = PairSource::kSoybean});
  if (!missing.empty()) GTEST_SKIP() << missing;
  for (const Case& one : casesOf("paper")) {
    if (one.source != PairSource::kSoybean) continue;
    const Pair pair = maker.make(one, 3);
    const evaluate::RegistrationErrors errors =
        evaluate::evaluateTransform(pair.truth.best_affine, pair.truth, pair.moving);
    EXPECT_LT(errors.rms, 0.03);
    Box3 box = boundingBox(*pair.fixed);
    std::size_t inside = 0;
    for (const Eigen::Vector3d& point : pair.truth.points) {
      const Eigen::Vector3f local = (point - pair.fixed->origin).cast<float>();
      inside += ((local - box.min).minCoeff() > -0.1F && (box.max - local).minCoeff() > -0.1F);
    }
    EXPECT_GT(static_cast<double>(inside), 0.98 * static_cast<double>(pair.truth.points.size()));
  }
}

/// The outline of the beets must hold strips everywhere it says.
TEST(Cases, AllOfTheBeetMosaicHasRoomForStrips) {
  PairMaker maker(AGRICOLMAP_SHARED_DIR);
  const std::string missing =
      maker.unavailable({.name = {}, .dataset = {}, .source = PairSource::kBeetWhole});
  if (!missing.empty()) GTEST_SKIP() << missing;
  for (const Case& one : casesOf("locate")) {
    if (one.source != PairSource::kBeetWhole) continue;
    const Pair pair = maker.make(one, 2);
    const double area = static_cast<double>(pair.fixed->size()) * std::pow(one.options.uav.gsd, 2);
    EXPECT_GT(area, 300.0);
    const evaluate::RegistrationErrors errors =
        evaluate::evaluateTransform(pair.truth.best_affine, pair.truth, pair.moving);
    EXPECT_LT(errors.rms, 0.05);
  }
}

}  // namespace
}  // namespace agricolmap::experiments
