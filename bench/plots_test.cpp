#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "campaign_cases.hpp"
#include "locating_page.hpp"
#include "svg_plot.hpp"

namespace agricolmap::campaign {
namespace {

/// Every tag is closed in order, attributes are quoted and nothing reserved stands in a text.
bool wellFormed(std::string_view xml) {
  std::vector<std::string> open;
  while (!xml.empty()) {
    const std::size_t begin = xml.find('<');
    for (std::string_view text = xml.substr(0, begin); !text.empty();) {
      const std::size_t mark = text.find('&');
      if (mark == std::string_view::npos) break;
      const std::size_t end = text.find(';', mark);
      if (end == std::string_view::npos || end - mark > 5) return false;
      text.remove_prefix(end);
    }
    if (begin == std::string_view::npos) break;
    const std::size_t end = xml.find('>', begin);
    if (end == std::string_view::npos) return false;
    const std::string_view tag = xml.substr(begin + 1, end - begin - 1);
    xml.remove_prefix(end + 1);
    if (tag.find('<') != std::string_view::npos) return false;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
    const std::string name(tag.substr(0, tag.find_first_of(" /", 1)));
    if (tag.starts_with('/')) {
      if (open.empty() || "/" + open.back() != name) return false;
      open.pop_back();
    } else if (!tag.ends_with('/')) {
      open.push_back(name);
    }
  }
  return open.empty();
}

PlotFigure smallFigure() {
  PlotFigure figure;
  figure.description = "a < b & \"c\"";
  figure.note = "simulated";
  figure.y = {"share [%]", 0.0, 100.0, {0.0, 50.0, 100.0}};
  PlotPanel panel;
  panel.title = "soybean";
  panel.x = {"drift [%]", 0.0, 3.0, {0.0, 0.01, 1.0, 3.0}};
  panel.lines = {
      {"right", PlotColour::kBlue, {{0.0, 100.0, 90.0, 100.0}, {3.0, 50.0, 30.0, 70.0}}}};
  figure.panels = {panel, panel};
  return figure;
}

TEST(SvgPlot, IsWellFormedAndHasAllParts) {
  const std::string svg = drawFigure(smallFigure());
  EXPECT_TRUE(wellFormed(svg)) << svg;
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(svg.find(">drift [%]<"), std::string::npos);
  EXPECT_NE(svg.find(">simulated<"), std::string::npos);
  EXPECT_NE(svg.find("class=\"band blue\""), std::string::npos);
  // One entry of the legend for both panels; no room for the label of 0.01.
  EXPECT_EQ(svg.find(">right<"), svg.rfind(">right<"));
  EXPECT_EQ(svg.find(">0.01<"), std::string::npos);
  EXPECT_NE(svg.find(">3<"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(SvgPlot, ChecksOfTheTestFindFaults) {
  EXPECT_FALSE(wellFormed("<svg><g></svg>"));
  EXPECT_FALSE(wellFormed("<svg><text>a & b</text></svg>"));
  EXPECT_FALSE(wellFormed("<svg><path d=\"M0 0/></svg>"));
}

PairRow row(const std::string& name, int seed, bool accepted, bool correct) {
  PairRow made;
  made.case_name = name;
  made.preset = "default";
  made.seed = seed;
  made.accepted = accepted;
  made.correct = correct;
  made.errors = noErrors();
  made.errors.rms = made.errors.rms_horizontal = correct ? 0.02 : 3.0;
  made.errors.rms_to_best_affine = 0.0042;
  made.total_s = 0.5;
  return made;
}

TEST(LocatingPage, HasTheNumbersOfTheRows) {
  std::vector<PairRow> rows;
  for (int seed = 0; seed < 4; ++seed) {
    rows.push_back(row("none-50m-soybean", seed, seed != 0, seed > 0));
    rows.push_back(row("neg-mirrored-soybean", seed, seed == 0, false));
    rows.back().negative = true;
    for (const char* value : {"0", "0.0025", "0.01"}) {
      rows.push_back(row(fmt::format("curve-soybean-drift={}", value), seed, seed < 3, seed < 2));
      rows.back().probability = 0.1 + 0.2 * seed;
      rows.back().mahalanobis2 = 2.0 * seed;
      rows.back().centre_mahalanobis2 = seed;
    }
  }
  rows.push_back(row("none-50m-soybean", 9, true, true));
  rows.back().preset = "other";
  const std::vector<PageFile> files = locatingPage(rows, {"20 rows of x"}, "default");
  const std::string& page = files.front().text;
  EXPECT_EQ(files.front().name, "locating.md");
  EXPECT_NE(page.find("| none-50m-soybean | 4 | 75.0 (30.1–95.4) | 75.0 (30.1–95.4) | 0 | 25.0 "
                      "(4.6–69.9) | 4.2 / 4.2 | 0.50 / 0.50 | success ≥ 98 %"),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("| neg-mirrored-soybean | 4 | – | – | 1 |"), std::string::npos) << page;
  EXPECT_NE(page.find("Of 4 pairs without a right answer, 1 were accepted"), std::string::npos);
  EXPECT_NE(page.find("4 pairs a point."), std::string::npos);
  std::set<std::string> names;
  for (const PageFile& file : files) {
    names.insert(file.name);
    if (!file.name.ends_with(".svg")) continue;
    EXPECT_TRUE(wellFormed(file.text)) << file.name;
    EXPECT_NE(file.text.find("simulated"), std::string::npos) << file.name;
    EXPECT_NE(page.find("(" + file.name + ")"), std::string::npos) << file.name;
  }
  EXPECT_EQ(names, (std::set<std::string>{"locating.md", "images/locating-drift.svg",
                                          "images/locating-reliability.svg",
                                          "images/locating-coverage.svg"}));
}

TEST(LocatingPage, KnowsTheNamesOfTheCurves) {
  const auto name = parseCurveName("curve-sugar-beet-10m-plant-size=1.4");
  ASSERT_TRUE(name.has_value());
  EXPECT_EQ(name->crop, "sugar-beet-10m");
  EXPECT_EQ(name->series, "plant-size");
  EXPECT_DOUBLE_EQ(name->value, 1.4);
  EXPECT_FALSE(parseCurveName("prior-hard-soybean").has_value());
  for (const CampaignCase& one : suiteCases("curves", false)) {
    EXPECT_TRUE(parseCurveName(one.name).has_value()) << one.name;
  }
}

TEST(ChiSquared, HasKnownQuantiles) {
  EXPECT_NEAR(chiSquaredBelow(4.60517, 2), 0.9, 1e-6);
  EXPECT_NEAR(chiSquaredBelow(9.23636, 5), 0.9, 1e-6);
  EXPECT_NEAR(chiSquaredBelow(4.35146, 5), 0.5, 1e-6);
}

}  // namespace
}  // namespace agricolmap::campaign
