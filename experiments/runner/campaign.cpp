#include "experiments/runner/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "experiments/runner/progress.hpp"

namespace agricolmap::experiments {
namespace {

/// Works off the chains of one pair, several at a time.
class Batch {
 public:
  Batch(const CampaignScope& scope, const Job& job, double make_s, PairRuns& runs, RowTable& table,
        Progress& progress)
      : scope_(scope),
        job_(job),
        make_s_(make_s),
        runs_(runs),
        table_(table),
        progress_(progress),
        earlier_(table.rows().size()) {}

  void run(int jobs, int threads_each) {
    threads_each_ = threads_each;
    std::vector<std::thread> threads;
    for (int i = 1; i < jobs; ++i) {
      threads.emplace_back([this, stop = stopOfScope()] {
        const StopScope scope(stop);
        work();
      });
    }
    work();
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
    throwIfInterrupted();
  }

 private:
  void work() {
    try {
      while (true) {
        std::size_t mine = 0;
        {
          const std::lock_guard lock(mutex_);
          if (error_ || next_ >= job_.chains.size()) return;
          mine = next_++;
        }
        runChain(job_.chains[mine], fmt::format("run{}", mine));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
  }

  void runChain(const Chain& chain, const std::string& name) {
    std::vector<Row> known = earlierRows(chain);
    for (std::size_t i = 0; i < chain.errors.size(); ++i) {
      Row row = rowFor(scope_, chain, chain.errors[i], job_.seed);
      if (const std::optional<Row> done = doneRow(row.key())) {
        known.push_back(*done);
        continue;
      }
      row.make_s = make_s_;
      row.threads = threads_each_;
      runOrSkip(chain, i, known, name, row);
      known.push_back(row);
      const std::lock_guard lock(mutex_);
      table_.append(row);
      progress_.done();
    }
  }

  /// What other pairs showed, as it was before this one: the same on any number of threads.
  std::vector<Row> earlierRows(const Chain& chain) {
    std::vector<Row> rows;
    if (!chain.rising) return rows;
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < earlier_; ++i) {
      const Row& row = table_.rows()[i];
      const bool other = row.case_name != chain.chosen->name || row.seed != job_.seed;
      if (other && row.method == chain.method->name) rows.push_back(row);
    }
    return rows;
  }

  void runOrSkip(const Chain& chain, std::size_t i, const std::vector<Row>& known,
                 const std::string& name, Row& row) {
    const AddedError* error = chain.errors[i];
    if (error != nullptr && cannotBeRight(chain.method->traits, *error)) {
      row.status = "skipped";
      row.message = "rigid";
    } else if (hopeless(known, chain, i)) {
      row.status = "skipped";
      row.message = "lost at smaller errors";
    } else {
      runs_.run(*chain.method, {chain.suite->name, error, toldFor(chain, error)}, name, row);
    }
  }

  std::optional<Row> doneRow(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const Row* found = table_.find(key);
    return found == nullptr ? std::nullopt : std::optional<Row>(*found);
  }

  const CampaignScope& scope_;
  const Job& job_;
  double make_s_;
  PairRuns& runs_;
  RowTable& table_;
  Progress& progress_;
  std::size_t earlier_;  ///< rows that were there before this pair
  int threads_each_ = 0;
  std::mutex mutex_;
  std::size_t next_ = 0;
  std::exception_ptr error_;
};

/// A folder that goes when the pair does.
class ScratchFolder {
 public:
  explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
    std::filesystem::create_directories(path_, error);
    if (error) {
      throw OutputError(fmt::format("{}: cannot be made: {}", path_.string(), error.message()));
    }
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

 private:
  std::filesystem::path path_;
};

}  // namespace

bool runCampaign(const CampaignScope& scope, const CampaignOptions& options, PairMaker& maker,
                 RowTable& table) {
  const std::vector<Job> jobs = planCampaign(scope, table);
  const Stopwatch watch;
  std::size_t runs_left = 0;
  for (const Job& job : jobs) runs_left += job.runs;
  Progress progress(runs_left);
  // In process the limit that is in force, of all cores or fewer.
  const int threads_each = options.runs.in_process
                               ? static_cast<int>(tbb::global_control::active_value(
                                     tbb::global_control::max_allowed_parallelism))
                               : options.runs.threads;
  for (const Job& job : jobs) {
    if (options.stop_after > 0.0 && watch.seconds() > options.stop_after) return false;
    throwIfInterrupted();
    progress.now(fmt::format("{} seed {}", job.chosen->name, job.seed));
    std::optional<ScratchFolder> scratch;
    if (!options.runs.in_process) scratch.emplace(options.scratch);
    const Stopwatch making;
    Pair pair = maker.make(*job.chosen, job.seed);
    const double make_s = making.seconds();
    PairRuns runs(std::move(pair), job.seed, options.runs, options.scratch);
    Batch(scope, job, make_s, runs, table, progress).run(options.jobs, threads_each);
  }
  return true;
}

}  // namespace agricolmap::experiments
