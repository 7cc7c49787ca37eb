#include "campaign_cases.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "agricolmap/core/random.hpp"
#include "agricolmap/io/raster_import.hpp"
#include "agricolmap/simulate/ortho_file.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap::campaign {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr const char* kBeetFile = "data/sugarbeet_weedmap_E/map_E.png";
constexpr const char* kSoybeanFolder = "data/soybean_pliman";

// Inferred from its row distance, see the data's README. The PNG has no georeference.
constexpr double kBeetGsd = 0.00985;
// Direction of the strongest peak of the spectrum of its Excess Green.
constexpr double kBeetRowHeading = 47.5 * kDegree;
constexpr double kSoybeanRowHeading = 2.0 * kDegree;
// Half of the mosaic is another crop and bare soil: windows lie around the middle of the beets.
constexpr int kBeetMiddleCol = 3200;
constexpr int kBeetMiddleRow = 1860;  // from the top
constexpr int kBeetWindow = 2132;     // 21 m

struct GuessError {
  double translation;
  double heading_deg;
  double scale;
};
constexpr GuessError kEasy = {1.0, 2.0, 0.05};
constexpr GuessError kJoint = {5.0, 11.5, 0.30};

void setGuess(SimulationOptions& options, const GuessError& error, bool uniform) {
  options.geotag.translation = error.translation;
  options.geotag.heading_deg = error.heading_deg;
  options.geotag.scale = error.scale;
  options.geotag.uniform = uniform;
}

CampaignCase simulatedCase(std::string name, Crop crop, const GuessError& error, bool uniform,
                           Target target) {
  CampaignCase made;
  made.name = std::move(name);
  made.options = cropPreset(crop);
  made.target = target;
  setGuess(made.options, error, uniform);
  return made;
}

CampaignCase beetMosaicCase(bool uniform) {
  CampaignCase made =
      simulatedCase("semireal-sugarbeet", Crop::kSugarBeet10m, {3.0, 6.0, 0.15}, uniform,
                    {.min_success = 0.98, .max_accepted = {}, .max_rms = 0.008});
  made.source = PairSource::kBeetMosaic;
  return made;
}

CampaignCase soybeanCase(bool uniform) {
  CampaignCase made =
      simulatedCase("real-soybean", Crop::kSoybean, {1.0, 3.0, 0.10}, uniform,
                    {.min_success = 1.0, .max_accepted = {}, .max_rms = 0.02, .worst_rms = true});
  made.source = PairSource::kSoybean;
  made.max_pairs = 10;
  // The plot is 11.4 m x 5.6 m. Its plants are as they were at the flight: what differs is the
  // sampling, the noise, the colours and the path.
  made.options.ugv.length = 6.0;
  made.options.ugv.width = 2.0;
  made.options.views.leaf_unshared = 0.0;
  made.options.views.wind = 0.0;
  made.options.views.growth = 1.0;
  made.options.geotag.utm = false;
  return made;
}

CampaignPair fromSimulation(SimulatedPair pair) {
  CampaignPair made;
  made.fixed = std::move(pair.uav);
  made.moving = std::move(pair.ugv);
  made.prior = pair.prior;
  made.truth.best_affine = pair.best_affine;
  made.truth.points = std::move(pair.truth);
  made.overlaps = pair.overlaps;
  return made;
}

}  // namespace

