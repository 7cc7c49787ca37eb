// `agricolmap simulate --ortho`: pairs from real mosaics, here made up by the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/io/raster/raster_test_support.hpp"
#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

constexpr double kEast = 734000.0;
constexpr double kNorth = 4489000.0;

/// Repeatable noise in [0, 1).
double hash(int a, int b) {
  const double value = std::sin(12.9898 * a + 78.233 * b) * 43758.5453;
  return value - std::floor(value);
}

/// Height of a plant above the ground at metres from the south-west corner: plants of different
/// sizes along rows that run east, some missing.
double plantAt(double x, double y) {
  const int row = static_cast<int>(std::floor(y / 0.5));
  const int first = static_cast<int>(std::floor(x / 0.18));
  double highest = 0.0;
  for (int i = first - 1; i <= first + 1; ++i) {
    if (hash(i, row) < 0.2) continue;
    const double size = 0.06 + 0.06 * hash(i, row + 1000);
    const double dx = x - 0.18 * (i + 0.3 + 0.4 * hash(i, row + 2000));
    const double dy = y - 0.5 * (row + 0.5) - 0.06 * (hash(i, row + 3000) - 0.5);
    highest = std::max(highest, size * (1.0 - (dx * dx + dy * dy) / (size * size)));
  }
  return highest;
}

class OrthoTest : public CliTest {
 protected:
  /// `width` × `height` m of 1.5 cm pixels in UTM.
  std::string writeMosaic(const std::string& name, double width, double height,
                          bool georeferenced = true) const {
    Sheet sheet = sheetOf(width, height, 0.015);
    sheet.georeferenced = georeferenced;
    if (!georeferenced) sheet.epsg = 0;
    sheet.value = [height](int band, int col, int row) {
      const bool plant = plantAt(0.015 * (col + 0.5), height - 0.015 * (row + 0.5)) > 0.01;
      const double shade = 30.0 * hash(col, row) - 15.0;
      const double colours[2][3] = {{125.0, 105.0, 90.0}, {65.0, 125.0, 50.0}};
      return colours[plant ? 1 : 0][band] + shade;
    };
    return writeSheet(inFolder(name), sheet);
  }
  /// Heights above 300 m, of a coarser raster that reaches further.
  std::string writeModel(const std::string& name, double width, double height, bool plants,
                         double east = 0.0) const {
    Sheet sheet = sheetOf(width + 2.0, height + 2.0, 0.02);
    sheet.place[0] += east - 1.0;
    sheet.place[3] -= 1.0;
    sheet.bands = 1;
    sheet.type = GDT_Float32;
    sheet.value = [=](int, int col, int row) {
      const double x = 0.02 * (col + 0.5) - 1.0;
      const double y = height + 1.0 - 0.02 * (row + 0.5);
      return 300.0 + 0.01 * x + (plants ? plantAt(x, y) : 0.0);
    };
    return writeSheet(inFolder(name), sheet);
  }

