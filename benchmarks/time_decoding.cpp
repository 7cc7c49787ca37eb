// agricolmap_time_decoding FILE.laz: how fast points come out of LAZ, beside LASzip alone on as
// many threads, each with a reader of its own for its share of the file.
#include <fmt/format.h>
#include <laszip/laszip_api.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <ctime>
#include <thread>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "support/run_main.hpp"

namespace agricolmap {
namespace {

/// Reads one of `shares` of the file's points; their number, or 0 where LASzip fails.
std::uint64_t readShare(const std::string& path, std::int64_t share, std::int64_t shares) {
  laszip_POINTER reader = nullptr;
  if (laszip_create(&reader) != 0) return 0;
  laszip_BOOL compressed = 0;
  laszip_header* header = nullptr;
  std::uint64_t read = 0;
  if (laszip_open_reader(reader, path.c_str(), &compressed) == 0 &&
      laszip_get_header_pointer(reader, &header) == 0) {
    const auto points = std::max(static_cast<laszip_I64>(header->number_of_point_records),
                                 static_cast<laszip_I64>(header->extended_number_of_point_records));
    const laszip_I64 begin = points * share / shares;
    const laszip_I64 end = points * (share + 1) / shares;
    if (laszip_seek_point(reader, begin) == 0) {
      while (static_cast<laszip_I64>(read) < end - begin && laszip_read_point(reader) == 0) ++read;
    }
    laszip_close_reader(reader);
  }
  laszip_destroy(reader);
  return read;
}

/// By the clock, and of all threads together.
struct Seconds {
  double wall = 0.0;
  double cpu = 0.0;
};

template <typename Work>
Seconds secondsOf(const Work& work) {
  const Stopwatch watch;
  const std::clock_t before = std::clock();
  work();
  return {watch.seconds(), static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC};
}

std::uint64_t readByLaszip(const std::string& path, int threads) {
  std::atomic<std::uint64_t> read = 0;
  std::vector<std::jthread> workers;
  for (int i = 0; i < threads; ++i) {
    workers.emplace_back([&, i] { read += readShare(path, i, threads); });
  }
  workers.clear();
  return read;
}

int run(int argc, char** argv) {
  std::string path;
  int threads = 2;
  int repeats = 3;
  CLI::App app{"How fast points come out of LAZ"};
  app.name("agricolmap_time_decoding");
  app.add_option("FILE", path, "LAZ")->required();
  app.add_option("--threads", threads, "Number of threads [2]")->check(CLI::Range(1, 1024));
  app.add_option("--repeats", repeats, "Repeats [3]")->check(CLI::Range(1, 1000));
  return runMain(app, argc, argv, [&] {
    const ThreadLimit limit(threads);
    fmt::print("points,threads,repeat,laszip_s,laszip_cpu_s,stream_s,stream_cpu_s\n");
    for (int repeat = 0; repeat < repeats; ++repeat) {
      std::uint64_t points = 0;
      const Seconds alone = secondsOf([&] { points = readByLaszip(path, threads); });
      const Seconds ours = secondsOf([&] { io::streamCloud(path); });
      fmt::print("{},{},{},{:.2f},{:.2f},{:.2f},{:.2f}\n", points, threads, repeat, alone.wall,
                 alone.cpu, ours.wall, ours.cpu);
    }
  });
}

}  // namespace
}  // namespace agricolmap

int main(int argc, char** argv) { return agricolmap::run(argc, argv); }
