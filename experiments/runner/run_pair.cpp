#include "runner/run_method.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "runner/child_process.hpp"

namespace agricolmap::experiments {
namespace {

// The share of the time limit after which methods that can stop are asked to: the rest is for
// reading the clouds, which the limit covers, too.
constexpr double kSoftShare = 0.85;

std::string firstLine(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

Eigen::Affine3d matrixOf(const nlohmann::json& rows) {
  Eigen::Affine3d matrix;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      matrix.matrix()(r, c) =
          rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c)).get<double>();
    }
  }
  return matrix;
}

evaluate::RegistrationErrors noErrors() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  evaluate::RegistrationErrors errors;
  errors.rms = errors.rms_horizontal = errors.rms_vertical = errors.worst = nan;
  errors.rms_to_best_affine = errors.translation = errors.rotation = errors.scale = nan;
  return errors;
}

void fillFromJson(const nlohmann::json& json, const PairFiles::Moving& moving, Row& row) {
  row.status = json.at("status").get<std::string>();
  row.note = json.at("why").get<std::string>();
  row.accepted = row.status == "accepted";
  row.run_s = json.at("run_s").get<double>();
  row.peak_mib = json.at("peak_memory_mib").get<double>();
  row.idle_mib = json.at("idle_memory_mib").get<double>();
  for (const auto& [stage, seconds] : json.at("stages_s").items()) {
    row.stages +=
        fmt::format("{}{}={:.4f}", row.stages.empty() ? "" : ";", stage, seconds.get<double>());
  }
  for (const auto& [name, counts] : {std::pair{"matches", &row.first}, {"rematches", &row.last}}) {
    if (!json.contains(name)) continue;
    counts->matches = json[name].at("count").get<double>();
    counts->coherent = json[name].at("inliers").get<double>();
    counts->right = json[name].at("right").get<double>();
  }
  if (json.at("fixed_from_moving").is_null()) return;
  row.errors = evaluate::evaluateTransform(matrixOf(json.at("fixed_from_moving")), moving.truth,
                                           moving.cloud);
  row.correct = row.errors.within({});
}

}  // namespace

PairFiles::PairFiles(std::filesystem::path folder, Pair pair, int seed)
    : folder_(std::move(folder)), pair_(std::move(pair)), seed_(seed) {
  io::writePly(fixedFile(), *pair_.fixed);
}

const PairFiles::Moving& PairFiles::moving(const Cell& cell) {
  const std::lock_guard lock(mutex_);
  const std::string key = fmt::format("{:.4g}", cell.scale);
  const auto known = moving_.find(key);
  if (known != moving_.end()) return known->second;
  const Eigen::Affine3d scaled = scaleError(cell, seed_, pair_.moving);
  Moving made{folder_ / fmt::format("moving_{}.ply", key),
              folder_ / fmt::format("truth_{}.txt", key), pair_.moving, pair_.truth};
  transformCloud(made.cloud, scaled);
  made.truth.best_affine = pair_.truth.best_affine * scaled.inverse();
  io::writePly(made.cloud_file, made.cloud);
  io::writeMatrix(made.truth_file, made.truth.best_affine, "truth, moving file -> fixed file");
  return moving_.emplace(key, std::move(made)).first->second;
}

Eigen::Affine3d PairFiles::guess(const Cell& cell) {
  // The guess takes the file's lengths at face value; the middle is where it was.
  return wrongGuess(cell, seed_, pair_.moving, pair_.prior);
}

void runMethod(const MethodCall& call, PairFiles& files, const Cell& cell,
               const std::string& name, Row& row) {
  const PairFiles::Moving& moving = files.moving(cell);
  const std::filesystem::path guess = files.folder() / (name + ".guess.txt");
  const std::filesystem::path result = files.folder() / (name + ".json");
  const std::filesystem::path log = files.folder() / (name + ".log");
  io::writeMatrix(guess, files.guess(cell), "initial guess, moving file -> fixed file");
  const ChildResult child = runChild(
      {call.program.string(), call.method, files.fixedFile().string(), moving.cloud_file.string(),
       "--guess", guess.string(), "--true-transform", moving.truth_file.string(), "--prior-sigma",
       cell.priorText(), "--inlier-tolerance", fmt::format("{}", kRightMatch), "--time-limit",
       fmt::format("{:.3f}", kSoftShare * call.time_limit), "--threads", "1", "--overwrite", "-o",
       result.string()},
      call.time_limit, log);
  row.errors = noErrors();
  row.wall_s = child.wall_s;
  row.cpu_s = child.cpu_s;
  const bool answered = child.exit_code == 0 || child.exit_code == 10;
  if (child.timed_out) {
    row.status = "timeout";
    row.peak_mib = child.peak_mib;
    row.note = fmt::format("ended after {:.0f} s", call.time_limit);
  } else if (answered) {
    std::ifstream file(result);
    fillFromJson(nlohmann::json::parse(file), moving, row);
  } else if (child.exit_code > 1) {
    // Bad usage or input is a fault of the comparison, not of the method.
    throw InputError(fmt::format("agricolmap_method {}: {}", call.method, firstLine(log)));
  } else {
    row.status = "crashed";
    row.note = child.signal != 0 ? fmt::format("signal {}", child.signal) : firstLine(log);
  }
  for (const std::filesystem::path& path : {guess, result, log}) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
}

}  // namespace agricolmap::experiments
