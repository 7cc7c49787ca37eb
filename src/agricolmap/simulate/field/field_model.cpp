#include "agricolmap/simulate/field/field_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::simulate {

namespace {

// Seeds of the field's independent random fields.
constexpr std::uint64_t kWobble = 11;
constexpr std::uint64_t kPass = 12;
constexpr std::uint64_t kGap = 13;
constexpr std::uint64_t kGrowth = 14;
constexpr std::uint64_t kTone = 15;
constexpr std::uint64_t kPlant = 16;
constexpr std::uint64_t kWeed = 17;
constexpr std::uint64_t kPatch = 18;
constexpr std::uint64_t kStrawSeed = 19;
constexpr std::uint64_t kRelief = 20;
constexpr std::uint64_t kMissing = 21;
constexpr std::uint64_t kPlot = 22;
constexpr std::uint64_t kStoneSeed = 23;

constexpr double kBiggestPlot = 1.6;  // plants over the field's

constexpr double kNarrowRelief = 0.26;  // over the wide
constexpr double kTerraceRamp = 0.5;    // from one terrace to the next [m]

constexpr double kTrackGauge = 1.8;
constexpr double kTrackWidth = 0.36;

bool inside(const Window& window, const Eigen::Vector2d& point, double margin) {
  const Eigen::Vector2d p = window.local(point);
  return p.x() >= -margin && p.y() >= -margin && p.x() <= window.width() + margin &&
         p.y() <= window.height() + margin;
}

}  // namespace

double reachOf(Species species) {
  switch (species) {
    case Species::kSoybean:
      return 0.17;
    case Species::kBeet:
      return 0.24;
    case Species::kWheat:
      return 0.22;
    case Species::kMaize:
      return 0.70;
    case Species::kBroadWeed:
      return 0.10;
    case Species::kGrassWeed:
      return 0.16;
    case Species::kStraw:
      return 0.22;
    case Species::kStone:
      return 0.08;
  }
  return 0.0;
}

Species speciesOf(Crop crop) {
  switch (crop) {
    case Crop::kSoybean:
      return Species::kSoybean;
    case Crop::kSugarBeet10m:
    case Crop::kSugarBeet20m:
      return Species::kBeet;
    case Crop::kWinterWheat:
      return Species::kWheat;
    case Crop::kMaize:
      return Species::kMaize;
  }
  return Species::kSoybean;
}

float leafDepthOf(Species species) {
  switch (species) {
    case Species::kSoybean:
      return 0.10F;
    case Species::kBeet:
      return 0.06F;
    case Species::kWheat:
      return 0.05F;
    case Species::kMaize:
      return 0.14F;
    default:
      return 0.03F;
  }
}

FieldModel::FieldModel(Crop crop, const FieldOptions& options, std::uint64_t seed)
    : species_(speciesOf(crop)), options_(options), seed_(seed) {
  Random random = Random::stream(seed, 1);
  const double drawn = random.uniform(0.0, 2.0 * std::numbers::pi);
  heading_ = options.random_row_heading ? drawn : radians(options.row_heading_deg);
  track_offset_ = random.uniform() * options.tramline_spacing;
  const double downhill = random.uniform(0.0, 2.0 * std::numbers::pi);
  slope_ = options.slope * Eigen::Vector2d(std::cos(downhill), std::sin(downhill));
  sown_ = {{species_, options.plant_spacing}};
  if (options.plots.mixed <= 0.0) return;
  for (const Crop other : {Crop::kSoybean, Crop::kSugarBeet10m, Crop::kWinterWheat, Crop::kMaize}) {
    if (speciesOf(other) == species_) continue;
    sown_.push_back({speciesOf(other), cropPreset(other).field.plant_spacing});
  }
}

Eigen::Vector2d FieldModel::rowCoordinates(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d centre(0.5 * options_.width, 0.5 * options_.height);
  return Eigen::Rotation2Dd(-heading_) * (point - centre);
}