std::vector<CampaignCase> allCases(bool uniform) {
  const std::vector<std::pair<std::string, Crop>> crops = {{"soybean", Crop::kSoybean},
                                                           {"sugar-beet-10m", Crop::kSugarBeet10m},
                                                           {"sugar-beet-20m", Crop::kSugarBeet20m},
                                                           {"winter-wheat", Crop::kWinterWheat}};
  const Target easy = {.min_success = 0.98, .max_accepted = {}, .max_rms = 0.010};
  const Target joint = {.min_success = 0.95, .max_accepted = {}, .max_rms = 0.012};
  const Target other = {.min_success = {}, .max_accepted = 0.02, .max_rms = {}};
  std::vector<CampaignCase> cases;
  for (const auto& [name, crop] : crops) {
    cases.push_back(simulatedCase(name + "-easy", crop, kEasy, uniform, easy));
  }
  for (const auto& [name, crop] : crops) {
    cases.push_back(simulatedCase(name + "-joint", crop, kJoint, uniform, joint));
  }
  cases.push_back(simulatedCase("maize-joint", Crop::kMaize, kJoint, uniform, {}));
  for (const auto& [name, crop] : crops) {
    cases.push_back(simulatedCase("other-field-" + name, crop, kJoint, uniform, other));
    cases.back().options.other_field = true;
  }
  cases.push_back(beetMosaicCase(uniform));
  cases.push_back(soybeanCase(uniform));
  return cases;
}

std::string RealFields::unavailable(PairSource source) const {
  if (source == PairSource::kSimulated) return {};
  const std::filesystem::path path =
      shared_ / (source == PairSource::kBeetMosaic ? kBeetFile : kSoybeanFolder);
  if (std::filesystem::exists(path)) return {};
  return fmt::format("{} is not here; give --shared", path.string());
}

CampaignPair RealFields::beetPair(const SimulationOptions& options) const {
  OrthoFileOptions file;
  file.raster.bands = BandOrder::kGrb;  // its false colours have red and green swapped
  file.gsd = kBeetGsd;
  // Another window for each seed, by up to half a metre.
  Random random = Random::stream(static_cast<std::uint64_t>(options.seed), 0xBEE7);
  PixelWindow window{kBeetMiddleCol - kBeetWindow / 2 - 50, kBeetMiddleRow + 51 - kBeetWindow / 2,
                     kBeetWindow, kBeetWindow};
  window.col += static_cast<int>(random.below(101));
  window.row -= static_cast<int>(random.below(101));
  OrthoField field = readOrtho({.ortho = shared_ / kBeetFile, .dsm = {}, .dtm = {}}, file, window);
  field.row_heading = kBeetRowHeading;
  return fromSimulation(simulateFromOrtho(field, options));
}

RealFields::Soybean RealFields::loadSoybean(const std::filesystem::path& folder) {
  Soybean loaded;
  loaded.cloud = importOrthoDsm(folder / "soy_ortho.tif", folder / "soy_dsm.tif");
  OrthoField& field = loaded.field;
  field = readOrtho({.ortho = folder / "soy_ortho.tif",
                     .dsm = folder / "soy_dsm.tif",
                     .dtm = folder / "soy_dtm.tif"});
  field.row_heading = kSoybeanRowHeading;
  // The simulator counts heights from the ground in the middle of the mosaic.
  const float zero = field.ground(field.ground.rows() / 2, field.ground.cols() / 2);
  loaded.place << field.corner.value(), static_cast<double>(zero);
  return loaded;
}

CampaignPair RealFields::soybeanPair(const SimulationOptions& options) {
  if (!soybean_) soybean_ = loadSoybean(shared_ / kSoybeanFolder);
  SimulationOptions here = options;
  here.uav.gsd = soybean_->field.gsd;
  CampaignPair made = fromSimulation(simulateFromOrtho(soybean_->field, here));
  // The fixed cloud is the real one, as imported; only the strip passes through the simulator.
  made.fixed = soybean_->cloud;
  const Eigen::Translation3d move(soybean_->place);
  made.prior = move * made.prior;
  made.truth.best_affine = move * made.truth.best_affine;
  for (Eigen::Vector3d& point : made.truth.points) point += soybean_->place;
  return made;
}

CampaignPair makePair(const CampaignCase& chosen, int seed, RealFields& fields) {
  SimulationOptions options = chosen.options;
  options.seed = seed;
  switch (chosen.source) {
    case PairSource::kBeetMosaic:
      return fields.beetPair(options);
    case PairSource::kSoybean:
      return fields.soybeanPair(options);
    case PairSource::kSimulated:
      break;
  }
  return fromSimulation(simulatePair(options));
}

}  // namespace agricolmap::campaign