  static std::vector<std::string> simulate(const std::vector<std::string>& more) {
    std::vector<std::string> all = {"simulate", "--crop", "sugar_beet_10m", "--ugv.length", "6"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  static Sheet sheetOf(double width, double height, double pixel) {
    Sheet sheet;
    sheet.cols = static_cast<int>(std::lround(width / pixel));
    sheet.rows = static_cast<int>(std::lround(height / pixel));
    sheet.place = {kEast, pixel, 0.0, kNorth + height, 0.0, -pixel};
    return sheet;
  }
};

TEST_F(OrthoTest, APairWithASurfaceModelRegistersToTheTruth) {
  const std::string ortho = writeMosaic("ortho.tif", 11.0, 8.0);
  const std::string dsm = writeModel("dsm.tif", 11.0, 8.0, true);
  const std::string dtm = writeModel("dtm.tif", 11.0, 8.0, false);
  const ProgramResult made = runAgricolmap(
      simulate({"--ortho", ortho, "--dsm", dsm, "--dtm", dtm, "-o", inFolder("pair")}));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find("the rows run at"), std::string::npos) << made.err;
  EXPECT_EQ(entries("pair"), (std::set<std::string>{
                                 "pair.png", "prior.txt", "simulation.yaml", "truth.txt",
                                 "truth_points.ply", "uav", "uav/offset.xyz", "uav/point_cloud.ply",
                                 "ugv", "ugv/offset.xyz", "ugv/path.txt", "ugv/point_cloud.ply"}));
  const PairFiles files{inFolder("pair")};
  const PlyPoint first = pointsOfPly(contentOf(files.uav())).front();
  EXPECT_NEAR(first.xyz[0], kEast, 0.5);
  EXPECT_NEAR(first.xyz[1], kNorth, 0.5);
  EXPECT_NEAR(first.xyz[2], 300.0, 0.5);

  const ProgramResult result =
      runAgricolmap({"register", files.uav(), files.ugv(), "-o", inFolder("out"), "--no-pictures"});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const nlohmann::json errors = errorsOf(inFolder("out/transform.txt"), files);
  EXPECT_LT(errors.at("rms_m").get<double>(), 0.03) << errors.dump();

  // What it wrote down makes the same pair again.
  const std::string record = contentOf(files.folder / "simulation.yaml");
  EXPECT_EQ(record.rfind("# Made from --ortho " + ortho + " --dsm " + dsm + " --dtm " + dtm +
                             " --window 0 0 733 533",
                         0),
            0U)
      << record.substr(0, 300);
  ASSERT_EQ(
      runAgricolmap({"simulate", "--config", files.folder / "simulation.yaml", "--ortho", ortho,
                     "--dsm", dsm, "--dtm", dtm, "--no-pictures", "-o", inFolder("again")})
          .exit_code,
      0);
  EXPECT_EQ(contentOf(inFolder("again/ugv/point_cloud.ply")) == contentOf(files.ugv()), true);
}

TEST_F(OrthoTest, APictureNeedsTheSizeOfItsPixels) {
  const std::string picture = writeMosaic("picture.tif", 9.0, 9.0, false);
  expectFailure(simulate({"--ortho", picture, "-o", inFolder("pair")}), 3, {picture, "--gsd"});
  const ProgramResult made =
      runAgricolmap(simulate({"--ortho", picture, "--gsd", "0.015", "--window", "20", "30", "550",
                              "500", "--row_heading", "0", "-o", inFolder("pair")}));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find("--window 20 30 550 500"), std::string::npos) << made.err;
  expectFailure(simulate({"--ortho", picture, "--gsd", "0.015", "--window", "20", "30", "590",
                          "500", "-o", inFolder("other")}),
                3, {picture, "window", "600 x 600"});
}

TEST_F(OrthoTest, FilesThatCannotBeUsedAreNamed) {
  const std::string none = inFolder("none.tif");
  const std::string ortho = writeMosaic("ortho.tif", 9.0, 7.0);
  const std::string beside = writeModel("beside.tif", 9.0, 7.0, true, 500.0);
  const std::string out = inFolder("pair");
  expectFailure(simulate({"--ortho", none, "-o", out}), 3, {none});
  expectFailure(simulate({"--ortho", ortho, "--dsm", none, "-o", out}), 3, {none});
  expectFailure(simulate({"--ortho", ortho, "--dsm", beside, "-o", out}), 3,
                {ortho, beside, "same field"});
  expectFailure(simulate({"--ortho", ortho, "--gsd", "0.03", "-o", out}), 3, {ortho, "--gsd"});
  expectFailure({"simulate", "--ugv.length", "12", "--ortho", ortho, "-o", out}, 3,
                {ortho, "ugv.length"});
}

TEST_F(OrthoTest, FlagsThatWouldDoNothingAreRefused) {
  const std::string out = inFolder("pair");
  expectFailure({"simulate", "--dsm", "dsm.tif", "-o", out}, 2, {"--ortho"});
  expectFailure({"simulate", "--gsd", "0.01", "-o", out}, 2, {"--ortho"});
  expectFailure({"simulate", "--row_heading", "30", "-o", out}, 2, {"--ortho"});
  expectFailure({"simulate", "--ortho", "o.tif", "--field.row_spacing", "0.5", "-o", out}, 2,
                {"field.row-spacing", "--ortho"});
  expectFailure({"simulate", "--ortho", "o.tif", "--field.plots.length", "5", "-o", out}, 2,
                {"field.plots.length", "--ortho"});
  expectFailure({"simulate", "--ortho", "o.tif", "--views.ripening", "1", "-o", out}, 2,
                {"views.ripening", "--ortho"});
  expectFailure({"simulate", "--ortho", "o.tif", "--dsm", "d.tif", "--field.slope", "0", "-o", out},
                2, {"field.slope", "surface model"});
  expectFailure({"simulate", "--ortho", "o.tif", "--window", "1", "2", "3", "-o", out}, 2,
                {"--window"});
}

