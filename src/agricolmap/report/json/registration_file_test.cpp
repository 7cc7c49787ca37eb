#include "agricolmap/report/json/registration_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/report/json/registration_json.hpp"
#include "agricolmap/report/test_registration.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

class RegistrationFile : public ::testing::Test {
 protected:
  RegistrationFile() {
    std::string name = (std::filesystem::temp_directory_path() / "agricolmap-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw OutputError("no temporary folder");
    folder_ = name;
    moving_.name = "ugv.ply";
    moving_.origin = {432000.0, 5200000.0, 400.0};
    moving_.xyz = {{0.0F, 0.0F, 0.0F}, {1.0F, 2.0F, 0.5F}};
    moving_.crs = {"somewhere", "PROJCS[\"somewhere\"]", 1.0, 1.0};
  }
  ~RegistrationFile() override { std::filesystem::remove_all(folder_); }

  /// A registration of a strip that bends and slipped, turned and tilted against the file.
  static pipeline::Registration bent() {
    pipeline::Registration registration = testing::testRegistration();
    Random random(4);
    const deform::Path path({{0.5, 1.0}, {3.0, 2.5}, {7.0, 2.0}});
    const deform::SplineBasis basis(path.length(), 1.25);
    deform::Bend bend{deform::Deformation(path, rotation2(0.06), basis),
                      registration.placed->pose,
                      3.0,
                      10.0,
                      0.02,
                      0.05};
    for (double& value : bend.deformation.coefficients.reshaped()) value = random.normal(0.05);
    bend.deformation.covariance =
        1e-6 * Eigen::MatrixXd::Identity(2 * basis.size() + 2, 2 * basis.size() + 2);
    bend.deformation.slips.push_back({.along = 3.3, .offset = {0.21, -0.13}});
    registration.placed->followed = pipeline::Followed{bend, registration.maps.moving};
    registration.placed->uncertainty.emplace();
    registration.placed->heights.slope = {0.013, -0.007};
    registration.maps.frames.levelled_from_moving =
        Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.1, 0.05, 1.0).normalized()) *
        Eigen::Translation3d(3.0, 4.0, -0.2);
    registration.maps.frames.levelled_from_fixed =
        Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX()) * Eigen::Translation3d(1.0, 2.0, 3.0);
    return registration;
  }

  Json jsonOf(const pipeline::Registration& registration) const {
    const Monitor monitor;
    RegistrationReportInfo info;
    info.moving_file_crs = Crs{"feet", "PROJCS[\"feet\"]", 0.3048, 1.0};
    return registrationJson(CloudStream(moving_), moving_, registration, monitor, info);
  }
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(folder_ / "registration.json") << text;
    return folder_;
  }
  void expectRefused(const std::string& text, const std::vector<std::string>& parts) const {
    try {
      readRegistration(write(text));
      ADD_FAILURE() << "no error: " << parts.front();
    } catch (const InputError& error) {
      for (const std::string& part : parts) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
            << "'" << part << "' is not in: " << error.what();
      }
    }
  }

  std::filesystem::path folder_;
  Cloud moving_;
};

TEST_F(RegistrationFile, TheDeformationIsTheSameToTheBit) {
  const pipeline::Registration registration = bent();
  const StoredRegistration stored = readRegistration(write(jsonOf(registration).dump(2)));
  EXPECT_TRUE(stored.accepted());
  ASSERT_TRUE(stored.fixed_from_moving && stored.deformation);
  EXPECT_EQ(stored.fixed_from_moving->matrix(), registration.transform->fixed_from_moving.matrix());
  EXPECT_EQ(stored.moving_origin, moving_.origin);
  EXPECT_EQ(stored.crs.wkt, moving_.crs.wkt);
  ASSERT_TRUE(stored.moving_file_crs);
  EXPECT_EQ(stored.moving_file_crs->wkt, "PROJCS[\"feet\"]");
  EXPECT_EQ(stored.moving_file_crs->horizontal_unit, 0.3048);
  const pipeline::Displacement displacement(registration, moving_);
  Random random(7);
  double largest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    // Beyond the ends of the path and far aside, too.
    const Eigen::Vector3d point =
        moving_.origin + Eigen::Vector3d(random.uniform(-8.0, 12.0), random.uniform(-8.0, 8.0),
                                         random.uniform(-1.0, 1.0));
    ASSERT_EQ(stored.deformation->at(point), displacement.at(point));
    largest = std::max(largest, displacement.at(point).norm());
  }
  EXPECT_GT(largest, 0.1);
}

TEST_F(RegistrationFile, IsFoundByItsFolderOrItsName) {
  write(jsonOf(testing::testRegistration()).dump());
  EXPECT_TRUE(readRegistration(folder_).accepted());
  const StoredRegistration stored = readRegistration(folder_ / "registration.json");
  EXPECT_FALSE(stored.deformation);
  EXPECT_THROW(readRegistration(folder_ / "nothing"), InputError);
}

TEST_F(RegistrationFile, RejectedOnesKeepTheirReasons) {
  pipeline::Registration registration = testing::testRegistration();
  registration.verdict.status = verdict::Status::kRejected;
  registration.verdict.reasons = {"too few blocks"};
  registration.transform.reset();
  const StoredRegistration stored = readRegistration(write(jsonOf(registration).dump()));
  EXPECT_EQ(stored.status, "rejected");
  EXPECT_EQ(stored.reasons, std::vector<std::string>{"too few blocks"});
  EXPECT_FALSE(stored.fixed_from_moving);
}

TEST_F(RegistrationFile, WhatIsDamagedIsNamed) {
  const Json whole = jsonOf(bent());
  const std::string text = whole.dump();
  expectRefused("", {"empty"});
  expectRefused(text.substr(0, text.size() / 2), {"registration.json", "no JSON"});
  expectRefused("[]", {"no report of a registration"});
  expectRefused("{\"format\": \"other\"}", {"no report of a registration"});
  const auto refused = [&](const char* pointer, const Json& value,
                           const std::vector<std::string>& parts) {
    Json changed = whole;
    changed[Json::json_pointer(pointer)] = value;
    expectRefused(changed.dump(), parts);
  };
  refused("/format_version", 2, {"version 2", "newer one"});
  refused("/transform/matrix", {1, 2, 3}, {"damaged", "transform.matrix", "3 rows"});
  refused("/transform/matrix/0", {1, nullptr, 3, 4}, {"transform.matrix[0][1]", "no number"});
  refused("/transform/matrix/3", {0, 0, 0, 2}, {"transform.matrix", "0 0 0 1"});
  refused("/transform/matrix/0", {0, 0, 0, 1}, {"transform.matrix", "no way"});
  refused("/transform", nullptr, {"transform", "is missing"});
  refused("/moving/origin_m", "here", {"moving.origin_m", "no list"});
  refused("/deformation/function/spans", 100000, {"deformation.function", "coefficients"});
  refused("/deformation/function/spans", 0, {"no spans"});
  refused("/deformation/function/path_m", {{1, 2}}, {"deformation.function.path_m"});
  refused("/deformation/function/coefficients_m/2", {1, 2}, {"coefficients_m[2]", "2 numbers"});
  Json older = whole;
  older["deformation"].erase("function");
  expectRefused(older.dump(), {"register the pair again"});
  older = whole;
  older.erase("moving");
  expectRefused(older.dump(), {"moving is missing"});
}

}  // namespace
}  // namespace agricolmap::report
