#include "experiments/runner/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "experiments/pairs/hash.hpp"

namespace agricolmap::experiments {
namespace {

constexpr std::size_t kLostSettings = 3;
constexpr std::size_t kLostRuns = 6;
constexpr double kDegree = std::numbers::pi / 180.0;

bool takesPart(const Suite& suite, const Case& chosen, const Traits& traits) {
  if (suite.matching_only && !traits.matches_points) return false;
  return !traits.needs_guess || (!chosen.told.anywhere() && !chosen.told.scale_unknown);
}

/// The curves of a suite with one method on one case.
std::vector<Chain> chainsOf(const Suite& suite, const Case& chosen, const Method& method,
                            std::uint64_t options) {
  if (suite.curves.empty()) return {{&suite, &chosen, {nullptr}, false, &method, options}};
  std::vector<Chain> chains;
  for (const Curve& curve : suite.curves) {
    Chain chain{&suite, &chosen, {}, curve.rising, &method, options};
    for (const AddedError& error : curve.errors) chain.errors.push_back(&error);
    chains.push_back(std::move(chain));
  }
  return chains;
}

/// Puts pairs of one drone's view together, views in the order of their first pair.
void groupByFlight(std::vector<Job>& jobs) {
  std::map<std::string, std::size_t> order;
  std::vector<std::pair<std::size_t, Job>> keyed;
  for (Job& job : jobs) {
    const auto at = order.emplace(job.chosen->flightText(job.seed), order.size()).first;
    keyed.emplace_back(at->second, std::move(job));
  }
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i] = std::move(keyed[i].second);
}

class Planner {
 public:
  Planner(const CampaignScope& scope, const RowTable& table) : scope_(scope), table_(table) {
    for (const Suite& suite : scope.suites) {
      for (const Case& one : suite.cases) {
        together_ = std::max(together_, one.strips_per_field);
        texts_[&one] = one.text();
      }
    }
  }

  std::vector<Job> plan() {
    int first = scope_.suites.front().first_seed;
    int end = first;
    for (const Suite& suite : scope_.suites) {
      first = std::min(first, suite.first_seed);
      end = std::max(end, suite.first_seed + suite.pairs);
    }
    std::vector<Job> jobs;
    for (int seed = first; seed < end;) {
      const int next = std::min(end, (seed / together_ + 1) * together_);
      std::vector<Job> block = jobsOf(seed, next);
      std::move(block.begin(), block.end(), std::back_inserter(jobs));
      seed = next;
    }
    return jobs;
  }

 private:
  /// The jobs of seeds from `begin` to before `end`.
  std::vector<Job> jobsOf(int begin, int end) {
    std::vector<Job> jobs;
    for (const Suite& suite : scope_.suites) {
      for (const Case& chosen : suite.cases) {
        for (int seed = begin; seed < end; ++seed) {
          if (!has(suite, chosen, seed)) continue;
          Job job = jobLeft(suite, chosen, seed);
          if (job.runs > 0) jobs.push_back(std::move(job));
        }
      }
    }
    groupByFlight(jobs);
    return jobs;
  }

  static bool has(const Suite& suite, const Case& chosen, int seed) {
    const int number = seed - suite.first_seed;
    const bool within = chosen.max_pairs == 0 || number < chosen.max_pairs;
    return number >= 0 && number < suite.pairs && within;
  }

  Job jobLeft(const Suite& suite, const Case& chosen, int seed) {
    Job job{&chosen, seed, {}};
    for (const Method& method : scope_.methods) {
      if (!takesPart(suite, chosen, method.traits)) continue;
      const std::uint64_t options = hashText(texts_[&chosen] + method.options);
      for (Chain& chain : chainsOf(suite, chosen, method, options)) {
        const auto left =
            std::count_if(chain.errors.begin(), chain.errors.end(),
                          [&](const AddedError* error) { return !isDone(chain, error, seed); });
        job.runs += static_cast<std::size_t>(left);
        if (left > 0) job.chains.push_back(std::move(chain));
      }
    }
    return job;
  }

  bool isDone(const Chain& chain, const AddedError* error, int seed) const {
    const Row planned = rowFor(scope_, chain, error, seed);
    const Row* found = table_.find(planned.key());
    if (found == nullptr) return false;
    if (found->options == planned.options) return true;
    throw InputError(
        fmt::format("{}: has a row of {}, {}, seed {}, {} that comes from other options or files "
                    "(there {}, now {}), and must not be mixed with new rows; choose another "
                    "--output",
                    table_.path().string(), planned.suite, planned.case_name, seed, planned.method,
                    found->options, planned.options));
  }

  const CampaignScope& scope_;
  const RowTable& table_;
  int together_ = 1;
  std::map<const Case*, std::string> texts_;
};

}  // namespace

Row rowFor(const CampaignScope& scope, const Chain& chain, const AddedError* error, int seed) {
  const Case& chosen = *chain.chosen;
  const simulate::GeotagOptions& geotag = chosen.options.geotag;
  Row row;
  row.suite = chain.suite->name;
  row.settings = toString(chain.suite->settings);
  row.case_name = chosen.name;
  row.dataset = chosen.dataset;
  row.kind = kindOf(chosen.source);
  row.seed = seed;
  row.setting = error == nullptr ? chosen.setting : error->setting;
  row.guess_scale = error == nullptr ? 0.0 : error->scale;
  row.field = chosen.fieldSeed(seed);
  row.guess_translation = error == nullptr ? geotag.translation : error->translation;
  row.guess_heading = error == nullptr ? geotag.heading_deg * kDegree : error->heading;
  row.told = toldText(toldFor(chain, error));
  row.method = chain.method->name;
  row.source = scope.source;
  row.options = fmt::format(
      "{:016x}", hashText(fmt::format("{:016x} {} {:g} {:g} {:g}", chain.options, row.told,
                                      row.guess_translation, row.guess_heading, row.guess_scale)));
  return row;
}

PriorUncertainty toldFor(const Chain& chain, const AddedError* error) {
  return error == nullptr ? chain.chosen->told : error->told();
}

std::vector<Job> planCampaign(const CampaignScope& scope, const RowTable& table) {
  return Planner(scope, table).plan();
}

bool cannotBeRight(const Traits& traits, const AddedError& error) {
  return traits.rigid && error.scale > evaluate::SuccessLimits{}.scale;
}

bool hopeless(const std::vector<Row>& rows, const Chain& chain, std::size_t next) {
  if (!chain.rising || next < kLostSettings) return false;
  std::size_t runs = 0;
  for (std::size_t i = next - kLostSettings; i < next; ++i) {
    const AddedError& error = *chain.errors[i];
    bool own = false;
    for (const Row& row : rows) {
      if (row.method != chain.method->name || row.suite != chain.suite->name ||
          row.kind != kindOf(chain.chosen->source) || row.guess_scale != error.scale ||
          row.setting != error.setting) {
        continue;
      }
      if (row.success()) return false;
      ++runs;
      own = own || row.case_name == chain.chosen->name;
    }
    if (!own) return false;
  }
  return runs >= kLostRuns;
}

}  // namespace agricolmap::experiments
