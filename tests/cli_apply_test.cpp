// A registration applied to clouds, as a user meets it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

class ApplyTest : public CliTest {
 protected:
  /// Registers into the folder "run".
  std::string registered(const std::string& fixed, const std::string& moving,
                         std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"register", fixed, moving, "--no-pictures", "--overwrite", "--quiet",
                               "-o", inFolder("run")});
    run(more);
    return inFolder("run");
  }
  /// Applies "run" to clouds and returns the folder with the results.
  std::string applied(const std::vector<std::string>& clouds,
                      const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments{"apply", inFolder("run"), "-o", inFolder("applied"),
                                       "--overwrite"};
    arguments.insert(arguments.end(), clouds.begin(), clouds.end());
    arguments.insert(arguments.end(), options.begin(), options.end());
    run(arguments);
    return inFolder("applied");
  }
  void expectSame(const std::string& one, const std::string& other) const {
    EXPECT_TRUE(contentOf(one) == contentOf(other)) << one << " and " << other;
  }
  nlohmann::json report() const { return jsonOf(inFolder("run/registration.json")); }

  /// The robot's cloud, its path bent to both sides by 6 cm.
  std::string bent(const std::string& from) const {
    auto points = pointsOfPly(contentOf(from));
    std::array<double, 2> middle{};
    for (const PlyPoint& point : points) {
      for (std::size_t i = 0; i < 2; ++i) {
        middle[i] += point.xyz[i] / static_cast<double>(points.size());
      }
    }
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const PlyPoint& point : points) {
      const double x = point.xyz[0] - middle[0], y = point.xyz[1] - middle[1];
      xx += x * x;
      xy += x * y;
      yy += y * y;
    }
    const double heading = 0.5 * std::atan2(2.0 * xy, xx - yy);
    for (PlyPoint& point : points) {
      const double along = (point.xyz[0] - middle[0]) * std::cos(heading) +
                           (point.xyz[1] - middle[1]) * std::sin(heading);
      const double aside = 0.06 * std::sin(std::numbers::pi * along / 3.0);
      point.xyz[0] -= aside * std::sin(heading);
      point.xyz[1] += aside * std::cos(heading);
    }
    return write("bent.ply", plyBytes(points));
  }
};

TEST_F(ApplyTest, TheCloudThatWasRegisteredBecomesTheAlignedOne) {
  const PairFiles files = pair("georeferenced");
  const std::string uav = converted(files.uav(), "uav.las", {"--crs", "EPSG:32632"});
  for (const bool bend : {false, true}) {
    const std::string ply = bend ? bent(files.ugv()) : files.ugv();
    registered(uav, ply);
    ASSERT_EQ(report().at("deformation").is_null(), !bend);
    expectSame(applied({ply}) + (bend ? "/bent.ply" : "/point_cloud.ply"),
               inFolder("run/aligned.ply"));
    // In another format than its own: as register writes it.
    registered(uav, ply, {"--aligned-format", "pcd"});
    applied({ply}, {"--format", "pcd"});
    expectSame(inFolder(bend ? "applied/bent.pcd" : "applied/point_cloud.pcd"),
               inFolder("run/aligned.pcd"));
    const std::string las = converted(ply, "ugv.las", {"--crs", "EPSG:32632", "--overwrite"});
    registered(uav, las);
    ASSERT_EQ(report().at("deformation").is_null(), !bend);
    expectSame(applied({las}) + "/ugv.las", inFolder("run/aligned.las"));
  }
}

