// The kinds of pairs that a campaign measures: simulated crops, strips of a real orthomosaic and of
// a real orthomosaic with its surface model.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/simulate/ortho.hpp"
#include "agricolmap/simulate/simulation_options.hpp"
#include "campaign_summary.hpp"

namespace agricolmap::campaign {

enum class PairSource {
  kSimulated,   ///< simulatePair
  kBeetMosaic,  ///< strips of a real sugar-beet orthomosaic with made-up heights
  kSoybean,     ///< strips of a real orthomosaic with its surface model; both real
};

struct CampaignCase {
  std::string name;
  PairSource source = PairSource::kSimulated;
  SimulationOptions options;
  Target target;
  int max_pairs = 0;  ///< 0: as many as the campaign asks for
};

/// A pair with its truth.
struct CampaignPair {
  Cloud fixed;
  Cloud moving;
  Eigen::Affine3d prior;  ///< moving file → fixed file
  Truth truth;
  bool overlaps = true;
};

/// All cases, in the order of reports. `uniform`: errors of the initial guess uniform from zero to
/// the case's, instead of always as large.
std::vector<CampaignCase> allCases(bool uniform);

/// The real data.
class RealFields {
 public:
  explicit RealFields(std::filesystem::path shared) : shared_(std::move(shared)) {}

  /// Why pairs of this source cannot be made here; empty if they can.
  std::string unavailable(PairSource source) const;
  CampaignPair beetPair(const SimulationOptions& options) const;
  CampaignPair soybeanPair(const SimulationOptions& options);

 private:
  struct Soybean {
    Cloud cloud;  ///< the whole plot as `agricolmap import` makes it
    OrthoField field;
    Eigen::Vector3d place;  ///< of the field frame's zero in file coordinates [m]
  };
  static Soybean loadSoybean(const std::filesystem::path& folder);

  std::filesystem::path shared_;
  std::optional<Soybean> soybean_;
};

/// Makes the case's pair of a seed: the same bits on any number of threads.
CampaignPair makePair(const CampaignCase& chosen, int seed, RealFields& fields);

}  // namespace agricolmap::campaign
