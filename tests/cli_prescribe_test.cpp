// `agricolmap prescribe`: rates of layers that the test makes, and of the squares of facts.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <limits>

#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_writer.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"
#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

class PrescribeTest : public CliTest {
 protected:
  static void SetUpTestSuite() { GDALAllRegister(); }

  /// 24 m × 16 m of a map whose plant heights are 0.1 m in the west, 0.3 m from 12 m on, and
  /// unknown in the northernmost 4 m.
  std::string writeMap(const std::string& name, const std::string& crs = "EPSG:32632") const {
    io::GeoLayer layer;
    layer.frame = {{0.0, 0.0}, 0.1, 160, 240};
    layer.origin = {620000.0, 5300000.0, 0.0};
    layer.crs = crs;
    layer.nodata = kNone;
    Raster<float> height(160, 240);
    for (int row = 0; row < 160; ++row) {
      for (int col = 0; col < 240; ++col) {
        height(row, col) = row >= 120 ? kNone : col < 120 ? 0.1F : 0.3F;
      }
    }
    const Raster<float> cover(160, 240, 0.5F);
    const auto write_layer = [&](const char* file, std::vector<io::GeoBand> bands) {
      std::filesystem::create_directories(inFolder(name + "/layers"));
      layer.bands = std::move(bands);
      io::writeLayer(inFolder(name) + "/layers/" + file, layer);
    };
    write_layer("plant_height.tif", {{&height, "plant height", "m"}});
    write_layer("cover.tif", {{&cover, "cover", ""}});
    write(name + "/map.json", R"({"format": "agricolmap-map", "format_version": 1, "crs": null,
      "flat": false, "sources": [{"code": 1, "id": "fixed", "date": null, "points": 7,
      "file": "drone.laz"}]})");
    return inFolder(name);
  }

  std::vector<std::string> prescribe(const std::string& source,
                                     const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"prescribe", source, "-o", inFolder("out")};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

TEST_F(PrescribeTest, OfALayerIsATaskAShapefileNumbersAndAPicture) {
  const std::string map = writeMap("map");
  const ProgramResult result = run(
      prescribe(map, {"--layer", "plant_height", "--breaks", "0.2", "--rates", "90,60", "--unit",
                      "kg/ha", "--width", "2", "--product", "urea", "--field", "Höhe"}));
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("below 0.2 m"), std::string::npos) << result.out;
  const std::set<std::string> files = entries("out");
  for (const char* file :
       {"TASKDATA/TASKDATA.XML", "TASKDATA/GRD00001.bin", "prescription.shp", "prescription.dbf",
        "prescription.shx", "prescription.prj", "prescription.json", "prescription.png"}) {
    EXPECT_EQ(files.count(file), 1U) << file;
  }
  const nlohmann::json json = jsonOf(inFolder("out/prescription.json"));
  // 24 m × 12 m are known, with squares that reach a metre beyond or fall short of it.
  EXPECT_NEAR(json["total"]["area_m2"], 288.0, 40.0);
  EXPECT_NEAR(json["classes"][0]["area_m2"], 144.0, 30.0);
  double amount = 0.0;
  for (const auto& entry : json["classes"]) {
    EXPECT_NEAR(entry["amount"].get<double>(),
                entry["area_m2"].get<double>() * 1e-4 * entry["rate"].get<double>(), 1e-9);
    amount += entry["amount"].get<double>();
  }
  EXPECT_NEAR(json["total"]["amount"], amount, 1e-9);
  const std::string xml = contentOf(inFolder("out/TASKDATA/TASKDATA.XML"));
  EXPECT_NE(xml.find(R"(A="0006" B="9000")"), std::string::npos) << xml;
  EXPECT_NE(xml.find(R"(C="Höhe")"), std::string::npos);
}

