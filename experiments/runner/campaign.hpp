// All runs of the comparison that are not done yet: seed by seed, several children at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/datasets.hpp"
#include "runner/experiments.hpp"
#include "runner/rows.hpp"

namespace agricolmap::experiments {

struct CampaignOptions {
  std::filesystem::path program;  ///< agricolmap_method
  std::filesystem::path scratch;  ///< folder for clouds, removed afterwards
  std::filesystem::path shared;   ///< folder of the real data
  std::vector<DataSet> datasets;
  std::vector<Curve> curves;
  std::vector<std::string> methods;
  int pairs = 2;
  int first_seed = 80001;
  double time_limit = 60.0;  ///< per run [s]
  int jobs = 1;
};

/// Methods that take so long that they come last within a seed.
bool isSlow(const std::string& method);

/// Whether the method, a rigid one, leaves the whole scale error of the setting, and that alone is
/// too much: such a run is not made, and counts as a failure.
bool cannotBeRight(const std::string& method, const Cell& cell);

/// Whether setting number `next` of the curve is past hope: the method failed on all pairs of the
/// data set at the three settings before it, and on all pairs of data sets of its kind there, six
/// or more.
bool hopeless(const std::vector<Row>& rows, const Curve& curve, std::size_t next,
              const std::string& dataset, const std::string& kind, const std::string& method);

/// Throws Interrupted; what is done by then is in the table.
void runCampaign(const CampaignOptions& options, RowTable& table);

}  // namespace agricolmap::experiments
