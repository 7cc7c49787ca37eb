#include "campaign_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/raster_file.hpp"
#include "agricolmap/io/raster_import.hpp"
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

/// Columns and rows of `image` from `row` (of the top) and `col`, row 0 south.
OrthoField cropField(const OrthoField& field, int row, int col, int size) {
  OrthoField part;
  part.name = field.name;
  part.gsd = field.gsd;
  part.row_heading = field.row_heading;
  part.colour = Raster<Rgb>(size, size);
  part.valid = Raster<std::uint8_t>(size, size);
  for (int r = 0; r < size; ++r) {
    std::copy_n(field.colour.row(row + r) + col, size, part.colour.row(r));
    std::copy_n(field.valid.row(row + r) + col, size, part.valid.row(r));
  }
  return part;
}

/// The raster with row 0 south.
template <typename T>
Raster<T> southFirst(const Raster<T>& raster) {
  Raster<T> flipped(raster.rows(), raster.cols());
  for (int r = 0; r < raster.rows(); ++r) {
    std::copy_n(raster.row(raster.rows() - 1 - r), raster.cols(), flipped.row(r));
  }
  return flipped;
}

/// Heights of a raster that lies exactly on the mosaic's pixels, row 0 south; those missing are the
/// mean, since the simulator wants numbers.
Raster<float> heightsOn(const RasterImage& mosaic, const std::filesystem::path& path,
                        Raster<std::uint8_t>& valid) {
  const RasterHeights heights = readHeights(path);
  const auto& here = heights.place.world_from_pixel;
  if (heights.height.rows() != mosaic.colour.rows() ||
      heights.height.cols() != mosaic.colour.cols() || !here ||
      !here->isApprox(*mosaic.place.world_from_pixel, 1e-9)) {
    throw InputError(
        fmt::format("{}: does not lie on the pixels of {}", path.string(), mosaic.name));
  }
  Raster<float> flipped = southFirst(heights.height);
  double sum = 0.0;
  std::size_t count = 0;
  for (const float h : flipped) {
    if (!std::isfinite(h)) continue;
    sum += static_cast<double>(h);
    ++count;
  }
  for (std::size_t i = 0; i < flipped.size(); ++i) {
    if (std::isfinite(flipped[i])) continue;
    flipped[i] = static_cast<float>(sum / static_cast<double>(count));
    valid[i] = 0;
  }
  return flipped;
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

CampaignPair RealFields::beetPair(const SimulationOptions& options) {
  if (!beets_) {
    const std::filesystem::path path = shared_ / kBeetFile;
    RasterOptions raster;
    raster.bands = BandOrder::kGrb;  // its false colours have red and green swapped
    const RasterImage image = readRaster(path, raster);
    if (image.colour.rows() < kBeetMiddleRow + kBeetWindow ||
        image.colour.cols() < kBeetMiddleCol + kBeetWindow / 2) {
      throw InputError(fmt::format("{}: is {} x {} pixels, not the mosaic this case is made for",
                                   path.string(), image.colour.cols(), image.colour.rows()));
    }
    OrthoField field;
    field.name = path.string();
    field.gsd = kBeetGsd;
    field.row_heading = kBeetRowHeading;
    field.colour = southFirst(image.colour);
    field.valid = southFirst(image.valid);
    beets_ = std::move(field);
  }
  // Another window for each seed, by up to half a metre.
  Random random = Random::stream(static_cast<std::uint64_t>(options.seed), 0xBEE7);
  const int col = kBeetMiddleCol - kBeetWindow / 2 - 50 + static_cast<int>(random.below(101));
  const int middle_row = beets_->colour.rows() - 1 - kBeetMiddleRow;
  const int row = middle_row - kBeetWindow / 2 - 50 + static_cast<int>(random.below(101));
  return fromSimulation(simulateFromOrtho(cropField(*beets_, row, col, kBeetWindow), options));
}

RealFields::Soybean RealFields::loadSoybean(const std::filesystem::path& folder) {
  Soybean loaded;
  loaded.cloud = importOrthoDsm(folder / "soy_ortho.tif", folder / "soy_dsm.tif");
  const RasterImage mosaic = readRaster(folder / "soy_ortho.tif");
  if (!mosaic.place.world_from_pixel) {
    throw InputError(fmt::format("{}: has no georeference", mosaic.name));
  }
  const Eigen::Affine2d world = *mosaic.place.world_from_pixel;
  const Eigen::Matrix2d pixel = world.linear();
  const double gsd = pixel(0, 0);
  if (!(gsd > 0.0) || std::abs(pixel(1, 1) + gsd) > 1e-6 * gsd || pixel(0, 1) != 0.0 ||
      pixel(1, 0) != 0.0) {
    throw InputError(fmt::format("{}: is not north up with square pixels", mosaic.name));
  }
  OrthoField& field = loaded.field;
  field.name = mosaic.name;
  field.gsd = gsd;
  field.row_heading = kSoybeanRowHeading;
  field.colour = southFirst(mosaic.colour);
  field.valid = southFirst(mosaic.valid);
  field.height = heightsOn(mosaic, folder / "soy_dsm.tif", field.valid);
  field.ground = heightsOn(mosaic, folder / "soy_dtm.tif", field.valid);
  const Eigen::Vector2d corner = world * Eigen::Vector2d(0.0, mosaic.colour.rows());
  // The simulator counts heights from the ground in the middle of the mosaic.
  const float zero = field.ground(field.ground.rows() / 2, field.ground.cols() / 2);
  loaded.place = {corner.x(), corner.y(), static_cast<double>(zero)};
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