TEST_F(PrescribeTest, ShapefileAndTaskSayTheSame) {
  const std::string map = writeMap("map");
  run(prescribe(map, {"--layer", "plant_height", "--breaks", "0.2", "--rates", "90,60", "--unit",
                      "kg/ha", "--width", "2", "--no-pictures"}));
  const nlohmann::json json = jsonOf(inFolder("out/prescription.json"));
  const nlohmann::json& grid = json["isoxml_grid"];
  const std::string codes = contentOf(inFolder("out/TASKDATA/GRD00001.bin"));
  const GDALDatasetUniquePtr file(
      GDALDataset::Open(inFolder("out/prescription.shp").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(file);
  OGRLayer& shapes = *file->GetLayer(0);
  ASSERT_TRUE(shapes.GetSpatialRef()->IsGeographic());
  double amount = 0.0;
  double area = 0.0;
  for (const OGRFeatureUniquePtr& feature : shapes) {
    amount += feature->GetFieldAsDouble("AMOUNT");
    area += feature->GetFieldAsDouble("AREA_M2");
    EXPECT_TRUE(feature->GetGeometryRef()->IsValid());
  }
  EXPECT_NEAR(area, json["total"]["area_m2"], 0.1);
  EXPECT_NEAR(amount, json["total"]["amount"], 1e-3);
  const int cols = grid["cols"];
  ASSERT_EQ(codes.size(), static_cast<std::size_t>(cols * grid["rows"].get<int>()));
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const int row = static_cast<int>(i) / cols;
    const int col = static_cast<int>(i) % cols;
    const OGRPoint middle(
        grid["west_deg"].get<double>() + (col + 0.5) * grid["cell_east_deg"].get<double>(),
        grid["south_deg"].get<double>() + (row + 0.5) * grid["cell_north_deg"].get<double>());
    int code = 0;
    for (const OGRFeatureUniquePtr& feature : shapes) {
      if (feature->GetGeometryRef()->Contains(&middle)) code = feature->GetFieldAsInteger("CLASS");
    }
    EXPECT_EQ(code, codes[i]) << row << ' ' << col;
  }
}

TEST_F(PrescribeTest, ClassesOfEquallyManySquaresNeedNoBreaks) {
  const std::string map = writeMap("map");
  run(prescribe(map, {"--layer", "plant_height", "--rates", "90,60", "--unit", "seeds/m2",
                      "--width", "2", "--heading", "20", "--no-pictures"}));
  const nlohmann::json json = jsonOf(inFolder("out/prescription.json"));
  EXPECT_EQ(json["squares"]["heading_deg"], 20.0);
  EXPECT_NEAR(json["classes"][0]["squares"].get<int>(), json["classes"][1]["squares"].get<int>(),
              10);
  EXPECT_NEAR(json["isoxml_grid"]["amount"], json["total"]["amount"],
              0.02 * json["total"]["amount"].get<double>());
  // A layer of one value has no two classes.
  expectFailure({"prescribe", map, "-o", inFolder("other"), "--layer", "cover", "--rates", "1,2,3",
                 "--unit", "kg/ha"},
                3, {"too few different values", "breaks"});
}

TEST_F(PrescribeTest, TakesTheSquaresOfFacts) {
  io::VectorLayer squares{
      "grid",
      io::GeometryKind::kPolygon,
      {{"weed_share", io::FieldKind::kReal, 5}, {"seen_m2", io::FieldKind::kReal}},
      {}};
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 10; ++col) {
      const double x = 620000.0 + 2.0 * col;
      const double y = 5300000.0 + 2.0 * row;
      squares.features.push_back({{{x, y}, {x + 2.0, y}, {x + 2.0, y + 2.0}, {x, y + 2.0}},
                                  {col >= 6 ? 0.02 : 0.0, row == 5 ? 1.0 : 4.0}});
    }
  }
  std::filesystem::create_directories(inFolder("facts"));
  io::writeGeoPackage(inFolder("facts/facts.gpkg"), {squares}, *io::crsFromWkt("EPSG:32632"));
  run(prescribe(inFolder("facts"), {"--layer", "weed_share", "--breaks", "0.005", "--rates",
                                    "0,200", "--unit", "L/ha", "--width", "1"}));
  const nlohmann::json json = jsonOf(inFolder("out/prescription.json"));
  // Without the northernmost ones, of which a quarter was seen.
  EXPECT_NEAR(json["classes"][0]["area_m2"], 120.0, 20.0);
  EXPECT_NEAR(json["classes"][1]["area_m2"], 80.0, 16.0);
  EXPECT_EQ(json["classes"][0]["amount"], 0.0);
  expectFailure({"prescribe", inFolder("facts"), "-o", inFolder("x"), "--layer", "weeds", "--rates",
                 "1", "--unit", "L/ha"},
                3, {"facts.gpkg", "no field 'weeds'", "weed_share"});
}

TEST_F(PrescribeTest, TakesABandOfARaster) {
  io::GeoLayer layer;
  layer.frame = {{0.0, 0.0}, 0.5, 40, 40};
  layer.origin = {620000.0, 5300000.0, 0.0};
  layer.crs = "EPSG:32632";
  layer.nodata = kNone;
  const Raster<float> red(40, 40, 0.2F);
  const Raster<float> ndvi(40, 40, 0.7F);
  layer.bands = {{&red, "red", ""}, {&ndvi, "ndvi", ""}};
  const std::string raster = inFolder("bands.tif");
  io::writeLayer(raster, layer);
  const std::vector<std::string> rates = {"--breaks", "0.5",      "--rates",      "9,8",
                                          "--unit",   "seeds/m2", "--no-pictures"};
  expectFailure(prescribe(raster, rates), 3, {"bands.tif", "--layer 'red' 'ndvi'"});
  std::vector<std::string> chosen = prescribe(raster, rates);
  chosen.insert(chosen.end(), {"--layer", "ndvi"});
  run(chosen);
  const nlohmann::json json = jsonOf(inFolder("out/prescription.json"));
  EXPECT_EQ(json["classes"][0]["squares"], 0);
  EXPECT_NEAR(json["classes"][1]["area_m2"], 400.0, 60.0);
}

