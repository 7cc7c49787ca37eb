// agricolmap simulate -o DIR: a pair of clouds with exact truth, of a simulated crop or of a real
// orthomosaic.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>

#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/io/text/path_file.hpp"
#include "agricolmap/simulate/picture/pair_picture.hpp"
#include "agricolmap/simulate/simulate.hpp"
#include "common.hpp"
#include "option_flags.hpp"
#include "ortho_arguments.hpp"

namespace agricolmap {
namespace {

constexpr const char* kPicture = "pair.png";
constexpr const char* kPlants = "truth_plants.csv";

struct SimulateArguments {
  std::string output;
  std::string config;
  int strips = 1;
  bool dump_config = false;
  bool no_pictures = false;
  OptionFlags flags;
  OrthoArguments ortho;
};

/// The crop's preset, then the configuration file, then flags; the crop may come from either.
simulate::SimulationOptions chosenOptions(const SimulateArguments& arguments,
                                          const Globals& globals) {
  const auto fill = [&](simulate::SimulationOptions& options) {
    OptionTable table = optionTable(options);
    if (!arguments.config.empty()) config::loadYaml(arguments.config, table);
    if (globals.seed_given) options.seed = globals.seed;
    arguments.flags.apply(table);
  };
  simulate::SimulationOptions first;
  fill(first);
  simulate::SimulationOptions options = simulate::cropPreset(first.crop);
  fill(options);
  return options;
}

Cloud truthCloud(const simulate::SimulatedStrip& strip, const Eigen::Vector3d& origin) {
  Cloud cloud;
  cloud.name = "truth";
  cloud.origin = origin;
  cloud.xyz.reserve(strip.truth.size());
  for (const Eigen::Vector3d& p : strip.truth) {
    cloud.xyz.push_back((p - cloud.origin).cast<float>());
  }
  return cloud;
}

void writeUav(const io::StagedOutput& output, const Cloud& uav) {
  io::writePly(output.path("uav/point_cloud.ply"), uav);
  // The UAV's file is the world; the UGV's geotag is what the initial guess knows.
  io::writeOffset(output.path("uav/offset.xyz"), Eigen::Affine3d::Identity());
}

/// The files of a strip, counted from 0; the first has the names of a pair's only strip.
struct StripFiles {
  explicit StripFiles(int index) : number(index == 0 ? "" : fmt::format("_{}", index + 1)) {}
  std::string number;
  std::string cloud = fmt::format("ugv{}/point_cloud.ply", number);
  std::string offset = fmt::format("ugv{}/offset.xyz", number);
  std::string path = fmt::format("ugv{}/path.txt", number);
  std::string prior = fmt::format("prior{}.txt", number);
  std::string truth = fmt::format("truth{}.txt", number);
  std::string truth_points = fmt::format("truth_points{}.ply", number);
};

void writeStrip(const io::StagedOutput& output, const simulate::SimulatedStrip& strip, int index,
                const Eigen::Vector3d& origin) {
  const StripFiles files(index);
  io::writePly(output.path(files.cloud), strip.ugv);
  io::writeOffset(output.path(files.offset), strip.prior);
  io::writePath(output.path(files.path), strip.path, "x y z of the robot, UGV file");
  io::writeMatrix(output.path(files.prior), strip.prior, "initial guess, UGV file -> UAV file");
  io::writeMatrix(output.path(files.truth), strip.best_affine,
                  "best affine, UGV file -> UAV file; not exact where the strip drifts");
  io::writePly(output.path(files.truth_points), truthCloud(strip, origin));
}

/// What an earlier run may have left in the folder that is no file of this field.
std::vector<std::string> staleNames(const std::filesystem::path& folder, int strips) {
  std::vector<std::string> names = {kPicture, kPlants};
  for (int index = strips;; ++index) {
    const StripFiles files(index);
    if (!std::filesystem::exists(folder / files.cloud)) return names;
    names.insert(names.end(), {files.cloud, files.offset, files.path, files.prior, files.truth,
                               files.truth_points});
  }
}

/// Rows are numbered across the field from 1.
void writePlants(const io::StagedOutput& output, const std::vector<simulate::TruePlant>& plants) {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  for (const simulate::TruePlant& plant : plants) {
    if (!plant.weed()) first = std::min(first, plant.row);
  }
  std::string text = "x,y,z,height,kind,row,radius\n";
  for (const simulate::TruePlant& plant : plants) {
    const std::string row = plant.weed() ? "" : fmt::format("{}", plant.row - first + 1);
    fmt::format_to(std::back_inserter(text), "{:.4f},{:.4f},{:.4f},{:.3f},{},{},{:.3f}\n",
                   plant.stem.x(), plant.stem.y(), plant.stem.z(), plant.height,
                   plant.weed() ? "weed" : "crop", row, plant.radius);
  }
  io::writeText(output.path(kPlants), text);
}

/// The clouds of one field, and its plants where they are known one by one.
class Scene {
 public:
  Scene(SimulateArguments& arguments, simulate::SimulationOptions& options) {
    if (arguments.ortho.given(arguments.flags)) {
      ortho_ = arguments.ortho.fly(options);
    } else {
      field_ = std::make_unique<simulate::SimulatedField>(options);
    }
  }
  const Cloud& uav() const { return ortho_ ? ortho_->uav() : field_->uav(); }
  simulate::SimulatedStrip strip(const simulate::SimulationOptions& options, int index) const {
    return ortho_ ? ortho_->strip(options, index) : field_->strip(options, index);
  }
  std::optional<std::vector<simulate::TruePlant>> plants() const {
    if (ortho_) return std::nullopt;
    return field_->plants();
  }

