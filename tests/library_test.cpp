// The library as its users have it: the public headers and the shared libraries, without the flags
// that they were built with.
#include <gtest/gtest.h>

#include <agricolmap/error.hpp>
#include <agricolmap/io.hpp>
#include <agricolmap/options.hpp>
#include <agricolmap/register.hpp>
#include <agricolmap/report.hpp>
#include <agricolmap/version.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace agricolmap {
namespace {

const std::filesystem::path kPairs = AGRICOLMAP_PAIRS;

/// A folder of this test's own, made anew.
std::filesystem::path freshFolder(const std::string& name) {
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / ("library_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

struct Pair {
  Cloud fixed;
  Cloud moving;
  Transform guess;
};

Pair readPair(const std::string& kind) {
  const std::filesystem::path folder = kPairs / kind;
  return {readCloud(folder / "uav/point_cloud.ply"), readCloud(folder / "ugv/point_cloud.ply"),
          readMatrix(folder / "prior.txt")};
}

template <typename Expected, typename Call>
void expectError(const Call& call, const std::string& part, ErrorKind kind) {
  try {
    call();
    ADD_FAILURE() << "no error; expected: " << part;
  } catch (const Expected& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    EXPECT_EQ(error.kind(), kind);
  }
}

TEST(Version, IsThatOfTheProject) { EXPECT_STREQ(version(), AGRICOLMAP_EXPECTED_VERSION); }

TEST(Options, AreSetAndReadByName) {
  Options options;
  options.set("grid.cell", "0.03");
  EXPECT_EQ(options.get("grid.cell"), "0.03");
  options.set("grid.cell", 0.04);
  EXPECT_EQ(options.get("grid.cell"), "0.04");
  options.set("geometry_only", 1.0);
  EXPECT_EQ(options.get("geometry_only"), "true");
  options.set("geometry_only", "false");
  EXPECT_EQ(options.get("geometry_only"), "false");
  options.set("dense.hops", 2);
  EXPECT_EQ(options.get("dense.hops"), "2");
}

TEST(Options, AreValues) {
  Options one;
  Options two = one;
  two.set("grid.cell", 0.04);
  EXPECT_NE(one.get("grid.cell"), two.get("grid.cell"));
  one = two;
  EXPECT_EQ(one.get("grid.cell"), "0.04");
}

TEST(Options, RefuseWhatMakesNoSenseAndKeepWhatTheyHad) {
  Options options;
  const std::string before = options.get("grid.cell");
  expectError<UsageError>([&] { options.set("grid.cel", 0.03); }, "grid.cell", ErrorKind::kUsage);
  expectError<UsageError>([&] { options.set("grid.cell", -1.0); }, "grid.cell", ErrorKind::kUsage);
  expectError<UsageError>([&] { options.set("grid.cell", "wide"); }, "wide", ErrorKind::kUsage);
  expectError<UsageError>([&] { options.set("geometry_only", 2.0); }, "geometry_only",
                          ErrorKind::kUsage);
  expectError<UsageError>([&] { options.set("dense.hops", 1.5); }, "whole", ErrorKind::kUsage);
  expectError<UsageError>([&] { options.set("grid.cell", std::nan("")); }, "nan",
                          ErrorKind::kUsage);
  expectError<UsageError>([&] { options.get("nothing.like.it"); }, "nothing.like.it",
                          ErrorKind::kUsage);
  expectError<UsageError>([] { Options("no-such-preset"); }, "no-such-preset", ErrorKind::kUsage);
  EXPECT_EQ(options.get("grid.cell"), before);
}

TEST(Options, ListEverythingThatCanBeSet) {
  Options options;
  std::set<std::string> names;
  for (const OptionInfo& info : options.list()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.help.empty()) << info.name;
    EXPECT_FALSE(info.limits.empty()) << info.name;
    EXPECT_EQ(options.get(info.name), info.default_value);
    options.set(info.name, info.default_value);
  }
  EXPECT_TRUE(names.contains("grid.cell"));
  for (const std::string& preset : Options::presets()) EXPECT_NO_THROW(Options{preset});
}

TEST(Options, TellTheKindsAndLimitsOfValues) {
  const std::vector<OptionInfo> infos = Options("paper").list();
  const auto find = [&](const std::string& name) {
    return *std::find_if(infos.begin(), infos.end(),
                         [&](const OptionInfo& info) { return info.name == name; });
  };
  EXPECT_EQ(find("grid.cell").kind, OptionInfo::Kind::kNumber);
  EXPECT_EQ(find("grid.cell").low, 0.005);
  EXPECT_EQ(find("grid.cell").high, 1.0);
  EXPECT_EQ(find("seed").kind, OptionInfo::Kind::kInteger);
  EXPECT_EQ(find("geometry_only").kind, OptionInfo::Kind::kFlag);
  EXPECT_EQ(find("refine").kind, OptionInfo::Kind::kChoice);
  EXPECT_EQ(find("refine").choices, (std::vector<std::string>{"dense", "cpd"}));
  EXPECT_EQ(Options("paper").preset(), "paper");
}

TEST(Options, KnowThePrior) {
  Options options;
  EXPECT_EQ(options.prior().translation_m, 5.0);
  options.setPrior({.translation_m = 2.0, .heading_deg = 4.0, .scale = 0.1, .scale_unknown = true});
  EXPECT_EQ(options.prior().translation_m, 2.0);
  EXPECT_EQ(options.prior().heading_deg, 4.0);
  EXPECT_EQ(options.prior().scale, 0.1);
  EXPECT_TRUE(options.prior().scale_unknown);
  EXPECT_FALSE(options.prior().anywhere);
  EXPECT_THROW(options.setPrior({.scale = 0.9}), UsageError);
  EXPECT_EQ(options.prior().scale, 0.1);
  options.setPrior({.anywhere = true});
  EXPECT_TRUE(options.prior().anywhere);
}

TEST(Options, GoToAFileAndBack) {
  const std::filesystem::path folder = freshFolder("options");
  Options options("paper");
  options.set("grid.cell", 0.031);
  options.save(folder / "options.yaml");
  Options read;
  read.load(folder / "options.yaml");
  for (const OptionInfo& info : options.list()) {
    EXPECT_EQ(read.get(info.name), options.get(info.name)) << info.name;
  }
  expectError<InputError>([&] { read.load(folder / "none.yaml"); }, "none.yaml", ErrorKind::kInput);
  expectError<OutputError>([&] { read.save(folder / "none/options.yaml"); }, "none",
                           ErrorKind::kOutput);
  std::ofstream(folder / "wrong.yaml") << "grid:\n  cel: 1\n";
  expectError<UsageError>([&] { read.load(folder / "wrong.yaml"); }, "wrong.yaml",
                          ErrorKind::kUsage);
}

TEST(MakeCloud, KeepsMillimetresFarFromZeroAndLeavesOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector3d> points = {
      {500000.123, 5000000.456, 100.789}, {nan, 0.0, 0.0}, {500001.25, 5000002.5, 101.0}};
  const std::vector<Rgb> colours = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const Cloud cloud = makeCloud(points, colours, "mine");
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.name, "mine");
  EXPECT_EQ(cloud.dropped_points, 1U);
  EXPECT_LT((cloud.filePoint(0) - points[0]).norm(), 1e-6);
  EXPECT_LT((cloud.filePoint(1) - points[2]).norm(), 1e-6);
  EXPECT_EQ(cloud.rgb[1], colours[2]);
  EXPECT_TRUE(makeCloud(points).rgb.empty());
}

TEST(MakeCloud, RefusesWhatIsNoCloud) {
  const std::vector<Eigen::Vector3d> points(3, Eigen::Vector3d::Zero());
  const std::vector<Rgb> colours(2);
  expectError<UsageError>([&] { makeCloud(points, colours, "mine"); }, "2 colours for 3 points",
                          ErrorKind::kUsage);
  expectError<InputError>([] { makeCloud({}, {}, "mine"); }, "mine", ErrorKind::kInput);
  const std::vector<Eigen::Vector3d> lost(3, Eigen::Vector3d::Constant(std::nan("")));
  expectError<InputError>([&] { makeCloud(lost, {}, "mine"); }, "mine", ErrorKind::kInput);
}

TEST(Files, GoOutAndComeBack) {
  const std::filesystem::path folder = freshFolder("files");
  const std::vector<Eigen::Vector3d> points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.5}};
  const std::vector<Rgb> colours = {{1, 2, 3}, {4, 5, 6}};
  const Cloud cloud = makeCloud(points, colours);
  Transform moved = Transform::Identity();
  moved.translation() = Eigen::Vector3d(10.0, 0.0, 0.0);
  moved.linear() *= 2.0;
  writePly(folder / "cloud.ply", cloud);
  writePly(folder / "moved.ply", cloud, moved);
  writeMatrix(folder / "moved.txt", moved);
  EXPECT_EQ(readCloud(folder / "cloud.ply").filePoint(1), points[1]);
  EXPECT_EQ(readCloud(folder / "moved.ply").filePoint(1), moved * points[1]);
  EXPECT_EQ(readMatrix(folder / "moved.txt").matrix(), moved.matrix());
  EXPECT_FALSE(readOffsetBeside(folder / "cloud.ply"));
  std::ofstream(folder / "cloud.offset.xyz") << "1 2 3\n";
  ASSERT_TRUE(readOffsetBeside(folder / "cloud.ply"));
  EXPECT_EQ(readOffsetBeside(folder / "cloud.ply")->translation(), Eigen::Vector3d(1, 2, 3));
  expectError<InputError>([&] { readCloud(folder / "none.ply"); }, "none.ply", ErrorKind::kInput);
  expectError<OutputError>([&] { writePly(folder / "none/cloud.ply", cloud); }, "none",
                           ErrorKind::kOutput);
}

