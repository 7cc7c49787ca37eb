// Makes the pairs of all kinds of cases, keeping the drone's view of a field while strips of it are
// asked for.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/simulate/ortho/ortho.hpp"
#include "experiments/pairs/cases.hpp"

namespace agricolmap::experiments {

/// A pair with its truth.
struct Pair {
  std::shared_ptr<const Cloud> fixed;
  Cloud moving;
  Eigen::Affine3d guess;  ///< moving file → fixed file
  evaluate::Truth truth;
  bool overlaps = true;
  std::vector<Eigen::Vector3d> slips;  ///< where the odometry slipped, fixed file [m]
};

class PairMaker {
 public:
  /// `shared`: folder of the imagery that semi-real strips are cut from.
  explicit PairMaker(std::filesystem::path shared) : shared_(std::move(shared)) {}

  /// Why pairs of this case cannot be made here; empty if they can.
  std::string unavailable(const Case& chosen) const;
  /// The case's pair of a seed: the same bits on any number of threads and in any order. Of a
  /// published one the same clouds for all seeds, with the truth as the guess; throws InputError
  /// for clouds that cannot be used, and for a truth that lays the row beside the drone's map.
  Pair make(const Case& chosen, int seed);

 private:
  struct Soybean {
    std::shared_ptr<const Cloud> cloud;  ///< the whole plot as `agricolmap import` makes it
    simulate::OrthoField field;
    Eigen::Vector3d place;  ///< of the field frame's zero in file coordinates [m]
  };
  /// Makes `field_` or `ortho_` the drone's view of this pair.
  void fly(const Case& chosen, int seed, const simulate::SimulationOptions& options);
  Pair soybeanPair(const simulate::SimulationOptions& options, int strip);
  simulate::OrthoField readBeets(int seed) const;
  simulate::OrthoField readAllBeets() const;
  void loadSoybean();
  Pair readPublished(const PublishedPair& pair);
  Pair datePair(const DatePair& dates, const simulate::SimulationOptions& options);
  Pair readGenerated(const std::filesystem::path& folder);
  /// Makes `fixed_` what `read` gives, unless it is of this file already.
  template <typename Read>
  void keepFixed(const std::filesystem::path& file, const Read& read);

  std::filesystem::path shared_;
  std::optional<Soybean> soybean_;
  // The latest drone's view, of one of two kinds.
  std::shared_ptr<const simulate::SimulatedField> field_;
  std::shared_ptr<const simulate::SimulatedOrtho> ortho_;
  std::string flown_;  ///< Case::flightText of it
  // The latest drone's cloud: a crop's rows follow each other and have it in common.
  std::filesystem::path fixed_file_;
  std::shared_ptr<const Cloud> fixed_;
};

}  // namespace agricolmap::experiments
