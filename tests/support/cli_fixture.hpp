// A working folder per test, the shared simulated pairs, and what must hold after every failure.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/ply_bytes.hpp"
#include "support/program.hpp"

namespace agricolmap::test {

/// A pair as `agricolmap simulate` lays it down.
struct PairFiles {
  std::filesystem::path folder;
  std::string uav() const { return folder / "uav/point_cloud.ply"; }
  std::string ugv() const { return folder / "ugv/point_cloud.ply"; }
  std::string prior() const { return folder / "prior.txt"; }
  std::string truthPoints() const { return folder / "truth_points.ply"; }
};

class CliTest : public ::testing::Test {
 protected:
  CliTest();
  ~CliTest() override;

  /// `same_field`, `other_field` or `georeferenced`.
  static PairFiles pair(const std::string& kind = "same_field");
  std::string inFolder(const std::string& name) const { return folder_ / name; }
  /// Writes a file, with its parents, and returns its path.
  std::string write(const std::string& name, const std::string& content) const;

  /// Every file and folder below the working folder, relative to it.
  std::set<std::string> entries(const std::string& below = "") const;
  /// Runs and expects success.
  static ProgramResult run(const std::vector<std::string>& arguments);
  /// `agricolmap convert` into the working folder; returns the path of the result.
  std::string converted(const std::string& from, const std::string& name,
                        const std::vector<std::string>& options = {}) const;
  /// Runs and expects `exit_code`, all of `parts` in what stderr says, and a working folder with
  /// exactly the entries that it had before.
  void expectFailure(const std::vector<std::string>& arguments, int exit_code,
                     const std::vector<std::string>& parts) const;
  /// RMS and the rest, from `agricolmap evaluate`.
  nlohmann::json errorsOf(const std::string& transform, const PairFiles& files) const;

 private:
  std::filesystem::path folder_;
};

std::string contentOf(const std::filesystem::path& path);
nlohmann::json jsonOf(const std::filesystem::path& path);

}  // namespace agricolmap::test