TEST(Files, AreWrittenInTheFormatThatTheirNameEndsWith) {
  const std::filesystem::path folder = freshFolder("formats");
  const std::vector<Eigen::Vector3d> points = {{500000.5, 1.0, 2.0}, {500001.25, 2.0, 3.0}};
  const std::vector<Rgb> colours = {{1, 2, 3}, {4, 5, 6}};
  const Cloud cloud = makeCloud(points, colours);
  for (const char* const name : {"cloud.ply", "cloud.pcd", "cloud.las"}) {
    writeCloud(folder / name, cloud, Transform(Eigen::Translation3d(0.0, 1.0, 0.0)));
    const Cloud read = readCloud(folder / name);
    ASSERT_EQ(read.size(), 2U) << name;
    EXPECT_LT((read.filePoint(1) - Eigen::Vector3d(500001.25, 3.0, 3.0)).norm(), 1e-6) << name;
    EXPECT_EQ(read.rgb[1], colours[1]) << name;
  }
  expectError<UsageError>([&] { writeCloud(folder / "cloud.stl", cloud); }, "las",
                          ErrorKind::kUsage);
}

TEST(RegisterClouds, FindsThePlaceAndSaysHowSureItIs) {
  Pair pair = readPair("same_field");
  pair.moving.warnings = {"the robot's file is odd"};
  std::vector<std::string> stages;
  Control control;
  control.threads = 1;
  control.on_stage = [&](std::string_view stage) { stages.emplace_back(stage); };
  const Registration result = registerClouds(pair.fixed, pair.moving, pair.guess, {}, control);
  ASSERT_TRUE(result.accepted()) << result.reasons.front();
  const Transform truth = readMatrix(kPairs / "same_field/truth.txt");
  double worst = 0.0;
  for (std::size_t i = 0; i < pair.moving.size(); i += 1000) {
    const Eigen::Vector3d point = pair.moving.filePoint(i);
    worst = std::max(worst, (*result.fixed_from_moving * point - truth * point).norm());
  }
  EXPECT_LT(worst, 0.05);
  EXPECT_GT(result.plane_probability, 0.8);
  ASSERT_TRUE(result.heights);
  EXPECT_TRUE(result.heights->measured) << result.heights->words;
  EXPECT_LT(result.heights->deviation_m, 0.045);
  EXPECT_TRUE(result.heights->limit.empty());
  ASSERT_TRUE(result.parts);
  EXPECT_GT(result.parts->shift_m.norm(), 0.5);
  EXPECT_NEAR(std::abs(result.parts->heading_deg), 2.0, 1.0);
  ASSERT_TRUE(result.uncertainty);
  EXPECT_GT(result.uncertainty->expected_rms_m, 0.0);
  EXPECT_LT(result.uncertainty->expected_rms_m, 0.05);
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::DontAlign>> covariance(
      result.uncertainty->covariance.data());
  EXPECT_TRUE(covariance.isApprox(covariance.transpose()));
  EXPECT_GT(covariance.diagonal().minCoeff(), 0.0);
  EXPECT_GT(result.evidence.blocks, 4U);
  EXPECT_LE(result.evidence.agreeing_blocks, result.evidence.blocks);
  EXPECT_GT(result.evidence.uniqueness, 1.2);
  EXPECT_FALSE(stages.empty());
  EXPECT_FALSE(result.times.empty());
  EXPECT_EQ(result.warnings, pair.moving.warnings);
}

