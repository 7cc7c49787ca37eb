// What QGIS is told; scripts/qgis-picture shows that it hears.
#include "agricolmap/report/gis/qgis_style.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "agricolmap/report/draw/ramp.hpp"

namespace agricolmap::report {
namespace {

bool has(const std::string& text, const char* part) { return text.find(part) != text.npos; }

/// As many tags are closed as are opened, and no text runs out of its quotes.
void expectWhole(const std::string& xml) {
  std::size_t opened = 0, closed = 0;
  for (std::size_t i = 0; i + 1 < xml.size(); ++i) {
    if (xml[i] == '<' && xml[i + 1] != '!') ++(xml[i + 1] == '/' ? closed : opened);
    if (xml[i] == '/' && xml[i + 1] == '>') ++closed;
  }
  EXPECT_EQ(opened, closed) << xml;
  EXPECT_EQ(std::ranges::count(xml, '"') % 2, 0) << xml;
}

TEST(QgisStyle, ARampHasItsStopsEvenlyAndWithTheirUnit) {
  const std::string style = qgisRamp({2, -0.1, 0.1, kFallToRise, "m"});
  expectWhole(style);
  EXPECT_TRUE(has(style, R"(type="singlebandpseudocolor" band="2")")) << style;
  EXPECT_TRUE(has(style, R"(<item value="-0.1" color="#8c510a" alpha="255" label="-0.1 m"/>)"));
  EXPECT_TRUE(has(style, R"(<item value="0" color="#f5f5f5" alpha="255" label="0 m"/>)")) << style;
  EXPECT_TRUE(has(style, R"(<item value="0.1" color="#01665e" alpha="255" label="0.1 m"/>)"));
}

TEST(QgisStyle, NamesOfFoldersCanHaveAnyLetter) {
  const std::string style = qgisCodes({{1, 0xb0bec5, "drone"}, {2, 0xe69f00, "a<b>&\"c\""}});
  expectWhole(style);
  EXPECT_TRUE(has(style, R"(value="2" color="#e69f00" alpha="255" label="a&lt;b&gt;&amp;&quot;c)"));
}

TEST(QgisStyle, AreasOfFactsHideNothing) {
  for (const char* name : {"rows", "plants", "gaps", "weeds", "uncountable", "grid", "plots"}) {
    const std::string style = qgisMarks(name);
    expectWhole(style);
    EXPECT_TRUE(has(style, "<renderer-v2 type=\"singleSymbol\">")) << name;
  }
  for (const char* name : {"grid", "plots"}) {
    EXPECT_TRUE(has(qgisMarks(name), R"(name="style" value="no")")) << name;
  }
  EXPECT_EQ(qgisMarks("other"), "");
}

TEST(QgisStyle, ChangesAreShadedWhereTheyAreMoreThanErrors) {
  const std::string style =
      qgisChange({"\"height_change_m\"", "\"more_than_errors\"", 0.06, 100.0, 0, "cm"});
  expectWhole(style);
  EXPECT_TRUE(has(style, "<renderer-v2 type=\"RuleRenderer\"")) << style;
  EXPECT_TRUE(has(style, "label=\"-6 to -4 cm\"")) << style;
  EXPECT_TRUE(has(style, "label=\"+4 to +6 cm\"")) << style;
  EXPECT_TRUE(has(style, "label=\"no more than errors\""));
  EXPECT_TRUE(has(style, "(&quot;height_change_m&quot;) &gt;= 0.04\"")) << style;  // and above
  const std::string covers = qgisChange({"\"cover_after\" - \"cover_before\""});
  expectWhole(covers);
  EXPECT_FALSE(has(covers, "no more than errors"));
}

}  // namespace
}  // namespace agricolmap::report
