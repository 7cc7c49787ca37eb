#include "agricolmap/report/page/facts_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/report/page/packed_layer.hpp"
#include "agricolmap/report/page/test_page.hpp"
#include "agricolmap/report/pictures/pictures.hpp"

namespace agricolmap::report {
namespace {

using io::FieldKind;
using io::GeometryKind;
using io::VectorLayer;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

std::vector<std::uint8_t> fromBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = (word << 6) | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>((word >> bits) & 255U));
  }
  return bytes;
}

/// As web/packed.js reads them; NaN where there is none.
std::vector<double> numbersOf(const Json& column) {
  const std::vector<std::uint8_t> bytes = fromBase64(column["data"]);
  const auto width = column["bytes"].get<std::size_t>();
  std::vector<double> values;
  for (std::size_t i = 0; i < bytes.size(); i += width) {
    std::uint64_t code = 0;
    for (std::size_t k = 0; k < width; ++k) code |= std::uint64_t{bytes[i + k]} << (8 * k);
    const bool none = code == (std::uint64_t{1} << (8 * width)) - 1;
    values.push_back(none ? std::nan("")
                          : column["low"].get<double>() +
                                column["step"].get<double>() * static_cast<double>(code));
  }
  return values;
}

/// `count` plants in rows of 100.
VectorLayer plantsOf(std::size_t count) {
  VectorLayer layer{"plants",
                    GeometryKind::kPoint,
                    {{"id", FieldKind::kInteger},
                     {"row", FieldKind::kInteger},
                     {"along_m", FieldKind::kReal, 3},
                     {"height_m", FieldKind::kReal, 3},
                     {"area_m2", FieldKind::kReal, 5},
                     {"certainty", FieldKind::kReal, 2}},
                    {}};
  for (std::size_t i = 0; i < count; ++i) {
    const double along = 0.2 * static_cast<double>(i % 100);
    const std::size_t row = i / 100;
    const double across = 0.5 * static_cast<double>(row);
    layer.features.push_back({{{352400.0 + along, 4815300.0 + across}},
                              {static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(row + 1),
                               along, i == 1 ? std::nan("") : 0.123, 0.00456, 0.9}});
  }
  return layer;
}

TEST(PackedLayer, HoldsNumbersToTheirDecimalsAndNothingAsNothing) {
  const Json packed = packedLayer(plantsOf(250), {352400.0, 4815300.0}, {1000, {}});
  EXPECT_EQ(packed["kind"], "point");
  EXPECT_EQ(packed["count"], 250);
  const std::vector<double> x = numbersOf(packed["shapes"]["x"]);
  const std::vector<double> height = numbersOf(packed["columns"]["height_m"]);
  const std::vector<double> id = numbersOf(packed["columns"]["id"]);
  EXPECT_NEAR(x[99], 19.8, 1e-9);
  EXPECT_NEAR(height[0], 0.123, 1e-9);
  EXPECT_TRUE(std::isnan(height[1]));
  EXPECT_EQ(id[249], 250.0);
  EXPECT_NEAR(numbersOf(packed["columns"]["area_m2"])[7], 0.00456, 1e-9);
}

