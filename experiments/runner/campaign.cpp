#include "runner/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "runner/pair_provider.hpp"
#include "runner/progress.hpp"
#include "runner/run_method.hpp"

namespace agricolmap::experiments {
namespace {

constexpr std::size_t kLostSettings = 3;
constexpr std::size_t kLostRuns = 6;

/// A curve of one method on one pair, worked off setting by setting, so that what comes next can
/// depend on what came before.
struct Chain {
  const Curve* curve;
  std::string method;
};

Row rowFor(const DataSet& data, const Cell& cell, int seed, const std::string& method) {
  Row row;
  row.dataset = data.name;
  row.kind = toString(data.kind);
  row.experiment = cell.experiment;
  row.scale = cell.scale;
  row.setting = cell.setting;
  row.seed = seed;
  row.method = method;
  return row;
}

/// One pair and the chains that are not complete on it.
class Batch {
 public:
  Batch(const CampaignOptions& options, const DataSet& data, int seed, bool slow, RowTable& table)
      : options_(&options), data_(&data), seed_(seed), table_(&table) {
    for (const Curve& curve : options.curves) {
      for (const std::string& method : options.methods) {
        if (isSlow(method) != slow || !takesPart(method, curve.experiment)) continue;
        if (left(curve, method) > 0) chains_.push_back({&curve, method});
      }
    }
  }
  bool empty() const { return chains_.empty(); }

  void run(PairFiles& files, Progress& progress) {
    // What other pairs showed, as it was before this one: the same on any number of threads.
    earlier_ = table_->rows();
    std::vector<std::thread> threads;
    for (int i = 0; i < options_->jobs; ++i) {
      threads.emplace_back([&] { work(files, progress); });
    }
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
    throwIfInterrupted();
  }

 private:
  std::size_t left(const Curve& curve, const std::string& method) const {
    return static_cast<std::size_t>(
        std::count_if(curve.cells.begin(), curve.cells.end(), [&](const Cell& cell) {
          return table_->find(rowFor(*data_, cell, seed_, method).key()) == nullptr;
        }));
  }

  void work(PairFiles& files, Progress& progress) {
    try {
      while (true) {
        std::size_t mine = 0;
        {
          const std::lock_guard lock(mutex_);
          if (error_ || next_ >= chains_.size()) return;
          mine = next_++;
        }
        runChain(mine, files, progress);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
  }

  void runChain(std::size_t number, PairFiles& files, Progress& progress) {
    const Chain& chain = chains_[number];
    std::vector<Row> known;
    for (const Row& row : earlier_) {
      const bool other = row.dataset != data_->name || row.seed != seed_;
      if (row.method == chain.method && other) known.push_back(row);
    }
    for (std::size_t i = 0; i < chain.curve->cells.size(); ++i) {
      const Cell& cell = chain.curve->cells[i];
      Row row = rowFor(*data_, cell, seed_, chain.method);
      const auto done = doneRow(row.key());
      if (done) {
        known.push_back(*done);
        continue;
      }
      if (cannotBeRight(chain.method, cell)) {
        row.status = "skipped";
        row.note = "rigid";
      } else if (chain.curve->rising &&
                 hopeless(known, *chain.curve, i, row.dataset, row.kind, row.method)) {
        row.status = "skipped";
        row.note = "lost at smaller errors";
      } else {
        runMethod({options_->program, chain.method, options_->time_limit}, files, cell,
                  fmt::format("run{}", number), row);
      }
      known.push_back(row);
      const std::lock_guard lock(mutex_);
      table_->append(row);
      progress.done(row);
    }
  }

  std::optional<Row> doneRow(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const Row* found = table_->find(key);
    return found == nullptr ? std::nullopt : std::optional<Row>(*found);
  }

  const CampaignOptions* options_;
  const DataSet* data_;
  int seed_;
  RowTable* table_;
  std::vector<Chain> chains_;
  std::vector<Row> earlier_;
  std::mutex mutex_;
  std::size_t next_ = 0;
  std::exception_ptr error_;
};

/// A folder that goes when the batch does.
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
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

bool isSlow(const std::string& method) { return method.starts_with("go-icp"); }

bool cannotBeRight(const std::string& method, const Cell& cell) {
  const bool rigid = method == "go-icp" || method == "fpfh-gicp";
  return rigid && cell.scale > evaluate::SuccessLimits{}.scale;
}

bool hopeless(const std::vector<Row>& rows, const Curve& curve, std::size_t next,
              const std::string& dataset, const std::string& kind, const std::string& method) {
  if (next < kLostSettings) return false;
  std::size_t runs = 0;
  for (std::size_t i = next - kLostSettings; i < next; ++i) {
    const Cell& cell = curve.cells[i];
    bool own = false;
    for (const Row& row : rows) {
      if (row.method != method || row.kind != kind || row.experiment != cell.experiment ||
          row.scale != cell.scale || row.setting != cell.setting) {
        continue;
      }
      if (row.success()) return false;
      ++runs;
      own = own || row.dataset == dataset;
    }
    if (!own) return false;
  }
  return runs >= kLostRuns;
}

void runCampaign(const CampaignOptions& options, RowTable& table) {
  PairProvider provider(options.shared);
  Progress progress(options, table);
  for (int seed = options.first_seed; seed < options.first_seed + options.pairs; ++seed) {
    for (const bool slow : {false, true}) {
      for (const DataSet& data : options.datasets) {
        Batch batch(options, data, seed, slow, table);
        if (batch.empty()) continue;
        throwIfInterrupted();
        progress.now(data.name, seed);
        const ScratchFolder scratch(options.scratch);
        PairFiles files(scratch.path(), provider.make(data, seed), seed);
        batch.run(files, progress);
      }
    }
  }
}

}  // namespace agricolmap::experiments
