// `agricolmap diff`: maps made up by the test, with what changed between them known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/geo_writer.hpp"
#include "agricolmap/io/raster/raster_test_support.hpp"
#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Rows of a table without quotes, by the names in its first line.
using Table = std::vector<std::map<std::string, std::string>>;

Table tableOf(const std::string& text) {
  std::istringstream lines(text);
  const auto cellsOf = [](const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char letter : line) {
      if (letter == ',') {
        cells.emplace_back();
      } else if (letter != '\r') {
        cells.back() += letter;
      }
    }
    return cells;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cellsOf(line);
  Table rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cellsOf(line);
    rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) rows.back()[names[i]] = cells.at(i);
  }
  return rows;
}

/// A field of plants in rows that run north, and what a map says of it.
struct Field {
  Eigen::Vector2d south_west{500000.0, 5000000.0};
  double cell = 0.02;
  int rows = 300;
  int cols = 400;
  double growth = 1.0;       ///< of the plants east of the middle
  double heights_off = 0.0;  ///< [m]
  bool flat = false;         ///< of orthomosaics alone
  std::string crs = "EPSG:32632";
  std::string drone = "june.laz";
};

class DiffTest : public CliTest {
 protected:
  /// Of a place in metres from (500000, 5000000).
  static double plantAt(const Eigen::Vector2d& at, double growth) {
    const double across = std::remainder(at.x(), 0.5);
    const double along = std::remainder(at.y(), 0.2);
    const double top = 0.2 * std::exp(-(across * across + along * along) / 0.006);
    return at.x() > 4.0 ? growth * top : top;
  }

  std::string writeMap(const std::string& name, const Field& field) const {
    io::GeoLayer layer;
    layer.frame = {{0.0, 0.0}, field.cell, field.rows, field.cols};
    layer.origin.head<2>() = field.south_west;
    layer.crs = field.crs;
    layer.nodata = kNone;
    Raster<float> surface(field.rows, field.cols);
    Raster<float> plants = surface;
    Raster<float> cover = surface;
    for (int r = 0; r < field.rows; ++r) {
      for (int c = 0; c < field.cols; ++c) {
        const Eigen::Vector2d at =
            field.south_west - Eigen::Vector2d(500000.0, 5000000.0) + layer.frame.centre(r, c);
        const double plant = plantAt(at, field.growth);
        plants(r, c) = static_cast<float>(plant);
        surface(r, c) = static_cast<float>(300.0 + 0.01 * at.x() + plant + field.heights_off);
        cover(r, c) = plant > 0.02 ? 1.0F : 0.0F;
      }
    }
    const Raster<float> plane(field.rows, field.cols, 0.005F);
    const Raster<float> height(field.rows, field.cols, 0.01F);
    const auto write = [&](const char* file, std::vector<io::GeoBand> bands) {
      layer.bands = std::move(bands);
      io::writeLayer(layersOf(name) / file, layer);
    };
    if (!field.flat) {
      write("surface.tif", {{&surface, "surface", "m"}});
      write("plant_height.tif", {{&plants, "plant height", "m"}});
    }
    write("cover.tif", {{&cover, "cover", ""}});
    write("error.tif", {{&plane, "plane", "m"}, {&height, "height", "m"}});
    const Raster<std::uint16_t> source(field.rows, field.cols, 1);
    layer.nodata = 0.0;
    layer.overviews = io::Overviews::kNearest;
    write("source.tif", {{&source, "source", ""}});
    return describe(name, R"({"format": "agricolmap-map", "format_version": 1, "crs": null,
      "flat": )" + std::string(field.flat ? "true" : "false") +
                              R"(, "sources": [{"code": 1, "id": "fixed", "date": null, "points": 7,
      "file": ")" + field.drone +
                              R"("}]})");
  }

  /// Writes map.json alone; returns the map's folder.
  std::string describe(const std::string& name, const std::string& text) const {
    write(name + "/map.json", text);
    return inFolder(name);
  }

  std::filesystem::path layersOf(const std::string& map) const {
    std::filesystem::create_directories(inFolder(map + "/layers"));
    return inFolder(map + "/layers");
  }
};

