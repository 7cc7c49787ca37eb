// agricolmap_time_apply: wall time and memory of `agricolmap apply` on large clouds, beside copying
// their files.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/las/las_writer.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/simulate/simulate.hpp"
#include "process_cost.hpp"
#include "support/run_main.hpp"

namespace agricolmap {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string output;
  std::string program;
  std::vector<std::string> formats = {"las", "ply"};
  double points = 1e8;
  std::vector<int> threads = {2};
  int repeats = 3;
  int seed = 4242;
  double drift = 0.02;     ///< of the robot's path: what bends the strip
  std::string make_pair;   ///< be the program that writes the pair into this folder
  std::string make_cloud;  ///< be the program that writes the large cloud into this file
};

/// A pair whose strip drifts, so that there is a deformation to apply.
void writePair(const Arguments& arguments) {
  simulate::SimulationOptions simulation = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
  simulation.seed = arguments.seed;
  simulation.ugv.drift = arguments.drift;
  const simulate::SimulatedPair pair = simulate::simulatePair(simulation);
  const fs::path folder = arguments.make_pair;
  io::writePly(folder / "uav.ply", pair.uav);
  io::writePly(folder / "ugv.ply", pair.ugv);
  io::writeMatrix(folder / "prior.txt", pair.prior);
}

/// Points about the strip's place, as records: coordinates and colours, and what LAS has beside
/// them.
void writeLasCloud(const Arguments& arguments, std::size_t points) {
  io::LasOutline outline = io::lasOutline(true);
  const fs::path path = arguments.make_cloud;
  const bool laz = path.extension() == ".laz";
  io::LasWriter writer(path, outline,
                       laz ? io::LasWriter::Points::kLaz : io::LasWriter::Points::kPlain);
  Random random(static_cast<std::uint64_t>(arguments.seed));
  constexpr std::size_t kAtOnce = 100000;
  const std::size_t length = outline.layout.length;
  std::vector<std::byte> records(kAtOnce * length);
  for (std::size_t begin = 0; begin < points; begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, points - begin);
    for (std::size_t i = 0; i < count; ++i) {
      std::byte* const record = &records[i * length];
      // Along the strip, as a robot sees it, in millimetres.
      const double along =
          10.0 * static_cast<double>(begin + i) / static_cast<double>(points) - 5.0;
      outline.store({along, random.uniform(-1.0, 1.0), random.uniform(0.0, 0.3)}, record);
      io::storeLe(record + 12, static_cast<std::uint16_t>(random.below(4096)));
      io::storeLe(record + 14, std::uint8_t{0x11});
      io::storeLe(record + *outline.layout.gps_time, 1e-5 * static_cast<double>(begin + i));
      for (std::size_t c = 0; c < 3; ++c) {
        io::storeLe(record + *outline.layout.rgb + 2 * c,
                    static_cast<std::uint16_t>(257 * random.below(256)));
      }
    }
    writer.write(records.data(), count);
  }
  writer.close();
}

void writePlyCloud(const Arguments& arguments, std::size_t points) {
  Random random(static_cast<std::uint64_t>(arguments.seed));
  io::FileSink sink(fs::path(arguments.make_cloud));
  sink.write(
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
                  "property double y\nproperty double z\nproperty uchar red\nproperty uchar green\n"
                  "property uchar blue\nproperty float intensity\nend_header\n",
                  points));
  constexpr std::size_t kAtOnce = 100000;
  constexpr std::size_t kLength = 31;
  std::vector<std::byte> records(kAtOnce * kLength);
  for (std::size_t begin = 0; begin < points; begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, points - begin);
    for (std::size_t i = 0; i < count; ++i) {
      std::byte* const record = &records[i * kLength];
      io::storeLe(record,
                  10.0 * static_cast<double>(begin + i) / static_cast<double>(points) - 5.0);
      io::storeLe(record + 8, random.uniform(-1.0, 1.0));
      io::storeLe(record + 16, random.uniform(0.0, 0.3));
      for (std::size_t c = 0; c < 3; ++c)
        record[24 + c] = static_cast<std::byte>(random.below(256));
      io::storeLe(record + 27, 0.5F);
    }
    sink.write(std::span(records).first(count * kLength));
  }
  sink.close();
}