TEST_F(ApplyTest, WithoutHeightsTheBendInThePlaneIsStatedAndApplied) {
  const PairFiles files = pair("georeferenced");
  const auto flat = [&](const std::string& from, const std::string& name) {
    auto points = pointsOfPly(contentOf(from));
    for (PlyPoint& point : points) point.xyz[2] = 0.0;
    return write(name, plyBytes(points));
  };
  const std::string strip = flat(bent(files.ugv()), "strip.ply");
  registered(flat(files.uav(), "field.ply"), strip);
  const nlohmann::json deformation = report().at("deformation");
  ASSERT_FALSE(deformation.is_null());
  for (const nlohmann::json& node : deformation.at("nodes")) {
    const nlohmann::json& deviation = node.at("deviation_m");
    ASSERT_TRUE(deviation.at(0).is_number() && deviation.at(1).is_number()) << deviation;
    EXPECT_GT(deviation.at(0).get<double>(), 0.0);
    EXPECT_LT(deviation.at(0).get<double>(), 0.05);
    EXPECT_TRUE(deviation.at(2).is_null()) << deviation;
  }
  expectSame(applied({strip}) + "/strip.ply", inFolder("run/aligned.ply"));
}

TEST_F(ApplyTest, WhatWasReprojectedIsReprojectedAgain) {
  const PairFiles files = pair("georeferenced");
  const std::string uav = converted(files.uav(), "uav.las", {"--crs", "EPSG:32632"});
  const std::string there =
      converted(bent(files.ugv()), "there.las", {"--crs", "EPSG:32632", "--to-crs", "EPSG:32633"});
  registered(uav, there);
  EXPECT_EQ(report().at("moving").at("file_crs").at("name"), "WGS 84 / UTM zone 33N");
  ASSERT_FALSE(report().at("deformation").is_null());
  expectSame(applied({there}) + "/there.las", inFolder("run/aligned.las"));

  // One that does not say is taken to be where MOVING was; one that says elsewhere comes from
  // there.
  const std::string silent = converted(there, "silent.ply");
  const std::string here = converted(there, "here.las", {"--to-crs", "EPSG:32632"});
  const ProgramResult result = runAgricolmap(
      {"apply", inFolder("run"), silent, here, "-o", inFolder("applied"), "--overwrite"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("taken as that of the cloud that was registered"), std::string::npos)
      << result.err;
  const auto aligned = pointsOfPly(contentOf(converted(inFolder("run/aligned.las"), "a.ply")));
  const auto from_silent = pointsOfPly(contentOf(inFolder("applied/silent.ply")));
  const auto from_here = pointsOfPly(contentOf(converted(inFolder("applied/here.las"), "h.ply")));
  ASSERT_EQ(from_silent.size(), aligned.size());
  ASSERT_EQ(from_here.size(), aligned.size());
  for (std::size_t i = 0; i < aligned.size(); i += 97) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(from_silent[i].xyz[axis], aligned[i].xyz[axis], 0.0011);
      ASSERT_NEAR(from_here[i].xyz[axis], aligned[i].xyz[axis], 0.0021);
    }
  }
}

TEST_F(ApplyTest, SeveralCloudsAndFormatsAtOnce) {
  const PairFiles files = pair("georeferenced");
  registered(files.uav(), files.ugv());
  const std::string las = converted(files.ugv(), "part.las");
  const std::string pcd = converted(files.ugv(), "part.pcd");
  const ProgramResult one = run(
      {"apply", inFolder("run"), las, pcd, files.ugv(), "-o", inFolder("one"), "--threads", "1"});
  EXPECT_EQ(entries("one"), (std::set<std::string>{"part.las", "part.pcd", "point_cloud.ply"}));
  EXPECT_NE(one.out.find("one/part.las: "), std::string::npos) << one.out;
  applied({las, pcd, files.ugv()});
  for (const std::string name : {"part.las", "part.pcd", "point_cloud.ply"}) {
    expectSame(inFolder("one/" + name), inFolder("applied/" + name));
  }
  run({"apply", inFolder("run/registration.json"), pcd, "-o", inFolder("las"), "--format", "las"});
  EXPECT_EQ(entries("las"), std::set<std::string>{"part.las"});
}