float FieldModel::wheelTrack(double across) const {
  const double spacing = options_.tramline_spacing;
  if (spacing <= 0.0) return 0.0F;
  // Distance to the nearest tramline, then to its nearer wheel.
  const double from_line = std::abs(std::remainder(across - track_offset_, spacing));
  const double from_wheel = std::abs(from_line - 0.5 * kTrackGauge);
  const double inside_track = 1.0 - from_wheel / (0.5 * kTrackWidth);
  return static_cast<float>(std::clamp(2.0 * inside_track, 0.0, 1.0));
}

double FieldModel::soilHeight(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d uv = rowCoordinates(point);
  const std::uint64_t seed = hashBits(seed_, kRelief);
  double z = slope_.dot(point);
  const Eigen::Vector2d wide = point / options_.relief_length;
  const Eigen::Vector2d narrow = point / (kNarrowRelief * options_.relief_length);
  z += options_.relief * static_cast<double>(noiseAt(seed, wide.x(), wide.y()));
  z += 0.35 * options_.relief * static_cast<double>(noiseAt(seed + 1, narrow.x(), narrow.y()));
  z += terraceHeight(uv.x());
  const double track = static_cast<double>(wheelTrack(uv.y()));
  z += (1.0 - track) * options_.ridge *
       std::cos(2.0 * std::numbers::pi * uv.y() / options_.row_spacing - std::numbers::pi);
  return z - options_.track_depth * track;
}

double FieldModel::terraceHeight(double along) const {
  if (options_.terrace <= 0.0) return 0.0;
  // Flat, but for a short ramp at the end of each.
  const double at = along / options_.terrace_length;
  const double step = std::floor(at);
  const double ramp = std::min(1.0, kTerraceRamp / options_.terrace_length);
  const double up = std::max(0.0, (at - step - (1.0 - ramp)) / ramp);
  return options_.terrace * (step + up);
}

bool FieldModel::missing(std::int64_t row, std::int64_t index, double u) const {
  // Most gaps come in runs (a blocked drill, wild animals), some are single plants.
  const auto run = static_cast<std::int64_t>(std::floor(u / options_.gap_length));
  return hashUniform(hashBits(seed_, kGap), row, run) < static_cast<float>(0.6 * options_.gaps) ||
         hashUniform(hashBits(seed_, kMissing), row, index) <
             static_cast<float>(0.4 * options_.gaps);
}

FieldModel::Plot FieldModel::plotAt(std::int64_t row, double along) const {
  Plot plot;
  plot.species = species_;
  const PlotOptions& plots = options_.plots;
  if (!plots.any()) return plot;
  std::int64_t column = 0;
  if (plots.length > 0.0) {
    // The beds of a trial are laid out from one end of the field.
    const double pitch = plots.length + plots.alley;
    const double from = along / pitch + static_cast<double>(hashUniform(seed_, kPlot, 1));
    column = static_cast<std::int64_t>(std::floor(from));
    plot.bare = (from - std::floor(from)) * pitch >= plots.length;
  }
  const std::int64_t pitch_rows = plots.rows + plots.gap_rows;
  const auto bed = static_cast<std::int64_t>(
      std::floor(static_cast<double>(row) / static_cast<double>(pitch_rows)));
  plot.bare = plot.bare || row - bed * pitch_rows >= plots.rows;
  Random random(hashBits(hashBits(seed_, kPlot), column, bed));
  if (random.chance(plots.mixed)) plot.species = sown_[1 + random.below(sown_.size() - 1)].species;
  plot.size = static_cast<float>(
      std::clamp(std::exp(random.normal(plots.spread)), 1.0 / kBiggestPlot, kBiggestPlot));
  plot.tone = static_cast<float>(random.normal(2.0 * plots.spread));
  plot.ripeness = static_cast<float>(random.normal(2.0 * plots.spread));
  return plot;
}

