#include <gtest/gtest.h>

#include <atomic>
#include <numbers>
#include <utility>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/options.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/core/xml_text.hpp"

namespace agricolmap {
namespace {

enum class Colour { kRed, kGreen };
struct InnerOptions {
  double size = 2.0;
};
struct OuterOptions {
  InnerOptions inner;
  int count = 3;
  bool on = false;
  Colour colour = Colour::kGreen;
};
void listOptions(OptionTable& table, InnerOptions& o) {
  table.number("size", o.size, 0.0, 10.0, "m", "how large");
}
void listOptions(OptionTable& table, OuterOptions& o) {
  table.group("inner", o.inner);
  table.integer("count", o.count, 1, 5, "", "how many");
  table.flag("on", o.on, "whether");
  table.choice("colour", o.colour, {"red", "green"}, "which");
}

template <typename Table>
concept HasFields = requires(Table&& table) {
  std::forward<Table>(table).fields();
};
// In `for (... : optionTable(options).fields())` they would be gone before the first round.
static_assert(HasFields<OptionTable&> && HasFields<const OptionTable&> && !HasFields<OptionTable>);

TEST(OptionTable, NamesNestedFields) {
  OuterOptions options;
  const OptionTable table = optionTable(options);
  ASSERT_NE(table.find("inner.size"), nullptr);
  *std::get<double*>(table.find("inner.size")->value) = 4.0;
  EXPECT_EQ(options.inner.size, 4.0);
  std::get<ChoiceRef>(table.find("colour")->value).set(0);
  EXPECT_EQ(options.colour, Colour::kRed);
}

TEST(OptionTable, RefusesValuesOutsideLimitsByName) {
  OuterOptions options;
  EXPECT_NO_THROW(checkOptions(options));
  options.inner.size = -1.0;
  try {
    checkOptions(options);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("inner.size"), std::string::npos);
  }
  options.inner.size = std::nan("");
  EXPECT_THROW(checkOptions(options), UsageError);
}

TEST(Transform, HorizontalPartsRoundTrip) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const HorizontalParts parts{random.uniform(-3.1, 3.1), random.uniform(0.5, 1.5),
                                random.uniform(0.5, 1.5), random.uniform(-0.3, 0.3)};
    const HorizontalParts back = splitHorizontal(composeHorizontal(parts));
    EXPECT_NEAR(back.yaw, parts.yaw, 1e-12);
    EXPECT_NEAR(back.scale_x, parts.scale_x, 1e-12);
    EXPECT_NEAR(back.scale_y, parts.scale_y, 1e-12);
    EXPECT_NEAR(back.shear, parts.shear, 1e-12);
  }
}

TEST(Angles, AreWrapped) {
  EXPECT_NEAR(wrapAngle(3.0 * std::numbers::pi), std::numbers::pi, 1e-12);
  EXPECT_NEAR(wrapAngle(-std::numbers::pi), std::numbers::pi, 1e-12);
  EXPECT_NEAR(wrapAngle(-0.1), -0.1, 1e-12);
}

TEST(Angles, ChangeUnits) {
  EXPECT_DOUBLE_EQ(radians(180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(degrees(-0.5 * std::numbers::pi), -90.0);
  EXPECT_DOUBLE_EQ(degrees(radians(11.5)), 11.5);
}

TEST(Parallel, SumIsTheSameOnAnyNumberOfThreads) {
  const auto sum = [] {
    return parallelSum<double>(100000, 1000, 0.0, [](std::size_t begin, std::size_t end) {
      double part = 0.0;
      for (std::size_t i = begin; i < end; ++i) part += std::sin(static_cast<double>(i)) * 1e-3;
      return part;
    });
  };
  double one = 0.0;
  {
    const ThreadLimit limit(1);
    one = sum();
  }
  EXPECT_EQ(one, sum());
}

TEST(Parallel, StopsWhenItsScopeIsStoppedAndNoOther) {
  std::stop_source stopped;
  stopped.request_stop();
  const std::stop_source other;
  const auto nested = [] {
    parallelFor(10, [](std::size_t) { parallelFor(10, [](std::size_t) {}); });
  };
  {
    const StopScope scope(stopped.get_token());
    EXPECT_THROW(nested(), Interrupted);
    const StopScope inner(other.get_token());
    EXPECT_NO_THROW(nested());
  }
  EXPECT_NO_THROW(nested());
  std::atomic<int> calls{0};
  parallelFor(10, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 10);
}

TEST(XmlText, EscapesWhatXmlCannotHold) {
  EXPECT_EQ(xmlText("a < b & \"c\" > d\x01\n"), "a &lt; b &amp; &quot;c&quot; &gt; d  ");
  EXPECT_EQ(xmlText("Rüben, 1 µm"), "Rüben, 1 µm");
}

TEST(Random, IsTheSameEverywhere) {
  Random random(42);
  EXPECT_EQ(random.bits(), 13679457532755275413ULL);
  EXPECT_EQ(mixBits(42 + Random::kStep), 13679457532755275413ULL);
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i) sum += random.normal();
  EXPECT_NEAR(sum / 10000, 0.0, 0.05);
}

}  // namespace
}  // namespace agricolmap