TEST_F(DiffTest, FindsWhatGrewAndNothingElse) {
  const std::string june = writeMap("june", {});
  Field grown;
  grown.growth = 1.5;
  const std::string july = writeMap("july", grown);
  const ProgramResult result = run({"diff", june, july, "-o", inFolder("out")});
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("rose"), std::string::npos);
  EXPECT_EQ(entries("out"),
            (std::set<std::string>{"change.html", "change.json", "change.png", "cover_change.qml",
                                   "cover_change.tif", "height_change.qml", "height_change.tif",
                                   "plant_height_change.qml", "plant_height_change.tif"}));
  const io::Layer<float> change = io::readLayer<float>(inFolder("out/height_change.tif"));
  EXPECT_EQ(change.shape.bands,
            (std::vector<std::string>{"change", "level of detection", "significant"}));
  double truth = 0.0;
  for (int r = 0; r < 300; ++r) {
    for (int c = 0; c < 400; ++c) {
      const Eigen::Vector2d at = 0.02 * Eigen::Vector2d(c + 0.5, r + 0.5);
      const double grew = plantAt(at, 1.5) - plantAt(at, 1.0);
      EXPECT_NEAR(change.bands[0](r, c), grew, 1e-4);
      if (at.x() < 4.0) {
        EXPECT_EQ(change.bands[2](r, c), 0.0F);
      }
      truth += grew * 0.02 * 0.02;
    }
  }
  const nlohmann::json json = jsonOf(inFolder("out/change.json"));
  const nlohmann::json& surface = json["surface"];
  EXPECT_NEAR(surface["compared"]["volume_m3"], truth, 1e-3);
  // One error of 1 cm in each map, over all 48 m²: no number of cells takes that away.
  EXPECT_NEAR(surface["compared"]["mean_deviation_m"], std::hypot(0.01, 0.01), 2e-4);
  EXPECT_EQ(surface["fall"]["cells"], 0);
  EXPECT_GT(surface["rise"]["volume_m3"], 0.5 * truth);
  EXPECT_NEAR(surface["bare_ground"]["mean_m"], 0.0, 2e-3);
  EXPECT_GT(json["cover"]["mean_change"], 0.0);
}

TEST_F(DiffTest, SaysWhatChangedByPlotsAndBySquares) {
  const std::string june = writeMap("june", {});
  Field grown;
  grown.growth = 1.5;
  const std::string july = writeMap("july", grown);
  // Corners in metres of the maps' own system: west of the middle, east of it, outside.
  const auto ring = [](double west) {
    return fmt::format("[[[{0},5000001],[{1},5000001],[{1},5000004],[{0},5000004],[{0},5000001]]]",
                       500000.0 + west, 500000.0 + west + 2.0);
  };
  const auto plot = [&](const char* id, double west) {
    return fmt::format(R"({{"type": "Feature", "properties": {{"plot": "{}"}},
        "geometry": {{"type": "Polygon", "coordinates": {}}}}})",
                       id, ring(west));
  };
  const auto file = [&](const std::string& features) {
    return fmt::format(R"({{"type": "FeatureCollection", "crs": {{"type": "name", "properties":
        {{"name": "urn:ogc:def:crs:EPSG::32632"}}}}, "features": [{}]}})",
                       features);
  };
  write("plots.geojson",
        file(plot("west", 1.0) + "," + plot("east", 5.0) + "," + plot("out", 30.0)));
  run({"diff", june, july, "-o", inFolder("out"), "--plots", inFolder("plots.geojson"), "--grid",
       "2", "-q"});
  const Table plots = tableOf(contentOf(inFolder("out/plots.csv")));
  ASSERT_EQ(plots.size(), 3U);
  EXPECT_EQ(plots[0].at("id"), "west");
  EXPECT_NEAR(std::stod(plots[0].at("compared_m2")), 6.0, 0.01);
  EXPECT_NEAR(std::stod(plots[0].at("height_change_m")), 0.0, 1e-4);
  EXPECT_EQ(plots[0].at("more_than_errors"), "0");
  EXPECT_GT(std::stod(plots[1].at("height_change_m")), 0.005);
  EXPECT_GT(std::stod(plots[1].at("rose_share")), 0.1);
  EXPECT_GT(std::stod(plots[1].at("plant_height_after_m")),
            1.3 * std::stod(plots[1].at("plant_height_before_m")));
  EXPECT_GT(std::stod(plots[1].at("cover_after")), std::stod(plots[1].at("cover_before")));
  // Nothing is known of the third, which is not the same as no change.
  EXPECT_EQ(plots[2].at("compared_m2"), "0.00");
  EXPECT_EQ(plots[2].at("height_change_m"), "");
  EXPECT_EQ(plots[2].at("more_than_errors"), "");
  EXPECT_EQ(tableOf(contentOf(inFolder("out/grid.csv"))).size(), 12U);
  EXPECT_TRUE(entries("out").contains("change.gpkg"));

  write("elsewhere.geojson", file(plot("out", 30.0)));
  expectFailure(
      {"diff", june, july, "-o", inFolder("none"), "--plots", inFolder("elsewhere.geojson")}, 3,
      {"elsewhere.geojson", "nothing to compare", "coordinate system"});
  // A run without plots leaves none of an earlier one behind.
  run({"diff", june, july, "-o", inFolder("out"), "--overwrite", "-q"});
  EXPECT_FALSE(entries("out").contains("plots.csv"));
}