TEST(PackedLayer, WhatSpansMoreThanTwoBytesIsCoarserButIdsAreNot) {
  VectorLayer layer = plantsOf(70'000);
  layer.features.back().points[0].x() += 200.0;
  const Json packed = packedLayer(layer, {352400.0, 4815300.0}, {100'000, {}});
  const Json& x = packed["shapes"]["x"];
  EXPECT_EQ(x["bytes"], 2);
  EXPECT_NEAR(numbersOf(x).back(), 19.8 + 200.0, 0.004);
  EXPECT_EQ(numbersOf(packed["columns"]["id"]).back(), 70'000.0);
}

TEST(PackedLayer, LinesLoseOnlyWhatBendsLessThanACentimetre) {
  VectorLayer rows{"rows", GeometryKind::kLine, {{"id", FieldKind::kInteger}}, {}};
  io::VectorFeature bent{{}, {std::int64_t{1}}};
  for (int i = 0; i <= 400; ++i) {
    const double x = 0.05 * i;
    bent.points.emplace_back(x, 0.001 * (i % 2) + (x > 10.0 ? 0.2 * (x - 10.0) : 0.0));
  }
  rows.features.push_back(bent);
  const Json packed = packedLayer(rows, {0.0, 0.0}, {10, {}});
  const std::vector<double> x = numbersOf(packed["shapes"]["x"]);
  EXPECT_EQ(numbersOf(packed["shapes"]["points"]), std::vector<double>{3.0});
  ASSERT_EQ(x.size(), 3U);
  EXPECT_NEAR(x[1], 10.0, 0.1);
  EXPECT_NEAR(x[2], 20.0, 1e-9);
}

TEST(PackedLayer, OfTooManyTheLargestAreKeptInTheirOrder) {
  VectorLayer gaps{"gaps",
                   GeometryKind::kPoint,
                   {{"id", FieldKind::kInteger}, {"length_m", FieldKind::kReal, 3}},
                   {}};
  for (int i = 0; i < 5; ++i) {
    gaps.features.push_back({{{0.0, 0.0}}, {std::int64_t{i + 1}, i == 1 ? 9.0 : 0.5 * i}});
  }
  const Json packed = packedLayer(gaps, {0.0, 0.0}, {2, "length_m"});
  EXPECT_EQ(packed["count"], 2);
  EXPECT_EQ(packed["of"], 5);
  EXPECT_EQ(numbersOf(packed["columns"]["id"]), (std::vector<double>{2.0, 5.0}));
}

TEST(FactsPage, OfManyPlantsIsThinnedAndSaysSoAndStaysSmall) {
  const Json scene = factsScene({plantsOf(400'000)}, {352400.0, 4815300.0});
  const Json& plants = scene["layers"]["plants"];
  EXPECT_EQ(plants["of"], 400'000);
  EXPECT_LE(plants["count"], 120'000);
  EXPECT_GT(numbersOf(plants["columns"]["id"]).back(), 399'990.0);
  EXPECT_LT(scene.dump().size(), 3'000'000U);
}

TEST(FactsPage, TooManySquaresAreLeftOutAltogether) {
  VectorLayer grid{"grid", GeometryKind::kPolygon, {{"id", FieldKind::kInteger}}, {}};
  for (int i = 0; i < 20'000; ++i) {
    grid.features.push_back({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {std::int64_t{i + 1}}});
  }
  const Json packed = factsScene({grid}, {0.0, 0.0})["layers"]["grid"];
  EXPECT_EQ(packed["count"], 0);
  EXPECT_EQ(packed["of"], 20'000);
}

TEST(FactsPage, NamesStayText) {
  const std::string evil = "</script><script>alert(1)</script>\xff";
  VectorLayer plots{"plots", GeometryKind::kPolygon, {{"id", FieldKind::kText}}, {}};
  plots.features.push_back({{{0, 0}, {1, 0}, {1, 1}}, {evil}});
  FactsPageInfo info;
  info.command_line = {"agricolmap", evil};
  info.map_page = evil;
  const std::string page = factsPage({{"format", "agricolmap-facts"}, {"source", evil}},
                                     factsScene({plots}, {0.0, 0.0}), evil + "\n12 rows\n", info);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("<p>12 rows</p>"));
  const nlohmann::json scene = agricolmap::testing::dataOf(page, "scene");
  EXPECT_THAT(scene["layers"]["plots"]["columns"]["id"][0].get<std::string>(),
              HasSubstr("</script>"));
}

TEST(FactsPage, PicturesFitIntoTheirBytesHoweverLargeTheField) {
  if (!canDraw()) GTEST_SKIP() << "built without pictures";
  Raster<float> noise(2500, 2600);
  Raster<Rgb> colour(2500, 2600);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    noise[i] = static_cast<float>(state >> 8) / 16777216.0F;
    colour[i] = {static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
                 static_cast<std::uint8_t>(state >> 8)};
  }
  const GridFrame frame{{0.0, 0.0}, 0.01, 2500, 2600};
  const ColourMap colours{frame, colour, Raster<std::uint8_t>(2500, 2600, 1)};
  Json scene = factsScene({plantsOf(400'000)}, {0.0, 0.0});
  addFactsPictures(scene, {frame, noise, noise, colours});
  EXPECT_LT(scene.dump().size(), 7'500'000U);
  const Json& maps = scene["maps"];
  EXPECT_EQ(maps["fixed"].size(), 2U);
  EXPECT_TRUE(maps["fixed"][0]["layers"].contains("plant_height"));
  const Raster<float> none;
  const ColourMap unknown;
  Json bare = Json::object();
  addFactsPictures(bare, {frame, noise, none, unknown});
  EXPECT_EQ(bare["maps"]["fixed"].size(), 1U);
  EXPECT_EQ(bare["maps"]["fixed"][0]["layers"].size(), 1U);
}

}  // namespace
}  // namespace agricolmap::report
