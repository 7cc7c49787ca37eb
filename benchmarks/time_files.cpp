// agricolmap_time_files: wall time and memory of `agricolmap register` from files to files, and of
// reading and gridding alone beside it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/simulate/simulate.hpp"
#include "process_cost.hpp"
#include "support/exit_code.hpp"
#include "support/run_main.hpp"

namespace agricolmap {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string output;
  std::string program;
  std::string fixed;
  std::string moving;
  std::string prior;
  std::vector<int> threads = {1, 2};
  std::string preset = "default";
  int repeats = 3;
  int seed = 4242;
  bool baseline = false;  ///< be the program that reads and grids
  std::string make_pair;  ///< be the program that writes the pair into this folder
};

/// Writes a pair of about 2 and 1 million points with the largest guess errors.
void writePair(int seed, const fs::path& folder) {
  simulate::SimulationOptions simulation = simulate::cropPreset(simulate::Crop::kSoybean);
  simulation.seed = seed;
  simulation.geotag.translation = 5.0;
  simulation.geotag.heading_deg = 11.5;
  simulation.geotag.scale = 0.3;
  const simulate::SimulatedPair pair = simulate::simulatePair(simulation);
  io::writePly(folder / "uav.ply", pair.uav);
  io::writePly(folder / "ugv.ply", pair.ugv);
  io::writeMatrix(folder / "prior.txt", pair.prior);
}

/// The same in a process of its own: the system counts what a parent holds towards its children's
/// peak memory.
void makePair(Arguments& arguments, const fs::path& folder) {
  runProgram({fs::read_symlink("/proc/self/exe").string(), "--make-pair", folder.string(), "--seed",
              std::to_string(arguments.seed)},
             {0});
  arguments.fixed = folder / "uav.ply";
  arguments.moving = folder / "ugv.ply";
  arguments.prior = folder / "prior.txt";
}

/// What every program of this kind must do at least: read both files and lay all points into maps.
void readAndGrid(const Arguments& arguments) {
  const ThreadLimit limit(arguments.threads.front());
  const pipeline::RegistrationOptions options = pipeline::preset("default");
  Cloud clouds[2];
  parallelFor(2, [&](std::size_t i) {
    clouds[i] = io::readCloud(i == 0 ? arguments.fixed : arguments.moving);
  });
  for (const Cloud& cloud : clouds) {
    const map::Levelling level = map::levelCloud(cloud, Eigen::Affine3d::Identity(), options.level);
    map::Box2 box;
    for (const Eigen::Vector3f& p : cloud.xyz) {
      box.extend((level.levelled_from_guess * p.cast<double>()).head<2>().eval());
    }
    const map::GridMap map = map::makeGridMap(cloud, level.levelled_from_guess, box, options.grid);
    if (map.filled == 0) throw InputError(cloud.name + ": no cell is filled");
  }
}

std::string timeRegister(const Arguments& arguments, const fs::path& folder, int threads,
                         int repeat) {
  const fs::path results = folder / "results";
  std::vector<std::string> command = {arguments.program,
                                      "register",
                                      arguments.fixed,
                                      arguments.moving,
                                      "-o",
                                      results.string(),
                                      "--preset",
                                      arguments.preset,
                                      "--threads",
                                      std::to_string(threads),
                                      "-q",
                                      "--overwrite",
                                      "--no-pictures"};
  if (!arguments.prior.empty()) command.insert(command.end(), {"--prior", arguments.prior});
  const ProcessCost cost = runProgram(command, {0, static_cast<int>(ExitCode::kRejected)});
  const std::string name = "register-" + arguments.preset;
  std::string lines = costLines(name, threads, repeat, cost);
  std::ifstream file(results / "registration.json");
  const nlohmann::ordered_json report = nlohmann::ordered_json::parse(file);
  for (const auto& [stage, seconds] : report.at("times").at("stages").items()) {
    lines += fmt::format("{},{},{},stage_{},{:.4f}\n", name, threads, repeat, stage,
                         seconds.get<double>());
  }
  fmt::print("{:18} {} threads: {:.2f} s wall, {:.2f} s CPU, {:.0f} MiB\n", name, threads,
             cost.wall_s, cost.cpu_s, cost.peak_mib);
  return lines;
}

std::string timeBaseline(const Arguments& arguments, int threads, int repeat) {
  const ProcessCost cost = runProgram(
      {fs::read_symlink("/proc/self/exe").string(), "--baseline", "--fixed", arguments.fixed,
       "--moving", arguments.moving, "--threads", std::to_string(threads)},
      {0});
  fmt::print("{:18} {} threads: {:.2f} s wall, {:.2f} s CPU, {:.0f} MiB\n", "read-and-grid",
             threads, cost.wall_s, cost.cpu_s, cost.peak_mib);
  return costLines("read-and-grid", threads, repeat, cost);
}

void measure(Arguments arguments) {
  if (arguments.fixed.empty() != arguments.moving.empty()) {
    throw UsageError("--fixed and --moving belong together");
  }
  io::StagedFile output(arguments.output, true);
  if (arguments.program.empty()) {
    arguments.program = fs::read_symlink("/proc/self/exe").parent_path() / "agricolmap";
  }
  const WorkFolder folder;
  if (arguments.fixed.empty()) makePair(arguments, folder.path());
  std::string text = "program,threads,repeat,quantity,value\n";
  for (int repeat = 1; repeat <= arguments.repeats; ++repeat) {
    for (const int threads : arguments.threads) {
      text += timeBaseline(arguments, threads, repeat);
      text += timeRegister(arguments, folder.path(), threads, repeat);
    }
  }
  io::writeText(output.path(), text);
  output.commit();
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Times `agricolmap register` from files to files."};
  app.name("agricolmap_time_files");
  app.add_option("-o,--output", arguments.output, "CSV file");
  app.add_option("--agricolmap", arguments.program, "The program [beside this one]");
  app.add_option("--fixed", arguments.fixed, "Fixed cloud [a simulated pair]");
  app.add_option("--moving", arguments.moving, "Moving cloud");
  app.add_option("--prior", arguments.prior, "Initial guess");
  app.add_option("--threads", arguments.threads, "Numbers of threads [1,2]")->delimiter(',');
  app.add_option("--preset", arguments.preset, "Preset [default]");
  app.add_option("--repeats", arguments.repeats, "Repeats [3]")->check(CLI::Range(1, 1000));
  app.add_option("--seed", arguments.seed, "Seed of the simulated pair [4242]");
  app.add_flag("--baseline", arguments.baseline, "Read and grid --fixed and --moving and stop");
  app.add_option("--make-pair", arguments.make_pair, "Write the simulated pair there and stop");
  return runMain(app, argc, argv, [&] {
    if (arguments.baseline) return readAndGrid(arguments);
    if (!arguments.make_pair.empty()) return writePair(arguments.seed, arguments.make_pair);
    if (arguments.output.empty()) throw UsageError("needs --output FILE; see --help");
    measure(arguments);
  });
}

}  // namespace
}  // namespace agricolmap

int main(int argc, char** argv) { return agricolmap::run(argc, argv); }
