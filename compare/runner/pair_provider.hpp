// The pairs of all kinds of data sets.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "pair_maker.hpp"
#include "runner/datasets.hpp"

namespace agricolmap::compare {

class PairProvider {
 public:
  /// `shared`: folder of the real imagery that semi-real strips are cut from.
  explicit PairProvider(std::filesystem::path shared) : maker_(std::move(shared)) {}

  /// Why there are no pairs of this data set here; empty if there are.
  std::string unavailable(const DataSet& data) const;
  /// The data set's pair of a seed, its prior as exact as the truth. Of a real one the same clouds
  /// for all seeds, with the published truth as the prior. Throws InputError for clouds that cannot
  /// be used, and for a truth that lays the row beside the drone's map.
  campaign::CampaignPair make(const DataSet& data, int seed);

 private:
  campaign::CampaignPair read(const PublishedPair& pair);

  campaign::PairMaker maker_;
  // The latest drone's cloud: a crop's rows follow each other and have it in common.
  std::filesystem::path fixed_file_;
  std::shared_ptr<const Cloud> fixed_;
};

}  // namespace agricolmap::compare
