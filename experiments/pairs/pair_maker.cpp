#include "experiments/pairs/pair_maker.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <utility>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/io/raster/raster_import.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/simulate/ortho/ortho_file.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap::experiments {
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
// Where beets stand, and a window around it; columns, and rows from the top.
constexpr std::array<std::array<double, 2>, 16> kBeetOutline = {{{3640, 160},
                                                                 {3800, 420},
                                                                 {4140, 680},
                                                                 {4230, 1100},
                                                                 {4290, 1400},
                                                                 {4200, 1680},
                                                                 {3870, 1980},
                                                                 {3500, 2340},
                                                                 {3160, 2830},
                                                                 {2900, 3000},
                                                                 {2500, 2750},
                                                                 {2150, 2450},
                                                                 {1780, 2230},
                                                                 {2080, 1890},
                                                                 {2900, 1080},
                                                                 {3240, 690}}};
constexpr io::PixelWindow kAllBeets = {1760, 140, 2560, 2880};

/// Even–odd rule.
bool insideBeets(double col, double row) {
  bool inside = false;
  for (std::size_t i = 0, j = kBeetOutline.size() - 1; i < kBeetOutline.size(); j = i++) {
    const auto& a = kBeetOutline[i];
    const auto& b = kBeetOutline[j];
    if ((a[1] > row) == (b[1] > row)) continue;
    if (col < a[0] + (b[0] - a[0]) * (row - a[1]) / (b[1] - a[1])) inside = !inside;
  }
  return inside;
}

Pair fromStrip(simulate::SimulatedStrip strip, std::shared_ptr<const Cloud> fixed) {
  Pair made;
  made.fixed = std::move(fixed);
  made.moving = std::move(strip.ugv);
  made.guess = strip.prior;
  made.truth.best_affine = strip.best_affine;
  made.truth.points = std::move(strip.truth);
  made.overlaps = strip.overlaps;
  return made;
}

simulate::OrthoFileOptions beetFileOptions() {
  simulate::OrthoFileOptions file;
  file.raster.bands = io::BandOrder::kGrb;  // its false colours have red and green swapped
  file.gsd = kBeetGsd;
  return file;
}

/// A truth the wrong way round, or one that counts from other coordinates than the files', would
/// make every method look wrong.
void checkTruth(const PublishedPair& pair, const Cloud& fixed, const Cloud& moving,
                const Eigen::Affine3d& truth) {
  const Box3 box = boundingBox(fixed);
  const Eigen::Vector2d middle =
      (truth * (moving.origin + meanPoint(moving)) - fixed.origin).head<2>();
  const Eigen::Vector2d low = box.min.head<2>().cast<double>();
  const Eigen::Vector2d high = box.max.head<2>().cast<double>();
  if ((middle.array() >= low.array()).all() && (middle.array() <= high.array()).all()) return;
  const Eigen::Vector2d place = fixed.origin.head<2>() + middle;
  const Eigen::Vector2d from = fixed.origin.head<2>() + low;
  const Eigen::Vector2d to = fixed.origin.head<2>() + high;
  throw InputError(fmt::format(
      "{}: lays the row's middle at x {:.2f}, y {:.2f}, beside the drone's map (x {:.2f} "
      "to {:.2f}, y {:.2f} to {:.2f}); it must take coordinates of {} to those of {}",
      pair.truth_file->string(), place.x(), place.y(), from.x(), to.x(), from.y(), to.y(),
      pair.moving_cloud.string(), pair.fixed_cloud.string()));
}

Cloud readUsable(const std::filesystem::path& path) {
  Cloud cloud = io::readCloud(path);
  if (cloud.empty()) throw InputError(fmt::format("{}: has no usable point", path.string()));
  return cloud;
}

}  // namespace

