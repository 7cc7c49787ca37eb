// Times of the stages on one simulated pair of about 2 and 1 million points.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/pipeline/refinement.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap {
namespace {

/// The pair, its files and what each stage starts from.
class Scene {
 public:
  static const Scene& get() {
    static const Scene scene;
    return scene;
  }
  ~Scene() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  simulate::SimulatedPair pair;
  pipeline::RegistrationOptions options = pipeline::preset("default");
  pipeline::Registration result;
  std::filesystem::path folder;

 private:
  Scene() {
    simulate::SimulationOptions simulation = simulate::cropPreset(simulate::Crop::kSoybean);
    simulation.seed = 4242;
    simulation.geotag.translation = 5.0;
    simulation.geotag.heading_deg = 11.5;
    simulation.geotag.scale = 0.3;
    pair = simulate::simulatePair(simulation);
    folder = std::filesystem::temp_directory_path() /
             ("agricolmap_benchmark_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    io::writePly(folder / "uav.ply", pair.uav);
    io::writePly(folder / "ugv.ply", pair.ugv);
    Monitor monitor;
    result = pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, options, monitor);
  }
};

void countPoints(benchmark::State& state, std::size_t points) {
  state.counters["points"] = static_cast<double>(points);
  state.SetItemsProcessed(static_cast<std::int64_t>(points) *
                          static_cast<std::int64_t>(state.iterations()));
}

void readPly(benchmark::State& state) {
  const Scene& scene = Scene::get();
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(io::readCloud(scene.folder / "uav.ply"));
    benchmark::DoNotOptimize(io::readCloud(scene.folder / "ugv.ply"));
  }
  countPoints(state, scene.pair.uav.size() + scene.pair.ugv.size());
}

map::Box2 windowOf(const map::GridMap& map) {
  const GridFrame& frame = map.frame;
  return {frame.corner,
          (frame.corner + frame.cell * Eigen::Vector2d(frame.cols, frame.rows)).eval()};
}

void level(benchmark::State& state) {
  const Scene& scene = Scene::get();
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        map::levelCloud(scene.pair.uav, Eigen::Affine3d::Identity(), scene.options.level));
    benchmark::DoNotOptimize(
        map::levelCloud(scene.pair.ugv, Eigen::Affine3d::Identity(), scene.options.level));
  }
  countPoints(state, scene.pair.uav.size() + scene.pair.ugv.size());
}

void grid(benchmark::State& state) {
  const Scene& scene = Scene::get();
  const pipeline::Registration& r = scene.result;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(map::makeGridMap(scene.pair.uav, r.maps.frames.levelled_from_fixed,
                                              windowOf(r.maps.fixed), scene.options.grid));
    benchmark::DoNotOptimize(map::makeGridMap(scene.pair.ugv, r.maps.frames.levelled_from_moving,
                                              windowOf(r.maps.moving), scene.options.grid));
  }
  countPoints(state, scene.pair.uav.size() + scene.pair.ugv.size());
}

/// The signal maps and their whitening, which search and refinement share, anew each time.
void search(benchmark::State& state) {
  const Scene& scene = Scene::get();
  const pipeline::PairMaps& maps = scene.result.maps;
  for ([[maybe_unused]] auto _ : state) {
    const correlation::MapSignals fixed(maps.fixed, scene.options.signal);
    const correlation::MapSignals moving(maps.moving, scene.options.signal);
    benchmark::DoNotOptimize(locate::searchByCorrelation(
        fixed, moving, locate::rowWaves(fixed, moving), maps.space, scene.options.search));
  }
}

void flow(benchmark::State& state) {
  const Scene& scene = Scene::get();
  const pipeline::PairMaps& maps = scene.result.maps;
  for ([[maybe_unused]] auto _ : state) {
    Monitor monitor;
    benchmark::DoNotOptimize(
        paper::associateByFlow(maps.fixed, maps.moving, maps.space, scene.options.flow, monitor));
  }
}

void refine(benchmark::State& state) {
  const Scene& scene = Scene::get();
  const pipeline::Registration& r = scene.result;
  for ([[maybe_unused]] auto _ : state) {
    const correlation::MapSignals fixed(r.maps.fixed, scene.options.signal);
    const correlation::MapSignals moving(r.maps.moving, scene.options.signal);
    const refine::PairSignals signals(fixed, moving, scene.options.hidden, scene.options.filter);
    benchmark::DoNotOptimize(pipeline::refinePlacements(signals, r.trace.located.placements,
                                                        r.maps.space.scale_axes, scene.options));
  }
}

void verdict(benchmark::State& state) {
  const Scene& scene = Scene::get();
  const pipeline::Registration& r = scene.result;
  const correlation::MapSignals fixed(r.maps.fixed, scene.options.signal);
  const correlation::MapSignals moving(r.maps.moving, scene.options.signal);
  const refine::PairSignals signals(fixed, moving, scene.options.hidden, scene.options.filter);
  pipeline::Refined refined;
  refined.best = {.pose = r.placed->pose};
  for ([[maybe_unused]] auto _ : state) {
    Monitor monitor;
    const pipeline::Measured measured =
        pipeline::measureStraightened(signals, r.maps.space, refined, scene.options, monitor);
    benchmark::DoNotOptimize(pipeline::judgePlaced(measured.placed, {}, r.maps, scene.options));
  }
}

void whole(benchmark::State& state) {
  const Scene& scene = Scene::get();
  for ([[maybe_unused]] auto _ : state) {
    Monitor monitor;
    benchmark::DoNotOptimize(pipeline::registerClouds(scene.pair.uav, scene.pair.ugv,
                                                      scene.pair.prior, scene.options, monitor));
  }
}

BENCHMARK(readPly)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(level)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(grid)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(search)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(flow)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(refine)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(verdict)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(whole)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace agricolmap

BENCHMARK_MAIN();