void writeCloudOf(const Arguments& arguments) {
  const auto points = static_cast<std::size_t>(arguments.points);
  if (fs::path(arguments.make_cloud).extension() == ".ply") {
    writePlyCloud(arguments, points);
  } else {
    writeLasCloud(arguments, points);
  }
}

class Measurement {
 public:
  explicit Measurement(Arguments arguments) : arguments_(std::move(arguments)) {
    if (arguments_.program.empty()) {
      arguments_.program = fs::read_symlink("/proc/self/exe").parent_path() / "agricolmap";
    }
  }

  std::string run() {
    // The system counts what a parent holds towards its children's peak memory.
    const std::string self = fs::read_symlink("/proc/self/exe");
    runProgram({self, "--make-pair", path(""), "--seed", std::to_string(arguments_.seed), "--drift",
                fmt::format("{}", arguments_.drift)},
               {0});
    runProgram({arguments_.program, "register", path("uav.ply"), path("ugv.ply"), "--prior",
                path("prior.txt"), "-o", path("run"), "-q", "--no-pictures"},
               {0});
    std::string text = "program,threads,repeat,quantity,value\n";
    for (const std::string& format : arguments_.formats) {
      const std::string cloud = path("cloud." + format);
      runProgram({self, "--make-cloud", cloud, "--points", fmt::format("{}", arguments_.points)},
                 {0});
      for (int repeat = 1; repeat <= arguments_.repeats; ++repeat) {
        text += time("cp-" + format, 1, repeat, {"cp", "--reflink=never", cloud, path("copy")});
        fs::remove(path("copy"));
        for (const int threads : arguments_.threads) {
          text += time("apply-" + format, threads, repeat,
                       {arguments_.program, "apply", path("run"), cloud, "-o", path("applied"),
                        "-q", "--threads", std::to_string(threads)});
          fs::remove_all(path("applied"));
        }
      }
      fs::remove(cloud);
    }
    return text;
  }

 private:
  std::string path(const std::string& name) const { return folder_.path() / name; }
  static std::string time(const std::string& name, int threads, int repeat,
                          const std::vector<std::string>& command) {
    ::sync();  // what was written before shall not be paid for here
    const ProcessCost cost = runProgram(command, {0});
    fmt::print("{:12} {} threads: {:.2f} s wall, {:.2f} s CPU, {:.0f} MiB\n", name, threads,
               cost.wall_s, cost.cpu_s, cost.peak_mib);
    std::fflush(stdout);
    return costLines(name, threads, repeat, cost);
  }

  Arguments arguments_;
  WorkFolder folder_;
};

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Times `agricolmap apply` on large clouds, and copying them."};
  app.name("agricolmap_time_apply");
  app.add_option("-o,--output", arguments.output, "CSV file");
  app.add_option("--agricolmap", arguments.program, "The program [beside this one]");
  app.add_option("--formats", arguments.formats, "Of las, laz and ply [las,ply]")->delimiter(',');
  app.add_option("--points", arguments.points, "Points of a cloud [1e8]");
  app.add_option("--threads", arguments.threads, "Numbers of threads [2]")->delimiter(',');
  app.add_option("--repeats", arguments.repeats, "Repeats [3]")->check(CLI::Range(1, 1000));
  app.add_option("--seed", arguments.seed, "Seed of the simulated pair [4242]");
  app.add_option("--drift", arguments.drift, "Drift of the robot's path, as a share [0.02]");
  app.add_option("--make-pair", arguments.make_pair, "Write the simulated pair there and stop");
  app.add_option("--make-cloud", arguments.make_cloud, "Write the cloud there and stop");
  return runMain(app, argc, argv, [&] {
    if (!arguments.make_pair.empty()) return writePair(arguments);
    if (!arguments.make_cloud.empty()) return writeCloudOf(arguments);
    if (arguments.output.empty()) throw UsageError("needs --output FILE; see --help");
    io::StagedFile output(arguments.output, true);
    io::writeText(output.path(), Measurement(arguments).run());
    output.commit();
  });
}

}  // namespace
}  // namespace agricolmap

int main(int argc, char** argv) { return agricolmap::run(argc, argv); }