std::string PairMaker::unavailable(const Case& chosen) const {
  if (chosen.source == PairSource::kSimulated) return {};
  if (chosen.source == PairSource::kOtherGenerator) {
    if (std::filesystem::exists(shared_ / chosen.folder)) return {};
    return fmt::format("{} is not here; make it with scripts/other-generator and give --shared",
                       (shared_ / chosen.folder).string());
  }
  if (chosen.published) {
    if (chosen.published->true_fixed_from_moving) return {};
    return fmt::format("{} has no truth; `agricolmap control-points` makes one",
                       chosen.published->moving_cloud.parent_path().string());
  }
  std::vector<std::string> paths = {chosen.source == PairSource::kSoybean ? kSoybeanFolder
                                                                          : kBeetFile};
  if (chosen.dates) paths = {dateFile(chosen.dates->fixed), dateFile(chosen.dates->moving)};
  for (const std::string& path : paths) {
    if (!std::filesystem::exists(shared_ / path)) {
      return fmt::format("{} is not here; give --shared", (shared_ / path).string());
    }
  }
  return {};
}

Pair PairMaker::make(const Case& chosen, int seed) {
  if (chosen.published) return readPublished(*chosen.published);
  const simulate::SimulationOptions options = chosen.optionsFor(seed);
  const int strip = chosen.stripOf(seed);
  if (chosen.dates) return datePair(*chosen.dates, options);
  if (chosen.source == PairSource::kOtherGenerator) {
    return readGenerated(shared_ / chosen.folder / fmt::format("{}", seed));
  }
  if (chosen.source == PairSource::kSoybean) return soybeanPair(options, strip);
  fly(chosen, seed, options);
  if (field_) {
    simulate::SimulatedStrip made = field_->strip(options, strip);
    std::vector<Eigen::Vector3d> slips;
    if (chosen.slip) slips = displacePart(made, *chosen.slip, options);
    Pair pair = fromStrip(std::move(made), {field_, &field_->uav()});
    pair.slips = std::move(slips);
    return pair;
  }
  return fromStrip(ortho_->strip(options, strip), {ortho_, &ortho_->uav()});
}

void PairMaker::fly(const Case& chosen, int seed, const simulate::SimulationOptions& options) {
  std::string flight = chosen.flightText(seed);
  if (flight == flown_) return;
  // A hectare takes gigabytes: the old view goes before the new one is made.
  flown_.clear();
  field_.reset();
  ortho_.reset();
  if (chosen.source == PairSource::kSimulated) {
    field_ = std::make_shared<const simulate::SimulatedField>(options);
  } else {
    simulate::OrthoField field =
        chosen.source == PairSource::kBeetMosaic ? readBeets(options.seed) : readAllBeets();
    field.row_heading = kBeetRowHeading;
    ortho_ = std::make_shared<const simulate::SimulatedOrtho>(std::move(field), options);
  }
  flown_ = std::move(flight);
}

simulate::OrthoField PairMaker::readBeets(int seed) const {
  // Another window for each seed, by up to half a metre.
  Random random = Random::stream(static_cast<std::uint64_t>(seed), 0xBEE7);
  io::PixelWindow window{kBeetMiddleCol - kBeetWindow / 2 - 50,
                         kBeetMiddleRow + 51 - kBeetWindow / 2, kBeetWindow, kBeetWindow};
  window.col += static_cast<int>(random.below(101));
  window.row -= static_cast<int>(random.below(101));
  return simulate::readOrtho({.ortho = shared_ / kBeetFile, .dsm = {}, .dtm = {}},
                             beetFileOptions(), window);
}

simulate::OrthoField PairMaker::readAllBeets() const {
  simulate::OrthoField field = simulate::readOrtho(
      {.ortho = shared_ / kBeetFile, .dsm = {}, .dtm = {}}, beetFileOptions(), kAllBeets);
  if (field.valid.empty()) {
    field.valid = Raster<std::uint8_t>(field.colour.rows(), field.colour.cols());
    for (std::uint8_t& valid : field.valid) valid = 1;
  }
  for (int r = 0; r < field.valid.rows(); ++r) {
    const int from_top = kAllBeets.row + kAllBeets.rows - 1 - r;
    for (int c = 0; c < field.valid.cols(); ++c) {
      if (!insideBeets(kAllBeets.col + c, from_top)) field.valid(r, c) = 0;
    }
  }
  return field;
}