 private:
  std::unique_ptr<simulate::SimulatedOrtho> ortho_;
  std::unique_ptr<simulate::SimulatedField> field_;
};

void writePicture(const io::StagedOutput& output, const Cloud& uav,
                  const simulate::SimulatedStrip& strip, const std::string& field, int seed) {
  simulate::PairPictureInfo info;
  info.title = fmt::format("Simulated pair: {}, seed {}", field, seed);
  if (!strip.overlaps) info.title += ", of different fields";
  info.same_field = strip.overlaps;
  simulate::writePairPicture(output.path(kPicture), uav, strip.ugv, strip.best_affine, info);
}

ExitCode runSimulate(SimulateArguments& arguments, const Globals& globals) {
  simulate::SimulationOptions options = chosenOptions(arguments, globals);
  const bool from_ortho = arguments.ortho.given(arguments.flags);
  const OptionTable table = optionTable(options);
  if (arguments.dump_config) {
    fmt::print("{}", config::dumpYaml(table));
    return ExitCode::kOk;
  }
  if (arguments.output.empty()) throw UsageError("simulate needs -o DIR");
  requirePictures(arguments.no_pictures);
  io::StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  progress.step("simulate");
  const Scene scene(arguments, options);
  writeUav(output, scene.uav());
  if (const auto plants = scene.plants()) writePlants(output, *plants);
  io::writeText(output.path("simulation.yaml"),
                (from_ortho ? arguments.ortho.provenance() : "") + config::dumpYaml(table));
  std::size_t points = 0;
  bool overlaps = true;
  for (int index = 0; index < arguments.strips; ++index) {
    progress.step(fmt::format("strip {} of {}", index + 1, arguments.strips));
    const simulate::SimulatedStrip strip = scene.strip(options, index);
    writeStrip(output, strip, index, scene.uav().origin);
    points += strip.ugv.size();
    overlaps = strip.overlaps;
    if (index > 0 || arguments.no_pictures) continue;
    writePicture(output, scene.uav(), strip,
                 from_ortho ? arguments.ortho.fileName() : config::optionText(*table.find("crop")),
                 options.seed);
  }
  output.commit(staleNames(output.directory(), arguments.strips));
  if (!globals.quiet) {
    fmt::print("{}: UAV {} points, UGV {} points{}{}\n", arguments.output, scene.uav().size(),
               points, arguments.strips > 1 ? fmt::format(" in {} strips", arguments.strips) : "",
               overlaps ? "" : ", from different fields");
  }
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addSimulateCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand(
      "simulate",
      "Make a UAV/UGV pair of a crop field with exact truth, in the layout of the "
      "published data set: of a simulated crop, or cut from a real orthomosaic (--ortho)");
  command->add_option("-o,--output", arguments->output, "Folder for the pair");
  command->add_option("--config", arguments->config, "YAML file with options");
  command
      ->add_option("--strips", arguments->strips,
                   "How many strips of the field: the further ones are ugv_2/, prior_2.txt, "
                   "truth_2.txt, truth_points_2.ply, ... (1)")
      ->check(CLI::Range(1, 10000));
  command->add_flag("--dump-config", arguments->dump_config,
                    "Print all options in force as YAML and stop");
  command->add_flag("--no-pictures", arguments->no_pictures, "Write no PNG picture");
  arguments->ortho.addTo(*command);
  simulate::SimulationOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options of the simulator", {"seed"});
  return {command, [arguments, &globals] { return runSimulate(*arguments, globals); }};
}

}  // namespace agricolmap