TEST_F(PrescribeTest, OfHeadingZeroHasTheSquaresOfFacts) {
  const std::string map = writeMap("map");
  run(prescribe(map, {"--layer", "cover", "--rates", "5", "--unit", "kg/ha", "--width", "4",
                      "--heading", "0", "--no-pictures"}));
  const GDALDatasetUniquePtr file(
      GDALDataset::Open(inFolder("out/prescription.shp").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(file);
  const OGRFeatureUniquePtr feature(file->GetLayer(0)->GetNextFeature());
  std::vector<Eigen::Vector2d> corners;
  const OGRLinearRing& ring = *feature->GetGeometryRef()->toPolygon()->getExteriorRing();
  for (int i = 0; i < ring.getNumPoints(); ++i) corners.emplace_back(ring.getX(i), ring.getY(i));
  const auto in_file = io::fromGeographic(*io::crsFromWkt("EPSG:32632"), corners);
  ASSERT_TRUE(in_file);
  for (const Eigen::Vector2d& corner : *in_file) {
    EXPECT_NEAR(std::remainder(corner.x(), 4.0), 0.0, 1e-3);
    EXPECT_NEAR(std::remainder(corner.y(), 4.0), 0.0, 1e-3);
  }
}

TEST_F(PrescribeTest, NeedsAPlaceOnEarth) {
  const std::string map = writeMap("map", "");
  const std::vector<std::string> common = {"--layer", "cover", "--rates",      "5",
                                           "--unit",  "kg/ha", "--no-pictures"};
  expectFailure(prescribe(map, common), 3,
                {"cover.tif", "does not say its coordinate system", "--crs EPSG:32632"});
  std::vector<std::string> said = prescribe(map, common);
  said.insert(said.end(), {"--crs", "EPSG:32632"});
  run(said);
  EXPECT_NEAR(jsonOf(inFolder("out/prescription.json"))["isoxml_grid"]["west_deg"], 10.6, 0.1);
  const std::string local = writeMap("local", R"(LOCAL_CS["barn",UNIT["metre",1]])");
  expectFailure({"prescribe", local, "-o", inFolder("x"), "--layer", "cover", "--rates", "5",
                 "--unit", "kg/ha"},
                3, {"local", "nowhere on the Earth"});
  said.back() = "EPSG:4326";
  said[3] = inFolder("y");
  expectFailure(said, 3, {"cover.tif", "degrees"});
}

TEST_F(PrescribeTest, WhatCannotBeUsedIsNamed) {
  const std::string map = writeMap("map");
  const auto refuses = [&](const std::vector<std::string>& more, int code,
                           const std::vector<std::string>& parts) {
    expectFailure(prescribe(map, more), code, parts);
  };
  refuses({"--rates", "5", "--unit", "kg/ha"}, 2, {"--layer", "cover, plant_height"});
  refuses({"--layer", "weeds", "--rates", "5", "--unit", "kg/ha"}, 3,
          {"no layer 'weeds'", "cover, plant_height"});
  refuses({"--layer", "source", "--rates", "5", "--unit", "kg/ha"}, 2, {"no quantity"});
  refuses({"--layer", "cover", "--rates", "5", "--unit", "bags/ha"}, 2,
          {"'bags/ha'", "kg/ha", "L/ha"});
  refuses({"--layer", "cover", "--unit", "kg/ha"}, 2, {"--rates"});
  refuses({"--layer", "cover", "--rates", "12", "--unit", "g/ha"}, 2, {"12 g/ha", "10"});
  refuses({"--layer", "cover", "--rates", "1,2,3", "--breaks", "0.5", "--unit", "kg/ha"}, 2,
          {"1 breaks", "3 rates"});
  refuses({"--layer", "cover", "--rates", "1,2,3", "--breaks", "0.5,0.2", "--unit", "kg/ha"}, 2,
          {"breaks must rise"});
  refuses({"--layer", "cover", "--rates", "5", "--unit", "kg/ha", "--width", "900"}, 3,
          {"knows no square", "--width"});
  refuses({"--layer", "cover", "--rates", "5", "--unit", "kg/ha", "--product",
           "a name that is much longer than a terminal's"},
          2, {"too long", "32", "product"});
  expectFailure(
      {"prescribe", inFolder("none.tif"), "-o", inFolder("out"), "--rates", "5", "--unit", "kg/ha"},
      3, {"none.tif"});
}

TEST_F(PrescribeTest, AFullDiskLeavesNothing) {
  const std::string map = writeMap("map");
  const auto before = entries();
  const ProgramResult result =
      runInShell("ulimit -f 8;", prescribe(map, {"--layer", "plant_height", "--rates", "5,6",
                                                 "--unit", "kg/ha", "--width", "0.2"}));
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_EQ(entries(), before);
}

}  // namespace
}  // namespace agricolmap::test