void PairMaker::loadSoybean() {
  const std::filesystem::path folder = shared_ / kSoybeanFolder;
  Soybean loaded;
  loaded.cloud = std::make_shared<const Cloud>(
      io::importOrthoDsm(folder / "soy_ortho.tif", folder / "soy_dsm.tif"));
  simulate::OrthoField& field = loaded.field;
  field = simulate::readOrtho({.ortho = folder / "soy_ortho.tif",
                               .dsm = folder / "soy_dsm.tif",
                               .dtm = folder / "soy_dtm.tif"});
  field.row_heading = kSoybeanRowHeading;
  // The simulator counts heights from the ground in the middle of the mosaic.
  const float zero = field.ground(field.ground.rows() / 2, field.ground.cols() / 2);
  loaded.place << field.corner.value(), static_cast<double>(zero);
  soybean_ = std::move(loaded);
}

Pair PairMaker::soybeanPair(const simulate::SimulationOptions& options, int strip) {
  if (!soybean_) loadSoybean();
  simulate::SimulationOptions here = options;
  here.uav.gsd = soybean_->field.gsd;
  // The fixed cloud is the real one, as imported; only the strip passes through the simulator.
  Pair made = fromStrip(simulate::SimulatedOrtho(soybean_->field, here).strip(here, strip),
                        soybean_->cloud);
  const Eigen::Translation3d move(soybean_->place);
  made.guess = move * made.guess;
  made.truth.best_affine = move * made.truth.best_affine;
  for (Eigen::Vector3d& point : made.truth.points) point += soybean_->place;
  return made;
}

template <typename Read>
void PairMaker::keepFixed(const std::filesystem::path& file, const Read& read) {
  if (fixed_file_ == file) return;
  // The old cloud goes before the new one is read.
  fixed_file_.clear();
  fixed_.reset();
  fixed_ = std::make_shared<const Cloud>(read(file));
  fixed_file_ = file;
}

Pair PairMaker::datePair(const DatePair& dates, const simulate::SimulationOptions& options) {
  keepFixed(shared_ / dateFile(dates.fixed),
            [](const std::filesystem::path& file) { return layFlat(io::readRaster(file)); });
  FlatStrip strip = cutStrip(io::readRaster(shared_ / dateFile(dates.moving)), dates, options);
  Pair made;
  made.fixed = fixed_;
  made.moving = std::move(strip.cloud);
  made.guess = strip.geotag.prior;
  made.truth.best_affine = strip.geotag.nominal;
  made.overlaps = !options.mirrored;
  return made;
}

Pair PairMaker::readGenerated(const std::filesystem::path& folder) {
  keepFixed(folder / "uav.ply", readUsable);
  Pair made;
  made.fixed = fixed_;
  made.moving = readUsable(folder / "ugv.ply");
  // It bakes the guess's error into the robot's cloud.
  made.guess = Eigen::Affine3d::Identity();
  made.truth.best_affine = io::readMatrix(folder / "best.txt");
  // Where the robot recorded each point, without its drift and that of the drone's map.
  const Eigen::Affine3d nominal = io::readMatrix(folder / "truth.txt");
  made.truth.points.reserve(made.moving.size());
  for (std::size_t i = 0; i < made.moving.size(); ++i) {
    made.truth.points.emplace_back(nominal * made.moving.filePoint(i));
  }
  return made;
}

Pair PairMaker::readPublished(const PublishedPair& pair) {
  keepFixed(pair.fixed_cloud, readUsable);
  Pair made;
  made.fixed = fixed_;
  made.moving = readUsable(pair.moving_cloud);
  made.guess = made.truth.best_affine = pair.true_fixed_from_moving.value();
  checkTruth(pair, *fixed_, made.moving, made.guess);
  return made;
}

}  // namespace agricolmap::experiments
