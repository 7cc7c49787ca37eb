// One method on one pair in one setting: files, child process, errors against the truth.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "pair_maker.hpp"
#include "runner/experiments.hpp"
#include "runner/rows.hpp"

namespace agricolmap::compare {

/// A pair in a scratch folder, with the clouds of its scale errors. All methods read these files.
class PairFiles {
 public:
  /// Writes the fixed cloud. `folder` exists and is this object's own.
  PairFiles(std::filesystem::path folder, campaign::CampaignPair pair, int seed);

  /// A moving cloud with its scale error and where it truly belongs.
  struct Moving {
    std::filesystem::path cloud_file;
    std::filesystem::path truth_file;
    Cloud cloud;
    evaluate::Truth truth;
  };
  /// The cell's; written when first asked for. Any thread.
  const Moving& moving(const Cell& cell);
  /// The cell's guess for the moving cloud of its size. Any thread.
  Eigen::Affine3d guess(const Cell& cell);
  std::filesystem::path fixedFile() const { return folder_ / "fixed.ply"; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  campaign::CampaignPair pair_;
  int seed_;
  std::mutex mutex_;
  std::map<std::string, Moving> moving_;
};

struct MethodCall {
  std::filesystem::path program;  ///< agricolmap_method
  std::string method;
  double time_limit = 60.0;  ///< killed after this [s]
};

/// A match this near to the truth is right [m]: two cells of the paper's grid map.
inline constexpr double kRightMatch = 0.04;

/// Fills in everything of the row but what it is about (data set, experiment, seed, method).
/// `name`: of the run's own files in the pair's folder.
void runMethod(const MethodCall& call, PairFiles& files, const Cell& cell, const std::string& name,
               Row& row);

}  // namespace agricolmap::compare
