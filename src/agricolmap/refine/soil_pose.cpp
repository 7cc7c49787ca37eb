#include "agricolmap/refine/soil_pose.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/map/box_mean.hpp"
#include "agricolmap/map/hidden_ground.hpp"
#include "agricolmap/refine/dense_refine.hpp"

namespace agricolmap::refine {

void listOptions(OptionTable& table, SoilPoseOptions& options) {
  table.flag("follow", options.follow,
             "end where bare soil between the plants lies upon itself, where both maps show it");
  table.number("wave", options.wave, 0.05, 2.0, "m",
               "of soil, brightness is compared up to this wavelength");
  table.number("bare", options.bare, 0.0, 1.0, "",
               "bare soil lies below this share of the way from soil to plant");
  table.number("margin", options.margin, 0.0, 0.5, "m", "and this far from all plants");
  table.number("reach", options.reach, 0.05, 0.5, "m",
               "how far around the plants' pose the soil's is looked for");
  table.number("share", options.share, 0.0, 1.0, "",
               "of the strip must be bare soil in both maps, or it is not followed");
  table.number("agree", options.agree, 0.0, 1.0, "",
               "correlation of the soil of both maps, below which it is not followed");
  table.number("clear", options.clear, 3.0, 1000.0, "deviations",
               "how far it must stand out among other shifts");
}

namespace {

/// A peak must lead the highest one elsewhere by so many deviations.
constexpr double kLead = 2.0;
/// What is farther from the peak than this is elsewhere [m].
constexpr double kApart = 0.08;
constexpr float kSeen = 0.5F;  // share of a cell
constexpr std::size_t kLeastCells = 100;
/// The soil contradicts the plants where it stands out less at their place by so many deviations.
constexpr double kContradicted = 1.0;
/// So many cells tell the peak as well as more do.
constexpr std::size_t kMostCells = 4000;
/// The plants' pose may be stretched by centimetres at the strip's corners [cells].
constexpr double kMaxMove = 8.0;

/// What of `map` is bare soil; the cells of plants and those near to them are taken out.
map::GridMap bareSoil(const map::GridMap& map, const SoilPoseOptions& options) {
  map::GridMap soil = map;
  const Raster<float> bare = map::bareGround(map, options.bare);
  Raster<float> plant(map.frame.rows, map.frame.cols);
  for (std::size_t i = 0; i < plant.size(); ++i) {
    plant[i] = map.valid(i) && bare[i] == 0.0F ? 1.0F : 0.0F;
  }
  const Raster<float> all(map.frame.rows, map.frame.cols, 1.0F);
  const int margin = static_cast<int>(std::lround(options.margin / map.frame.cell));
  const Raster<float> near = map::BoxMean(all, margin).of(plant);
  for (std::size_t i = 0; i < near.size(); ++i) {
    // Running sums leave a rounding of zero.
    if (near[i] > 1e-3F) soil.weight[i] = 0.0F;
  }
  return soil;
}

struct SoilCell {
  Eigen::Vector2d place;  ///< where the plants' pose puts it
  double bright;
};

std::vector<SoilCell> cellsOf(const map::SignalMap& soil, const Eigen::Affine2d& pose) {
  std::vector<SoilCell> cells;
  for (int r = 0; r < soil.frame.rows; ++r) {
    for (int c = 0; c < soil.frame.cols; ++c) {
      if (soil.weight(r, c) < kSeen) continue;
      cells.push_back({pose * soil.frame.centre(r, c),
                       static_cast<double>(soil.channel[map::kLuminanceChannel](r, c))});
    }
  }
  return cells;
}

struct Match {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  double cells = 0.0;
  double score = 0.0;  ///< correlation times the root of the cells: chance gives about the same
};

Match matchAt(const map::SignalMap& fixed, const std::vector<SoilCell>& cells, std::size_t step,
              const Eigen::Vector2d& shift) {
  Match match{shift};
  double fm = 0.0, ff = 0.0, mm = 0.0;
  for (std::size_t i = 0; i < cells.size(); i += step) {
    const map::SignalSample look = map::sampleSignal(fixed, cells[i].place + shift);
    if (look.weight < kSeen) continue;
    const auto bright = static_cast<double>(look.value[map::kLuminanceChannel]);
    fm += bright * cells[i].bright;
    ff += bright * bright;
    mm += cells[i].bright * cells[i].bright;
    match.cells += 1.0;
  }
  if (ff > 0.0 && mm > 0.0) match.score = fm / std::sqrt(ff * mm) * std::sqrt(match.cells);
  return match;
}

/// All shifts of whole cells within reach; the middle one is none.
std::vector<Match> matchesAround(const map::SignalMap& fixed, const std::vector<SoilCell>& cells,
                                 double reach) {
  const double cell = fixed.frame.cell;
  const int far = std::max(1, static_cast<int>(std::lround(reach / cell)));
  const int side = 2 * far + 1;
  const std::size_t step = 1 + cells.size() / kMostCells;
  std::vector<Match> matches(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  parallelFor(matches.size(), [&](std::size_t i) {
    const int row = static_cast<int>(i) / side - far, col = static_cast<int>(i) % side - far;
    matches[i] = matchAt(fixed, cells, step, cell * Eigen::Vector2d(col, row));
  });
  return matches;
}

/// What a clear peak stands out from.
struct Elsewhere {
  double mean = 0.0, deviation = 0.0, highest = 0.0;
};

Elsewhere awayFrom(const Match& peak, const std::vector<Match>& matches) {
  double count = 0.0, sum = 0.0, sum2 = 0.0;
  Elsewhere elsewhere{.highest = -1.0};
  for (const Match& match : matches) {
    if ((match.shift - peak.shift).norm() < kApart) continue;
    count += 1.0;
    sum += match.score;
    sum2 += match.score * match.score;
    elsewhere.highest = std::max(elsewhere.highest, match.score);
  }
  if (count == 0.0) return elsewhere;
  elsewhere.mean = sum / count;
  elsewhere.deviation = std::sqrt(std::max(0.0, sum2 / count - elsewhere.mean * elsewhere.mean));
  return elsewhere;
}

}  // namespace

SoilWitness askSoil(const map::GridMap& fixed, const map::GridMap& moving,
                    const Eigen::Affine2d& plants, int factor, const SoilPoseOptions& options) {
  SoilWitness witness;
  const map::SignalOptions signal{
      .high_pass = options.wave, .clip = 3.0, .term = map::SignalTerm::kRgb};
  const map::SignalMap there = map::makeSignalMap(bareSoil(fixed, options), factor, signal);
  const map::SignalMap here = map::makeSignalMap(bareSoil(moving, options), factor, signal);
  if (!there.has(map::kLuminanceChannel) || !here.has(map::kLuminanceChannel)) return witness;
  const std::vector<SoilCell> cells = cellsOf(here, plants);
  if (cells.size() < kLeastCells) return witness;
  const std::vector<Match> matches = matchesAround(there, cells, options.reach);
  const Match& none = matches[matches.size() / 2];
  const Match& peak =
      *std::max_element(matches.begin(), matches.end(),
                        [](const Match& a, const Match& b) { return a.score < b.score; });
  const Elsewhere elsewhere = awayFrom(peak, matches);
  if (elsewhere.deviation <= 0.0) return witness;
  const auto contrast = [&](double score) {
    return (score - elsewhere.mean) / elsewhere.deviation;
  };
  std::size_t seen = 0;
  for (std::size_t i = 0; i < moving.weight.size(); ++i) seen += moving.valid(i) ? 1 : 0;
  const std::size_t every = 1 + cells.size() / kMostCells;
  const auto step = static_cast<double>(every);
  witness.share = none.cells * step * factor * factor / static_cast<double>(seen);
  witness.peak = contrast(peak.score);
  witness.at_plants = contrast(none.score);
  witness.correlation = peak.score / std::sqrt(peak.cells);
  if (witness.share < options.share || witness.correlation < options.agree ||
      witness.peak < options.clear || witness.peak < contrast(elsewhere.highest) + kLead) {
    return witness;
  }
  DenseRefineOptions dense;
  dense.max_move = kMaxMove;
  const DenseRefineResult refined =
      refineDense(there, here, Eigen::Translation2d(peak.shift) * plants, dense);
  if (refined.status == RefineStatus::kConverged) witness.pose = refined.fixed_from_moving;
  return witness;
}

Eigen::Affine2d heardTogether(const Eigen::Affine2d& plants, const SoilWitness& soil) {
  if (!soil.pose) return plants;
  const double share = soil.at_plants < soil.peak - kContradicted ? 1.0 : 0.5;
  Eigen::Affine2d together = plants;
  together.affine() += share * (soil.pose->affine() - plants.affine());
  return together;
}

}  // namespace agricolmap::refine