TEST_F(ApplyTest, LinesOfTextBecomePly) {
  const PairFiles files = pair("georeferenced");
  registered(files.uav(), files.ugv());
  std::string lines;
  for (const PlyPoint& point : pointsOfPly(contentOf(files.ugv()))) {
    for (const double value : point.xyz) lines += std::to_string(value) + " ";
    lines += "90 80 70\n";
  }
  applied({write("lines.xyz", lines), files.ugv()});
  const auto text = pointsOfPly(contentOf(inFolder("applied/lines.xyz.ply")));
  const auto ply = pointsOfPly(contentOf(inFolder("applied/point_cloud.ply")));
  ASSERT_EQ(text.size(), ply.size());
  for (std::size_t i = 0; i < ply.size(); i += 97) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(text[i].xyz[axis], ply[i].xyz[axis], 2e-5);
    }
  }
}

TEST_F(ApplyTest, WhatCannotBeAppliedIsRefused) {
  const PairFiles files = pair("georeferenced");
  registered(files.uav(), files.ugv());
  const std::string cloud = files.ugv();
  const auto refused = [&](const std::string& folder, const std::string& json, int code,
                           const std::vector<std::string>& parts) {
    write(folder + "/registration.json", json);
    expectFailure({"apply", inFolder(folder), cloud, "-o", inFolder("none/deep")}, code, parts);
  };
  nlohmann::json rejected = report();
  rejected["status"] = "rejected";
  rejected["reasons"] = {"it fits nowhere"};
  refused("rejected", rejected.dump(), 3, {"rejected", "it fits nowhere", "--force"});
  run({"apply", inFolder("rejected"), cloud, "-o", inFolder("forced"), "--force"});
  rejected["transform"] = nullptr;
  refused("nowhere", rejected.dump(), 3, {"no answer", "it fits nowhere"});
  const std::string whole = report().dump();
  refused("cut", whole.substr(0, whole.size() / 2), 3, {"cut/registration.json", "damaged"});
  nlohmann::json newer = report();
  newer["format_version"] = 2;
  refused("newer", newer.dump(), 3, {"newer/registration.json", "version 2"});
  expectFailure({"apply", inFolder("empty"), cloud, "-o", inFolder("none")}, 3, {"register"});

  const auto fails = [&](const std::vector<std::string>& more, int code,
                         const std::vector<std::string>& parts) {
    std::vector<std::string> arguments{"apply", inFolder("run")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expectFailure(arguments, code, parts);
  };
  fails({cloud, "-o", inFolder("none"), "--format", "e57"}, 2, {"--format e57"});
  fails({cloud, cloud, "-o", inFolder("none")}, 2, {"both would become point_cloud.ply"});
  const std::string own = write("own/cloud.ply", contentOf(cloud));
  fails({own, "-o", inFolder("own"), "--overwrite"}, 2, {"own/cloud.ply", "overwritten"});
  fails({own, "-o", inFolder("own")}, 2, {"overwritten"});
  fails({cloud, "-o", inFolder("run")}, 4, {"not empty", "--overwrite"});
  fails({inFolder("gone.las"), "-o", inFolder("none")}, 3, {"gone.las"});
  const std::string raster = write("ortho.tif", std::string("II*\0\x08\0\0\0", 8));
  fails({raster, "-o", inFolder("none")}, 3,
        {"ortho.tif: is a raster", "agricolmap convert " + raster + " points.laz"});
  fails({raster + "," + raster, "-o", inFolder("none")}, 3, {"convert " + raster + " " + raster});
  // The second is damaged: nothing is left of the first.
  const std::string damaged = write("damaged.ply", contentOf(cloud).substr(0, 5000));
  fails({cloud, damaged, "-o", inFolder("none")}, 3, {"damaged.ply", "truncated"});
  auto far = pointsOfPly(contentOf(cloud));
  for (PlyPoint& point : far) point.xyz[1] *= 3.2808;
  const std::string feet = write("feet.ply", plyBytes(far));
  fails({feet, "-o", inFolder("none")}, 3, {"feet.ply", "units"});
  fails({cloud, "-o", inFolder("none"), "--crs", "EPSG:4326"}, 3,
        {"WGS 84", "does not say its coordinate system"});
}

}  // namespace
}  // namespace agricolmap::test
