// TASKDATA.XML and its grid, as text and bytes; tests/isoxml reads them with another's library.
#include "agricolmap/prescribe/task_data.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "agricolmap/core/error.hpp"
#include "agricolmap/prescribe/test_earth.hpp"

namespace agricolmap::prescribe {
namespace {

/// Two rows of three squares; the north-west one is not known.
Plan smallPlan(const Earth& earth) {
  Lattice lattice;
  lattice.corner = {11.5, 48.0};
  lattice.axes << 0.00004, 0.0, 0.0, 0.000027;
  lattice.rows = 2;
  lattice.cols = 3;
  Raster<float> means(2, 3);
  for (int i = 0; i < 6; ++i) means[static_cast<std::size_t>(i)] = static_cast<float>(i);
  means(1, 0) = std::numeric_limits<float>::quiet_NaN();
  return planOf(lattice, means, {1.5}, {120.0, 80.5}, rateUnit("kg/ha"), earth);
}

TEST(TaskData, SaysWhereTheGridLiesAndWhatItsZonesGet) {
  const Earth earth = testEarth();
  const Plan plan = smallPlan(earth);
  const TaskNames names{"N <late> & \"hot\"", "urea", "Höhe", "1.0", {54, 73}};
  const TaskData data = taskDataOf(plan, taskGridOf(plan, earth), names, GridKind::kZones);
  EXPECT_EQ(data.cells, (std::vector<std::uint8_t>{1, 1, 2, 0, 2, 2}));  // south first
  for (const char* part :
       {R"(VersionMajor="3" VersionMinor="3")", R"(B="N &lt;late&gt; &amp; &quot;hot&quot;")",
        R"(<PDT A="PDT1" B="urea"/>)", R"(C="Höhe")",
        R"(<VPN A="VPN1" B="0" C="0.010000000" D="2" E="kg/ha"/>)",
        R"(<TZN A="1" B="1: 120 kg/ha" C="54">)", R"(<PDV A="0006" B="12000" C="PDT1" E="VPN1"/>)",
        R"(<PDV A="0006" B="8050" C="PDT1" E="VPN1"/>)",
        R"(<GRD A="48.000000000" B="11.500000000" C="0.000027000" D="0.000040000")",
        R"(E="3" F="2" G="GRD00001" H="6" I="1"/>)", R"(H="0" I="0" J="0")"}) {
    EXPECT_NE(data.xml.find(part), std::string::npos) << part << " is not in\n" << data.xml;
  }
}

TEST(TaskData, OfTypeTwoHasTheRatesThemselves) {
  const Earth earth = testEarth();
  const Plan plan = smallPlan(earth);
  const TaskData data =
      taskDataOf(plan, taskGridOf(plan, earth), {"t", "p", "f", "1", {}}, GridKind::kValues);
  ASSERT_EQ(data.cells.size(), 24U);
  const auto value = [&](std::size_t cell) {
    std::uint32_t sum = 0;
    for (std::size_t i = 4; i-- > 0;) sum = 256 * sum + data.cells[4 * cell + i];
    return sum;
  };
  EXPECT_EQ(value(0), 12000U);
  EXPECT_EQ(value(2), 8050U);
  EXPECT_EQ(value(3), 0U);
  EXPECT_NE(data.xml.find(R"(H="24" I="2" J="3")"), std::string::npos) << data.xml;
  EXPECT_NE(data.xml.find(R"(<TZN A="3" B="grid")"), std::string::npos);
}

TEST(TaskData, HasRoomForNamesOfThirtyTwoLetters) {
  const Earth earth = testEarth();
  const Plan plan = smallPlan(earth);
  TaskNames names{"t", "p", std::string(32, 'f'), "1", {}};
  for (int i = 0; i < 16; ++i) names.product += "ü";  // two bytes, one letter
  EXPECT_NO_THROW(taskDataOf(plan, taskGridOf(plan, earth), names, GridKind::kZones));
  names.field += 'f';
  EXPECT_THROW(taskDataOf(plan, taskGridOf(plan, earth), names, GridKind::kZones), UsageError);
}

TEST(TaskData, ColoursAreThoseOfThePalette) {
  EXPECT_EQ(paletteIndex(0x000000), 16);
  EXPECT_EQ(paletteIndex(0x0000ff), 21);
  EXPECT_EQ(paletteIndex(0xff0000), 196);
  EXPECT_EQ(paletteIndex(0xffffff), 231);
}

}  // namespace
}  // namespace agricolmap::prescribe
