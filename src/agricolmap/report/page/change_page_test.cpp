#include "agricolmap/report/page/change_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "agricolmap/report/page/change_squares.hpp"
#include "agricolmap/report/page/test_page.hpp"
#include "agricolmap/report/pictures/pictures.hpp"

namespace agricolmap::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A field of 4 m × 3 m whose western half rose by 10 cm and whose eastern half by nothing; its
/// northernmost metre is not known.
struct TestChange {
  GridFrame frame{{0.25, 0.5}, 0.05, 60, 80};
  change::HeightChange heights{Raster<float>(60, 80, kNone), Raster<float>(60, 80, kNone),
                               Raster<float>(60, 80, kNone)};
  LayerTimes surface{Raster<float>(60, 80, 1.0F), Raster<float>(60, 80, 1.0F)};
  LayerTimes plants{Raster<float>(60, 80, 0.1F), Raster<float>(60, 80, 0.2F)};
  LayerTimes none;
  ColourMap grey{frame, Raster<Rgb>(60, 80, Rgb{90, 90, 90}), Raster<std::uint8_t>(60, 80, 1)};
  ColourMap unknown;

  TestChange() {
    for (int r = 0; r < 40; ++r) {
      for (int c = 0; c < 80; ++c) {
        const bool west = c < 40;
        heights.change(r, c) = west ? 0.1F : 0.0F;
        heights.detection(r, c) = 0.03F;
        heights.significant(r, c) = west ? 1.0F : 0.0F;
      }
    }
  }
  ChangeGround ground(const ColourMap& colours) const {
    return {frame, {352400.0, 4815300.0}, heights, surface, plants, none, colours, colours};
  }
};

double valueOf(const io::VectorLayer& layer, std::size_t feature, const std::string& field) {
  for (std::size_t i = 0; i < layer.fields.size(); ++i) {
    if (layer.fields[i].name == field) return std::get<double>(layer.features[feature].values[i]);
  }
  return std::nan("");
}

TEST(ChangeSquares, LieOnRoundCoordinatesAndHaveWhatChangedInThem) {
  const TestChange field;
  const io::VectorLayer squares = changeSquares(field.ground(field.grey));
  // 4 m from 0.25 on touch five squares, the 2 m that are known from 0.5 on three.
  ASSERT_EQ(squares.features.size(), 15U);
  EXPECT_EQ(squares.features[0].points[0], Eigen::Vector2d(352400.0, 4815300.0));
  EXPECT_NEAR(valueOf(squares, 0, "compared_m2"), 0.75 * 0.5, 1e-9);
  EXPECT_NEAR(valueOf(squares, 0, "change_m"), 0.1, 1e-6);
  EXPECT_NEAR(valueOf(squares, 0, "level_m"), 0.03, 1e-6);
  EXPECT_EQ(valueOf(squares, 0, "rose"), 1.0);
  EXPECT_NEAR(valueOf(squares, 0, "volume_m3"), 0.1 * 0.75 * 0.5, 1e-6);
  EXPECT_NEAR(valueOf(squares, 2, "rose"), 0.25, 1e-9);  // the border lies at 2.25
  EXPECT_EQ(valueOf(squares, 4, "rose"), 0.0);
  EXPECT_NEAR(valueOf(squares, 4, "plant_height_change_m"), 0.1, 1e-6);
  EXPECT_TRUE(std::isnan(valueOf(squares, 4, "cover_change")));
}

TEST(ChangePage, HasPicturesOfBothTimesAndOfTheChange) {
  if (!canDraw()) GTEST_SKIP() << "built without pictures";
  const TestChange field;
  Json scene = Json::object();
  addChangePictures(scene, field.ground(field.grey));
  const Json& coloured = scene["maps"];
  ASSERT_EQ(coloured["fixed"].size(), 3U);
  for (const char* name : {"change", "before_plant_height", "plant_height_change"}) {
    EXPECT_TRUE(coloured["fixed"][0]["layers"].contains(name)) << name;
  }
  EXPECT_FALSE(coloured["fixed"][0]["layers"].contains("before_relief"));
  EXPECT_TRUE(coloured["fixed"][1]["layers"].contains("before_colour"));
  EXPECT_GE(coloured["scales"]["change"][1], 0.1);
  Json without = Json::object();
  addChangePictures(without, field.ground(field.unknown));
  const Json& plain = without["maps"];
  ASSERT_EQ(plain["fixed"].size(), 1U);
  EXPECT_TRUE(plain["fixed"][0]["layers"].contains("after_relief"));
}