TEST(RegisterClouds, TakesThePathOfTheRobot) {
  const Pair pair = readPair("same_field");
  // From corner to corner.
  const auto [west, east] =
      std::minmax_element(pair.moving.xyz.begin(), pair.moving.xyz.end(),
                          [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const std::filesystem::path file = freshFolder("path") / "path.txt";
  std::ofstream out(file);
  out.precision(12);
  for (const auto& end : {*west, *east}) {
    out << (end.cast<double>() + pair.moving.origin).transpose() << "\n";
  }
  out.close();
  const std::vector<Eigen::Vector3d> path = readPath(file);
  ASSERT_EQ(path.size(), 2U);
  const Registration result = registerClouds(pair.fixed, pair.moving, pair.guess, {}, {}, path);
  EXPECT_TRUE(result.accepted());
  EXPECT_EQ(result.warnings, pair.moving.warnings);
  const Registration by_flow =
      registerClouds(pair.fixed, pair.moving, pair.guess, Options("paper"), {}, path);
  ASSERT_FALSE(by_flow.warnings.empty());
  EXPECT_NE(by_flow.warnings.front().find("the path makes no difference"), std::string::npos);
  std::ofstream(file) << "one place\n";
  expectError<InputError>([&] { readPath(file); }, "path.txt", ErrorKind::kInput);
}

TEST(RegisterClouds, RejectsAnotherField) {
  const Pair pair = readPair("other_field");
  const Registration result = registerClouds(pair.fixed, pair.moving, pair.guess);
  EXPECT_EQ(result.status, Registration::Status::kRejected);
  EXPECT_STREQ(toString(result.status), "rejected");
  EXPECT_FALSE(result.reasons.empty());
}

TEST(RegisterClouds, RefusesCloudsThatAreNotWhole) {
  const std::vector<Eigen::Vector3d> points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  const Cloud bare = makeCloud(points, {}, "bare");
  const auto run = [&](const Cloud& cloud) {
    return [&] { registerClouds(cloud, bare, Transform::Identity()); };
  };
  Cloud half = bare;
  half.rgb = {Rgb{}, Rgb{}};
  expectError<InputError>(run(half), "2 colours for 3 points", ErrorKind::kInput);
  Cloud lost = bare;
  lost.xyz[1].z() = std::numeric_limits<float>::infinity();
  expectError<InputError>(run(lost), "not finite", ErrorKind::kInput);
  expectError<InputError>(run(bare), "no colours", ErrorKind::kInput);
}

TEST(RegisterClouds, RefusesOptionsThatWouldDoNothing) {
  const Pair pair = readPair("same_field");
  Options options;
  options.set("cpd.outlier_share", 0.3);
  expectError<UsageError>([&] { registerClouds(pair.fixed, pair.moving, pair.guess, options); },
                          "cpd.outlier_share = 0.3 would do nothing", ErrorKind::kUsage);
}

TEST(RegisterClouds, StopsWhenItIsToldToAndNoOtherDoes) {
  const Pair pair = readPair("same_field");
  std::stop_source stop;
  Control stopped;
  stopped.stop = stop.get_token();
  stopped.on_stage = [&](std::string_view stage) {
    if (stage == "locate") stop.request_stop();
  };
  auto other = std::async(std::launch::async, [&] {
    return registerClouds(pair.fixed, pair.moving, pair.guess).status;
  });
  expectError<Interrupted>(
      [&] { registerClouds(pair.fixed, pair.moving, pair.guess, {}, stopped); }, "interrupted",
      ErrorKind::kInterrupted);
  EXPECT_EQ(other.get(), Registration::Status::kAccepted);
}

TEST(Report, IsThatOfTheCommandLine) {
  const std::filesystem::path folder = freshFolder("report");
  const Pair pair = readPair("same_field");
  Options options;
  options.set("verdict.min_probability", 0.7);
  const Registration result = registerClouds(pair.fixed, pair.moving, pair.guess, options);
  const std::vector<std::string> pictures = writePictures(folder, result);
  ASSERT_FALSE(pictures.empty());
  for (const std::string& picture : pictures) {
    EXPECT_GT(std::filesystem::file_size(folder / picture), 1000U) << picture;
  }
  writeReport(folder, result, pictures);
  const nlohmann::json report = nlohmann::json::parse(std::ifstream(folder / "registration.json"));
  EXPECT_EQ(report["status"], toString(result.status));
  EXPECT_EQ(report["version"], version());
  EXPECT_EQ(report["preset"], "default");
  EXPECT_EQ(report["pictures"], pictures);
  EXPECT_EQ(report["plane_probability"], result.plane_probability);
  EXPECT_EQ(report["heights"]["status"], result.heights->measured ? "measured" : "limited");
  EXPECT_EQ(report["heights"]["deviation_m"], result.heights->deviation_m);
  EXPECT_EQ(report["transform"]["matrix"][0][3], result.fixed_from_moving->matrix()(0, 3));
  EXPECT_EQ(report["uncertainty"]["covariance"][3][5], result.uncertainty->covariance[23]);
  EXPECT_EQ(report["options"]["verdict"]["min_probability"], 0.7);
}

TEST(Report, NeedsARegistration) {
  EXPECT_THROW(writeReport(freshFolder("none"), Registration()), UsageError);
  EXPECT_THROW(writePictures(freshFolder("none"), Registration()), UsageError);
}

}  // namespace
}  // namespace agricolmap