TEST_F(DiffTest, ComparesGreennessAloneWhereThereAreNoHeights) {
  Field field;
  field.flat = true;
  const std::string june = writeMap("june", field);
  field.growth = 3.0;
  const std::string july = writeMap("july", field);
  const ProgramResult result = run({"diff", june, july, "-o", inFolder("out"), "--grid", "2"});
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out.find("rose"), std::string::npos);
  EXPECT_NE(result.out.find("cover"), std::string::npos);
  EXPECT_EQ(entries("out"),
            (std::set<std::string>{"change.gpkg", "change.html", "change.json", "change.png",
                                   "cover_change.qml", "cover_change.tif", "grid.csv"}));
  const nlohmann::json json = jsonOf(inFolder("out/change.json"));
  EXPECT_TRUE(json["surface"].is_null());
  EXPECT_GT(json["cover"]["mean_change"], 0.01);
  const Table squares = tableOf(contentOf(inFolder("out/grid.csv")));
  ASSERT_EQ(squares.size(), 12U);
  EXPECT_FALSE(squares[0].contains("height_change_m"));
  EXPECT_EQ(squares[0].at("cover_before"), squares[0].at("cover_after"));
  EXPECT_LT(std::stod(squares[3].at("cover_before")), std::stod(squares[3].at("cover_after")));
  // One of the two has heights, which nothing is there to compare with.
  const ProgramResult mixed = run({"diff", june, writeMap("august", {}), "-o", inFolder("mixed")});
  EXPECT_NE(mixed.err.find("has no heights, so only greenness is compared"), std::string::npos);
  expectFailure({"diff", june, inFolder("august/layers/surface.tif"), "-o", inFolder("none"),
                 "--error-b", "0.1", "0.1"},
                3, {"august/layers/surface.tif is a surface", "has no heights"});
}

TEST_F(DiffTest, NothingIsNotCalledNegative) {
  Field lower;
  lower.heights_off = -0.0002;
  const ProgramResult result =
      run({"diff", writeMap("june", {}), writeMap("july", lower), "-o", inFolder("out")});
  EXPECT_NE(result.out.find("by 0.0 +- "), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("-0.0 "), std::string::npos) << result.out;
}

TEST_F(DiffTest, InfoSaysWhatAMapIsMadeOf) {
  const std::string out = run({"info", writeMap("june", {})}).out;
  for (const char* part : {"UTM zone 32N", "sources    1", "fixed, june.laz",
                           "layers     5: cover, error, plant_height, source, surface",
                           "400 x 300 of 0.02 m", "500000.000 to 500008.000 m"}) {
    EXPECT_NE(out.find(part), std::string::npos) << part << " is not in:\n" << out;
  }
  std::filesystem::create_directories(inFolder("empty"));
  expectFailure({"info", inFolder("empty")}, 3, {"empty", "map.json", "fuse"});
}

TEST_F(DiffTest, ComparesGridsOfOtherCellsAndCorners) {
  Field coarse;
  coarse.cell = 0.05;
  coarse.rows = 110;
  coarse.cols = 170;
  coarse.south_west = {499999.77, 5000000.31};
  const std::string june = writeMap("june", {});
  const std::string july = writeMap("july", coarse);
  for (const auto& [a, b] : {std::pair(june, july), std::pair(july, june)}) {
    run({"diff", a, b, "-o", inFolder("out"), "--overwrite", "-q"});
    const nlohmann::json json = jsonOf(inFolder("out/change.json"));
    EXPECT_EQ(json["grid"]["cell_m"], 0.05);
    EXPECT_NEAR(json["surface"]["compared"]["mean_m"], 0.0, 1e-3);
    EXPECT_LT(json["surface"]["rise"]["cells"],
              0.05 * json["surface"]["compared"]["cells"].get<double>());
  }
}

TEST_F(DiffTest, SaysWhatTheErrorsCannotKnow) {
  const std::string june = writeMap("june", {});
  Field other;
  other.drone = "july.laz";
  other.heights_off = 0.06;
  const std::string july = writeMap("july", other);
  const ProgramResult result = run({"diff", june, july, "-o", inFolder("a")});
  EXPECT_NE(result.err.find("--frame-error HEIGHT PLANE"), std::string::npos);
  EXPECT_NE(result.err.find("bare ground changed by 6.0 cm"), std::string::npos);
  const ProgramResult said =
      run({"diff", june, july, "-o", inFolder("b"), "--frame-error", "0.05", "0.02"});
  EXPECT_EQ(said.err, "");
  EXPECT_EQ(jsonOf(inFolder("b/change.json"))["surface"]["rise"]["cells"], 0);
}