TEST(ChangePage, OfFlatMapsShowsCoversAlone) {
  TestChange field;
  for (float& value : field.heights.change) value = kNone;
  const LayerTimes cover{Raster<float>(60, 80, 0.2F), Raster<float>(60, 80, 0.5F)};
  const ChangeGround ground{
      field.frame, {352400.0, 4815300.0}, field.heights, field.none, field.none,
      cover,       field.unknown,         field.unknown};
  const io::VectorLayer squares = changeSquares(ground);
  ASSERT_EQ(squares.features.size(), 20U);
  EXPECT_TRUE(std::isnan(valueOf(squares, 0, "change_m")));
  EXPECT_NEAR(valueOf(squares, 0, "cover_change"), 0.3, 1e-6);
  EXPECT_NEAR(valueOf(squares, 0, "compared_m2"), 0.75 * 0.5, 1e-9);
  Json scene = changeScene(ground);
  EXPECT_FALSE(scene.contains("cells"));
  if (!canDraw()) return;
  addChangePictures(scene, ground);
  const Json& layers = scene["maps"]["fixed"][0]["layers"];
  EXPECT_TRUE(layers.contains("cover_change"));
  EXPECT_FALSE(layers.contains("change"));
  EXPECT_FALSE(layers.contains("before_relief"));
}

TEST(ChangePage, PartsThatWereAskedForStandForItsSquares) {
  const TestChange field;
  const auto zones = [](const char* name, std::size_t count) {
    io::VectorLayer layer{name, io::GeometryKind::kPolygon, {{"id", io::FieldKind::kText}}, {}};
    const Eigen::Vector2d a(352401.0, 4815301.0);
    for (std::size_t i = 0; i < count; ++i) {
      layer.features.push_back(
          {{a, a + Eigen::Vector2d(1.0, 0.0), a + Eigen::Vector2d(1.0, 1.0)}, {std::string("A")}});
    }
    return layer;
  };
  const auto layersOf = [&](const std::vector<io::VectorLayer>& given) {
    return changeScene(field.ground(field.grey), given)["layers"];
  };
  const Json plots = layersOf({zones("plots", 2)});
  EXPECT_EQ(plots["plots"]["count"], 2);
  EXPECT_TRUE(plots.contains("squares"));
  const Json both = layersOf({zones("plots", 2), zones("grid", 3)});
  EXPECT_EQ(both["grid"]["count"], 3);
  EXPECT_FALSE(both.contains("squares"));
  const Json many = layersOf({zones("grid", 12'001)});
  EXPECT_FALSE(many.contains("grid"));
  EXPECT_EQ(many["squares"]["count"], 15);
}

TEST(ChangePage, CountsTheCellsAndKeepsNamesAsText) {
  const TestChange field;
  const Json scene = changeScene(field.ground(field.grey));
  double sure = 0.0;
  for (const auto& cells : scene["cells"]["sure"]) sure += cells.get<double>();
  EXPECT_EQ(sure, 40.0 * 40.0);
  EXPECT_EQ(scene["layers"]["squares"]["count"], 15);
  const std::string evil = "</script><script>alert(1)</script>\xff";
  const std::string page = changePage({{"format", "agricolmap-change"}, {"before", evil}}, scene,
                                      {{{"rose", evil}}, {evil}, evil, "", {evil}, "1"});
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("<p>rose: &lt;/script&gt;"));
  EXPECT_THAT(testing::dataOf(page, "facts")["warnings"][0].get<std::string>(),
              HasSubstr("</script>"));
}

}  // namespace
}  // namespace agricolmap::report