TEST_F(OrthoTest, ASecondDateRegistersToAFirst) {
  const std::string ortho = writeMosaic("first.tif", 14.0, 9.0);
  const std::string dsm = writeModel("dsm.tif", 14.0, 9.0, true);
  // The same plants, seen 3 cm east and 2 cm north of where they are.
  Sheet strip = sheetOf(11.0, 3.0, 0.015);
  strip.place = {kEast + 1.53, 0.015, 0.0, kNorth + 6.02, 0.0, -0.015};
  strip.value = [](int band, int col, int row) {
    const bool plant = plantAt(1.5 + 0.015 * (col + 0.5), 6.0 - 0.015 * (row + 0.5)) > 0.01;
    const double colours[2][3] = {{125.0, 105.0, 90.0}, {65.0, 125.0, 50.0}};
    return colours[plant ? 1 : 0][band] + 30.0 * hash(col + 7, row) - 15.0;
  };
  const std::string second = writeSheet(inFolder("second.tif"), strip);
  for (const std::string& fixed : {ortho, ortho + "," + dsm}) {
    const ProgramResult result =
        runAgricolmap({"register", fixed, second, "-o", inFolder("out"), "--no-pictures",
                       "--overwrite", "--prior-sigma", "0.5,2,2"});
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_NE(result.err.find("laid flat"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("coordinate system"), std::string::npos) << result.err;
    const nlohmann::json report = jsonOf(inFolder("out/registration.json"));
    EXPECT_EQ(report.at("fixed").at("crs").at("name"), "WGS 84 / UTM zone 32N");
    const auto& matrix = report.at("transform").at("matrix");
    const std::array<double, 3> middle{kEast + 7.0, kNorth + 4.5, 0.0};
    for (std::size_t row = 0; row < 2; ++row) {
      double there = matrix[row][3].get<double>() - middle[row];
      for (std::size_t col = 0; col < 3; ++col) {
        there += matrix[row][col].get<double>() * middle[col];
      }
      EXPECT_NEAR(there, row == 0 ? -0.03 : -0.02, 0.01);
    }
  }
}

TEST_F(OrthoTest, RastersAreToldAndConverted) {
  const std::string ortho = writeMosaic("ortho.tif", 3.0, 2.0);
  const std::string dsm = writeModel("dsm.tif", 3.0, 2.0, true);
  expectFailure({"register", ortho, dsm, "-o", inFolder("out")}, 3,
                {"dsm.tif", "no colours", "ORTHO.tif,DSM.tif"});
  const ProgramResult info = runAgricolmap({"info", ortho + "," + dsm});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("UTM zone 32N"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("points     26600"), std::string::npos) << info.out;
  for (const std::vector<std::string>& from : {std::vector{ortho + "," + dsm}, {ortho, dsm}}) {
    std::vector<std::string> words{"convert", "--quiet", "--overwrite"};
    words.insert(words.end(), from.begin(), from.end());
    words.push_back(inFolder("map.las"));
    EXPECT_EQ(runAgricolmap(words).exit_code, 0);
    expectFailure({"convert", ortho, inFolder("map.las"), inFolder("both.las")}, 3,
                  {"map.las: is a cloud", "GeoTIFF"});
    const ProgramResult las = runAgricolmap({"info", inFolder("map.las")});
    EXPECT_NE(las.out.find("UTM zone 32N"), std::string::npos) << las.out;
    EXPECT_NE(las.out.find("z          300."), std::string::npos) << las.out;
  }
  expectFailure({"info", ortho + ",none.tif"}, 3, {"none.tif", "surface model"});
  expectFailure({"convert", ortho + "," + ortho, inFolder("x.las")}, 3, {ortho, "picture"});
}

// GDAL decodes in threads of its own, whose messages are not caught by those who called it.
TEST_F(OrthoTest, NoLineOfALibraryReachesTheTerminal) {
  Sheet sheet = sheetOf(9.0, 9.0, 0.015);
  sheet.compress = "DEFLATE";
  sheet.value = [](int band, int col, int row) { return 100.0 + 20.0 * hash(col + band, row); };
  const std::string whole = contentOf(writeSheet(inFolder("whole.tif"), sheet));
  std::string damaged = whole;
  for (std::size_t i = whole.size() / 3; i < whole.size() / 3 + 3000; ++i) damaged[i] ^= 0x5A;
  for (const std::string& content : {damaged, whole.substr(0, whole.size() / 2)}) {
    const ProgramResult result = runAgricolmap({"info", write("bad.tif", content)});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err.rfind("agricolmap: ", 0), 0U) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

}  // namespace
}  // namespace agricolmap::test