TEST_F(DiffTest, TakesSurfaceModels) {
  const std::string before = writeSheet(inFolder("before.tif"), surfaceModel());
  Sheet raised = surfaceModel();
  raised.value = [](int, int col, int row) { return 300.2 + 0.25 * col + 0.1 * row; };
  const std::string after = writeSheet(inFolder("after.tif"), raised);
  expectFailure({"diff", before, after, "-o", inFolder("out")}, 2,
                {"before.tif", "nothing is known of its errors", "--error-a HEIGHT PLANE"});
  run({"diff", before, after, "-o", inFolder("out"), "--error-a", "0.03", "0", "--error-b", "0.04",
       "0.0", "--no-pictures"});
  const nlohmann::json json = jsonOf(inFolder("out/change.json"));
  EXPECT_NEAR(json["surface"]["rise"]["mean_m"], 0.2, 1e-4);
  EXPECT_NEAR(json["surface"]["median_detection_m"], 1.96 * 0.05, 1e-4);
  EXPECT_EQ(entries("out"), (std::set<std::string>{"change.html", "change.json",
                                                   "height_change.qml", "height_change.tif"}));
}

TEST_F(DiffTest, RefusesMapsThatDoNotGoTogether) {
  const std::string june = writeMap("june", {});
  const auto refuses = [&](const std::string& map, const std::vector<std::string>& parts) {
    expectFailure({"diff", june, map, "-o", inFolder("out")}, 3, parts);
  };
  Field field;
  field.crs = "EPSG:32633";
  refuses(writeMap("zone", field), {"different coordinate systems", "gdalwarp"});
  field = {};
  field.south_west.x() += 1000.0;
  refuses(writeMap("away", field), {"away", "do not overlap", "500000.0"});
  refuses(describe("newer", R"({"format": "agricolmap-map", "format_version": 2})"),
          {"newer/map.json", "version 2", "newer one"});
  refuses(describe("torn", R"({"format": "agricolmap-m)"), {"torn/map.json", "damaged", "fuse"});
  refuses(describe("list", "[1]"), {"list/map.json", "is no shared map"});
  refuses(describe("foreign", R"({"format": 7})"), {"foreign/map.json", "agricolmap-map"});
  refuses(describe("old", R"({"format": "agricolmap-map"})"), {"old/map.json", "version"});
  refuses(describe("cut", R"({"format": "agricolmap-map", "format_version": 1})"),
          {"cut/map.json", "damaged", "flat is missing"});
  const std::string sources = R"("crs": null, "sources": [{"code": 1, "id": "fixed", "date": null,
      "points": 7, "file": "a.laz"}]})";
  refuses(describe("bare", R"({"format": "agricolmap-map", "format_version": 1, "flat": false, )" +
                               sources),
          {"bare", "layers/surface.tif", "fuse"});
  refuses(describe("flat",
                   R"({"format": "agricolmap-map", "format_version": 1, "flat": true, )" + sources),
          {"flat", "layers/cover.tif", "fuse"});
  std::filesystem::create_directories(inFolder("empty"));
  refuses(inFolder("empty"), {"empty", "map.json", "fuse"});
  refuses(inFolder("none"), {"none", "no such file"});
}

TEST_F(DiffTest, RefusesLayersOfAnotherGridAndDamagedOnes) {
  const std::string june = writeMap("june", {});
  Field field;
  field.cols = 380;
  const std::string narrow = writeMap("narrow", field);
  for (const char* layer : {"error.tif", "source.tif", "cover.tif"}) {
    const std::string mixed = writeMap(std::string("mixed_") + layer, {});
    std::filesystem::copy_file(narrow + "/layers/" + layer, mixed + "/layers/" + layer,
                               std::filesystem::copy_options::overwrite_existing);
    expectFailure({"diff", june, mixed, "-o", inFolder("out")}, 3,
                  {layer, "another grid", "380 x 300", "fuse"});
  }
  const std::string cut = writeMap("cut", {});
  std::filesystem::resize_file(cut + "/layers/surface.tif", 4000);
  expectFailure({"diff", june, cut, "-o", inFolder("out")}, 3, {"cut/layers/surface.tif"});
}

TEST_F(DiffTest, AFullDiskLeavesNothing) {
  const std::string june = writeMap("june", {});
  const auto before = entries();
  const ProgramResult result =
      runInShell("ulimit -f 20;", {"diff", june, june, "-o", inFolder("out")});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("out/height_change.tif: cannot be written"), std::string::npos)
      << result.err;
  EXPECT_EQ(entries(), before);
}

}  // namespace
}  // namespace agricolmap::test