void FieldModel::addRow(std::int64_t row, const Sown& sown, double u_min, double u_max,
                        const Window& window, double margin, std::vector<Plant>& plants) const {
  const double spacing = sown.spacing;
  const std::int64_t pass =
      static_cast<std::int64_t>(std::floor(static_cast<double>(row) / options_.pass_rows));
  Random row_random = Random::stream(hashBits(hashBits(seed_, kPass), pass, 0), 0);
  const double pass_shift = row_random.normal(options_.pass_error);
  const double phase =
      options_.synchronous ? 0.0 : static_cast<double>(hashUniform(hashBits(seed_, kPass), row, 1));
  const double v0 = (static_cast<double>(row) + 0.5) * options_.row_spacing + pass_shift;
  const std::int64_t salt =
      sown.species == species_ ? 7 : 8 + static_cast<std::int64_t>(sown.species);
  const std::uint64_t plant_seed = hashBits(hashBits(seed_, kPlant), row, salt);
  const Eigen::Vector2d centre(0.5 * options_.width, 0.5 * options_.height);
  const Eigen::Rotation2Dd turn(heading_);
  const auto first = static_cast<std::int64_t>(std::floor(u_min / spacing)) - 3;
  const auto last = static_cast<std::int64_t>(std::ceil(u_max / spacing)) + 3;
  for (std::int64_t index = first; index <= last; ++index) {
    const std::uint64_t id = hashBits(plant_seed, static_cast<std::uint64_t>(index));
    const double slot = (static_cast<double>(index) + phase) * spacing;
    const Plot plot = plotAt(row, slot);
    if (plot.bare || plot.species != sown.species || missing(row, index, slot)) continue;
    Random random(id);
    const double u = slot + random.normal(options_.plant_jitter * spacing);
    // A pass follows the tractor: its rows meander together.
    const double wobble =
        options_.row_wobble * static_cast<double>(noiseAt(hashBits(seed_, kWobble), u / 7.0,
                                                          static_cast<double>(pass) * 3.7));
    const double v = v0 + wobble + random.normal(options_.lateral_jitter);
    const Eigen::Vector2d point = centre + turn * Eigen::Vector2d(u, v);
    if (!inside(window, point, margin)) continue;
    // Narrow rows are not sown in the tracks; wide rows straddle them.
    if (options_.row_spacing < 0.3 && wheelTrack(v) > 0.5F && random.chance(0.95)) continue;
    Plant plant;
    plant.position = point.cast<float>();
    const double gradient = 1.0 + options_.growth_gradient * static_cast<double>(noiseAt(
                                                                 hashBits(seed_, kGrowth),
                                                                 point.x() / 6.0, point.y() / 6.0));
    const double spread = std::exp(random.normal(options_.size_spread));
    plant.size = static_cast<float>(options_.plant_size * std::max(0.3, gradient) *
                                    std::clamp(spread, 0.35, 1.7));
    plant.size *= plot.size;
    const float tone = static_cast<float>(random.normal(0.4)) +
                       0.5F * noiseAt(hashBits(seed_, kTone), point.x() / 3.0, point.y() / 3.0);
    plant.tone = static_cast<float>(options_.tone_spread) * tone + plot.tone;
    plant.ripeness = plot.ripeness;
    plant.id = id;
    plant.row = row;
    plant.species = sown.species;
    plants.push_back(plant);
  }
}

void FieldModel::addRows(const Window& window, double margin, std::vector<Plant>& plants) const {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e30);
  Eigen::Vector2d high = -low;
  for (const double x : {-margin, window.width() + margin}) {
    for (const double y : {-margin, window.height() + margin}) {
      const Eigen::Vector2d uv = rowCoordinates(window.field({x, y}));
      low = low.cwiseMin(uv);
      high = high.cwiseMax(uv);
    }
  }
  const double slack = 4.0 * (options_.row_wobble + options_.pass_error);
  const auto first =
      static_cast<std::int64_t>(std::floor((low.y() - slack) / options_.row_spacing)) - 1;
  const auto last =
      static_cast<std::int64_t>(std::ceil((high.y() + slack) / options_.row_spacing)) + 1;
  for (std::int64_t row = first; row <= last; ++row) {
    for (const Sown& sown : sown_) addRow(row, sown, low.x(), high.x(), window, margin, plants);
  }
}

