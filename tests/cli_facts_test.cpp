// `agricolmap facts`: what stands on a simulated field, against its truth.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/cli_fixture.hpp"
#include "support/program.hpp"

namespace agricolmap::test {
namespace {

class FactsTest : public CliTest {
 protected:
  static void SetUpTestSuite() { GDALAllRegister(); }
  /// A field of small sugar beets, and its clouds.
  std::string simulated() {
    const std::string folder = inFolder("field");
    const ProgramResult made =
        runAgricolmap({"simulate", "--crop", "sugar_beet_10m", "--field.plant-size", "0.6",
                       "--field.width", "9", "--field.height", "9", "--ugv.length", "3", "--seed",
                       "104", "--no-pictures", "-o", folder});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return folder;
  }
  static int lines(const std::string& text, const std::string& with) {
    std::istringstream stream(text);
    std::string line;
    int count = 0;
    while (std::getline(stream, line)) count += line.find(with) != std::string::npos ? 1 : 0;
    return count;
  }
};

TEST_F(FactsTest, CountsThePlantsOfADronesCloud) {
  const std::string field = simulated();
  const ProgramResult result =
      runAgricolmap({"facts", field + "/uav/point_cloud.ply", "-o", inFolder("facts"), "--crs",
                     "EPSG:32633", "--grid", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find(" plants ("), std::string::npos) << result.out;
  const int truth = lines(contentOf(field + "/truth_plants.csv"), ",crop,");
  const auto json = nlohmann::json::parse(contentOf(inFolder("facts/facts.json")));
  const double plants = json["total"]["plants"]["estimate"];
  EXPECT_NEAR(plants, truth, 0.05 * truth);
  EXPECT_LE(json["total"]["plants"]["low"], plants);
  EXPECT_GE(json["total"]["plants"]["high"], plants);
  EXPECT_NEAR(json["rows"]["spacing_m"], 0.5, 0.02);
  EXPECT_NEAR(json["plant_spacing_m"], 0.19, 0.01);
  EXPECT_EQ(lines(contentOf(inFolder("facts/plants.csv")), "."),
            json["total"]["plants"]["counted"]);
  EXPECT_EQ(contentOf(inFolder("facts/facts.png")).substr(0, 4), "\x89PNG");
  const std::string page = contentOf(inFolder("facts/facts.html"));
  EXPECT_NE(page.find("\"colour\":\"iVBOR"), std::string::npos);  // also of a cloud that is no map
  EXPECT_LT(page.size(), 8'000'000U);
  const auto brapi = nlohmann::json::parse(contentOf(inFolder("facts/brapi.geojson")));
  ASSERT_GE(brapi["features"].size(), 9U);
  const auto& unit = brapi["features"][0]["properties"];
  EXPECT_TRUE(unit.contains("observationUnitDbId"));
  EXPECT_EQ(unit["observationUnitPosition"]["geoCoordinates"]["type"], "Feature");
  EXPECT_NEAR(brapi["features"][0]["geometry"]["coordinates"][0][0][1], 43.5, 0.5);
}

TEST_F(FactsTest, WritesAGeoPackageThatOthersRead) {
  const std::string field = simulated();
  const std::string plots =
      write("plots.geojson", R"({"type":"FeatureCollection","crs":{"type":"name","properties":
      {"name":"urn:ogc:def:crs:EPSG::32633"}},"features":[{"type":"Feature",
      "properties":{"plot":"A, north"},"geometry":{"type":"Polygon","coordinates":
      [[[352419,4815308],[352424,4815308],[352424,4815313],[352419,4815313],[352419,4815308]]]}}]})");
  const ProgramResult result =
      runAgricolmap({"facts", field + "/uav/point_cloud.ply", "-o", inFolder("facts"), "--crs",
                     "EPSG:32633", "--plots", plots, "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const GDALDatasetUniquePtr file(
      GDALDataset::Open(inFolder("facts/facts.gpkg").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(file);
  for (const char* name : {"rows", "plants", "gaps", "weeds", "uncountable", "grid", "plots"}) {
    OGRLayer* layer = file->GetLayerByName(name);
    ASSERT_NE(layer, nullptr) << name;
    ASSERT_NE(layer->GetSpatialRef(), nullptr) << name;
    EXPECT_STREQ(layer->GetSpatialRef()->GetAuthorityCode(nullptr), "32633") << name;
  }
  ASSERT_NE(file->GetLayerByName("layer_styles"), nullptr);
  EXPECT_EQ(file->GetLayerByName("layer_styles")->GetFeatureCount(), 7);
  EXPECT_GT(file->GetLayerByName("plants")->GetFeatureCount(), 500);
  OGRLayer* plot = file->GetLayerByName("plots");
  const OGRFeatureUniquePtr first(plot->GetNextFeature());
  ASSERT_TRUE(first);
  EXPECT_STREQ(first->GetFieldAsString("id"), "A, north");
  EXPECT_NEAR(first->GetFieldAsDouble("seen_m2"), 25.0, 1.0);
  EXPECT_NEAR(first->GetFieldAsDouble("plants"), 25.0 / 0.5 / 0.19, 40.0);
  EXPECT_NE(contentOf(inFolder("facts/plots.csv")).find("\n\"A, north\","), std::string::npos);
  // Without a coordinate system: no degrees, but all else; nothing of the earlier run stays.
  const ProgramResult again = runAgricolmap({"facts", field + "/uav/point_cloud.ply", "-o",
                                             inFolder("facts"), "--no-pictures", "--overwrite"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(entries("facts").count("brapi.geojson"), 0U);
  EXPECT_EQ(entries("facts").count("plots.csv"), 0U);
  EXPECT_EQ(entries("facts").count("facts.gpkg"), 1U);
  std::vector<std::string> prescribe = {
      "prescribe", inFolder("facts"), "-o",      inFolder("rates"),
      "--layer",   "cover",           "--rates", "160",
      "120",       "--unit",          "kg/ha",   "--no-pictures"};
  expectFailure(prescribe, 3, {"facts.gpkg", "does not say its coordinate system", "--crs"});
  prescribe.insert(prescribe.end(), {"--crs", "EPSG:32633"});
  EXPECT_EQ(runAgricolmap(prescribe).exit_code, 0);
}

TEST_F(FactsTest, PlantsWhoseLeavesTouchAreNotCounted) {
  const ProgramResult result =
      run({"facts", pair().uav(), "-o", inFolder("facts"), "--no-pictures"});
  EXPECT_NE(result.out.find("plants touch"), std::string::npos) << result.out;
  const auto json = jsonOf(inFolder("facts/facts.json"));
  EXPECT_TRUE(json["total"]["plants"].is_null());
  EXPECT_GT(json["rows"]["count"], 20);
}

TEST_F(FactsTest, OfAFlatCloudSayNoHeights) {
  // Rows 0.5 m apart of plants 0.2 m apart; heights of an orthomosaic without a surface model.
  std::ostringstream points;
  for (int row = 0; row < 200; ++row) {
    for (int col = 0; col < 200; ++col) {
      const int across = (row % 25) - 12;
      const int along = (col % 10) - 5;
      const bool plant = across * across + along * along < 8;
      const char* soil = (row + col) % 2 == 0 ? "120 100 80" : "124 102 80";
      points << 0.02 * col << ' ' << 0.02 * row << " 0 " << (plant ? "80 140 60" : soil) << '\n';
    }
  }
  const std::string cloud = write("flat.xyz", points.str());
  const ProgramResult result = run({"facts", cloud, "-o", inFolder("facts"), "--no-pictures"});
  EXPECT_EQ(result.out.find("plant height"), std::string::npos) << result.out;
  const auto json = jsonOf(inFolder("facts/facts.json"));
  EXPECT_TRUE(json["total"]["height_m"]["p50"].is_null());
  EXPECT_NEAR(json["rows"]["spacing_m"], 0.5, 0.02);
}

TEST_F(FactsTest, OfASharedMapSeeTheStripsInTheirOwnCells) {
  run({"fuse", pair("strips").uav(), pair("strips").folder.parent_path() / "runs/strip_1", "-o",
       inFolder("map"), "--cloud-format", "none", "--no-pictures"});
  run({"facts", inFolder("map"), "-o", inFolder("facts"), "--no-pictures"});
  run({"facts", pair("strips").uav(), "-o", inFolder("drone"), "--no-pictures"});
  const auto map = jsonOf(inFolder("facts/facts.json"));
  const auto drone = jsonOf(inFolder("drone/facts.json"));
  EXPECT_NEAR(map["rows"]["spacing_m"], drone["rows"]["spacing_m"], 0.01);
  EXPECT_NEAR(map["total"]["cover"], drone["total"]["cover"], 0.03);
  EXPECT_NE(contentOf(inFolder("facts/facts.html")).find("\"map_page\":\"../map/map.html\""),
            std::string::npos);
  // What the drone's blur flattens the robot has seen.
  EXPECT_GT(map["total"]["height_m"]["p90"], drone["total"]["height_m"]["p90"]);
}

TEST_F(FactsTest, WhatCannotBeUsedIsNamed) {
  const std::string field = simulated();
  const std::string cloud = field + "/uav/point_cloud.ply";
  const std::string out = inFolder("facts");
  expectFailure({"facts", inFolder("none.ply"), "-o", out}, 3, {"none.ply"});
  std::filesystem::create_directories(inFolder("map/layers"));
  expectFailure({"facts", inFolder("map"), "-o", out}, 3, {"map.json"});
  expectFailure({"facts", cloud, "-o", out, "--plots", inFolder("none.gpkg")}, 3, {"none.gpkg"});
  const std::string text = write("plots.txt", "no polygons here");
  expectFailure({"facts", cloud, "-o", out, "--plots", text}, 3, {"plots.txt", "GeoPackage"});
  const std::string elsewhere =
      write("elsewhere.geojson", R"({"type":"FeatureCollection","crs":{"type":"name","properties":
      {"name":"urn:ogc:def:crs:EPSG::32633"}},"features":[{"type":"Feature","properties":{},
      "geometry":{"type":"Polygon","coordinates":[[[1,1],[9,1],[9,9],[1,9],[1,1]]]}}]})");
  expectFailure(
      {"facts", cloud, "-o", out, "--crs", "EPSG:32633", "--plots", elsewhere, "--no-pictures"}, 3,
      {"elsewhere.geojson", "point_cloud.ply", "nothing of its 1 plots", "coordinate system"});
  expectFailure({"facts", cloud, "-o", out, "--grid", "0"}, 2, {"grid"});
  EXPECT_EQ(entries().count("facts"), 0U);
}

}  // namespace
}  // namespace agricolmap::test
