#include "experiments/runner/campaign.hpp"

#include <fmt/format.h>

#include <utility>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "experiments/runner/progress.hpp"
#include "experiments/runner/run_pair.hpp"

namespace agricolmap::experiments {
namespace {

/// Works off the chains of one pair.
class PairWork {
 public:
  PairWork(const CampaignScope& scope, const Job& job, Pair pair, double make_s, RowTable& table,
           Progress& progress)
      : scope_(scope),
        job_(job),
        runs_(std::move(pair), job.seed),
        make_s_(make_s),
        table_(table),
        progress_(progress) {}

  void run(const Chain& chain) {
    std::vector<Row> known = rowsOfOtherPairs(chain);
    for (std::size_t i = 0; i < chain.errors.size(); ++i) {
      Row row = rowFor(scope_, chain, chain.errors[i], job_.seed);
      if (const Row* done = table_.find(row.key())) {
        known.push_back(*done);
        continue;
      }
      throwIfInterrupted();
      row.make_s = make_s_;
      // The limit that is in force, of all cores or fewer.
      row.threads = static_cast<int>(
          tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
      runOrSkip(chain, i, known, row);
      known.push_back(row);
      table_.append(row);
      progress_.done();
    }
  }

 private:
  std::vector<Row> rowsOfOtherPairs(const Chain& chain) const {
    std::vector<Row> rows;
    if (!chain.rising) return rows;
    for (const Row& row : table_.rows()) {
      const bool other = row.case_name != chain.chosen->name || row.seed != job_.seed;
      if (other && row.method == chain.method->name) rows.push_back(row);
    }
    return rows;
  }

  void runOrSkip(const Chain& chain, std::size_t i, const std::vector<Row>& known, Row& row) {
    const AddedError* error = chain.errors[i];
    if (error != nullptr && cannotBeRight(chain.method->traits, *error)) {
      row.status = "skipped";
      row.message = "rigid";
    } else if (hopeless(known, chain, i)) {
      row.status = "skipped";
      row.message = "lost at smaller errors";
    } else {
      runs_.run(*chain.method, {chain.suite->name, error, toldFor(chain, error)}, row);
    }
  }

  const CampaignScope& scope_;
  const Job& job_;
  PairRuns runs_;
  double make_s_;
  RowTable& table_;
  Progress& progress_;
};

}  // namespace

bool runCampaign(const CampaignScope& scope, double stop_after, PairMaker& maker, RowTable& table) {
  const std::vector<Job> jobs = planCampaign(scope, table);
  const Stopwatch watch;
  std::size_t runs_left = 0;
  for (const Job& job : jobs) runs_left += job.runs;
  Progress progress(runs_left);
  for (const Job& job : jobs) {
    if (stop_after > 0.0 && watch.seconds() > stop_after) return false;
    throwIfInterrupted();
    progress.now(fmt::format("{} seed {}", job.chosen->name, job.seed));
    const Stopwatch making;
    Pair pair = maker.make(*job.chosen, job.seed);
    PairWork work(scope, job, std::move(pair), making.seconds(), table, progress);
    for (const Chain& chain : job.chains) work.run(chain);
  }
  return true;
}

}  // namespace agricolmap::experiments