void FieldModel::addScattered(const Window& window, double margin,
                              std::vector<Plant>& plants) const {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e30);
  Eigen::Vector2d high = -low;
  for (const double x : {-margin, window.width() + margin}) {
    for (const double y : {-margin, window.height() + margin}) {
      const Eigen::Vector2d corner = window.field({x, y});
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  constexpr double kSide = 0.25;  // of the squares that weeds and straw are drawn in
  const auto i0 = static_cast<std::int64_t>(std::floor(low.x() / kSide));
  const auto i1 = static_cast<std::int64_t>(std::floor(high.x() / kSide));
  const auto j0 = static_cast<std::int64_t>(std::floor(low.y() / kSide));
  const auto j1 = static_cast<std::int64_t>(std::floor(high.y() / kSide));
  const auto scatter = [&](std::uint64_t salt, double density, bool patches, auto&& finish) {
    if (density <= 0.0) return;
    for (std::int64_t j = j0; j <= j1; ++j) {
      for (std::int64_t i = i0; i <= i1; ++i) {
        Random random(hashBits(hashBits(seed_, salt), i, j));
        double mean = density * kSide * kSide;
        if (patches) {
          const float patch = noiseAt(hashBits(seed_, kPatch), static_cast<double>(i) * kSide / 3.0,
                                      static_cast<double>(j) * kSide / 3.0);
          // Log-normal patches with mean 1.
          mean *= std::exp(static_cast<double>(patch) - 0.5);
        }
        // Poisson by exponential waiting times.
        for (double t = -std::log(1.0 - random.uniform()); t < mean;
             t -= std::log(1.0 - random.uniform())) {
          const Eigen::Vector2d point((static_cast<double>(i) + random.uniform()) * kSide,
                                      (static_cast<double>(j) + random.uniform()) * kSide);
          Plant plant;
          plant.id = random.bits();
          plant.position = point.cast<float>();
          plant.tone = static_cast<float>(random.normal(0.6));
          finish(random, plant);
          if (inside(window, point, margin)) plants.push_back(plant);
        }
      }
    }
  };
  scatter(kStrawSeed, options_.straw, false, [&](Random& random, Plant& plant) {
    plant.species = Species::kStraw;
    plant.size = static_cast<float>(random.uniform(0.4, 1.4));
    plant.brightness = static_cast<float>(options_.soil.straw_brightness);
  });
  scatter(kStoneSeed, options_.soil.stones, false, [](Random& random, Plant& plant) {
    plant.species = Species::kStone;
    plant.size = static_cast<float>(std::exp(random.uniform(-0.9, 0.5)));
  });
  scatter(kWeed, options_.weeds, true, [](Random& random, Plant& plant) {
    plant.species = random.chance(0.6) ? Species::kBroadWeed : Species::kGrassWeed;
    plant.size = static_cast<float>(random.uniform(0.35, 1.2));
  });
}

std::vector<Plant> FieldModel::plantsIn(const Window& window, double reach) const {
  std::vector<Plant> plants;
  double farthest = 0.0;
  for (const Sown& sown : sown_) farthest = std::max(farthest, reachOf(sown.species));
  if (options_.plots.any()) farthest *= kBiggestPlot;
  const double biggest = 1.6 * options_.plant_size * std::max(1.0, reach);
  addScattered(window, reachOf(Species::kStraw) * std::max(1.0, reach), plants);
  addRows(window, farthest * biggest, plants);
  return plants;
}

}  // namespace agricolmap::simulate
