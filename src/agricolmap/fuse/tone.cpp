#include "agricolmap/fuse/tone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/fuse/strip_cells.hpp"

namespace agricolmap::fuse {
namespace {

/// Colours that differ less than this between soil and plants say little of a gain.
constexpr double kSpread = 15.0;
constexpr double kLeastCells = 50.0;

struct Mean {
  double cells = 0.0;
  std::array<double, 3> own{};
  std::array<double, 3> target{};

  void add(Rgb a, Rgb b) {
    cells += 1.0;
    const std::array<std::uint8_t, 3> from{a.r, a.g, a.b}, to{b.r, b.g, b.b};
    for (std::size_t c = 0; c < 3; ++c) {
      own[c] += from[c];
      target[c] += to[c];
    }
  }
  double ownMean(std::size_t c) const { return own[c] / cells; }
  double targetMean(std::size_t c) const { return target[c] / cells; }
};

/// Over the cells that both show: all, and soil and plants apart.
struct Means {
  Mean all, soil, plants;
  bool parted() const { return std::min(soil.cells, plants.cells) >= kLeastCells; }
};

Means meansOf(const StripCells& strip, const Greenness& own, const map::GridMap& fixed) {
  Means means;
  for (int r = 0; r < strip.depth.rows(); ++r) {
    for (int c = 0; c < strip.depth.cols(); ++c) {
      const int row = strip.row + r, col = strip.col + c;
      if (strip.depth(r, c) <= 0.0F || !fixed.valid(row, col)) continue;
      const Rgb from = strip.coarse.colour(r, c), to = fixed.colour(row, col);
      means.all.add(from, to);
      const float cover = own.cover(strip.coarse.exg(r, c));
      if (cover >= 0.8F) means.plants.add(from, to);
      if (cover <= 0.2F) means.soil.add(from, to);
    }
  }
  return means;
}

}  // namespace

float Greenness::cover(float exg) const {
  // Between a quarter and three quarters of the way from soil to plant, so that neither's noise
  // counts.
  constexpr double kBegin = 0.25, kEnd = 0.75;
  switch (found.status) {
    case map::VegetationStatus::kOk: {
      const double way =
          (static_cast<double>(exg) - found.soil_mean) / (found.vegetation_mean - found.soil_mean);
      return static_cast<float>(std::clamp((way - kBegin) / (kEnd - kBegin), 0.0, 1.0));
    }
    case map::VegetationStatus::kNoVegetation:
      return 0.0F;
    case map::VegetationStatus::kClosedCanopy:
      return 1.0F;
    case map::VegetationStatus::kExtremeShare:
      return found.share > 0.5 ? 1.0F : 0.0F;
    case map::VegetationStatus::kTooFewCells:
    case map::VegetationStatus::kConstant:
      break;
  }
  return std::numeric_limits<float>::quiet_NaN();
}

Greenness greennessOf(const map::GridMap& map) { return {map::vegetationThreshold(map, {})}; }

Rgb Tone::operator()(Rgb colour) const {
  const auto moved = [&](std::size_t c, std::uint8_t value) {
    const float to = std::fma(gain[c], static_cast<float>(value), offset[c]);
    return static_cast<std::uint8_t>(std::lround(std::clamp(to, 0.0F, 255.0F)));
  };
  return {moved(0, colour.r), moved(1, colour.g), moved(2, colour.b)};
}

Tone toneOf(const StripCells& strip, const Greenness& own, const map::GridMap& fixed,
            const Greenness& target) {
  const Means means = meansOf(strip, own, fixed);
  Tone tone;
  if (means.all.cells < kLeastCells) return tone;
  for (std::size_t c = 0; c < 3; ++c) {
    double gain = 1.0, from = means.all.ownMean(c), to = means.all.targetMean(c);
    if (means.parted()) {
      const double own_step = means.plants.ownMean(c) - means.soil.ownMean(c);
      const double step = means.plants.targetMean(c) - means.soil.targetMean(c);
      constexpr double kPrior = kSpread * kSpread;
      gain = (own_step * step + kPrior) / (own_step * own_step + kPrior);
      from = 0.5 * (means.plants.ownMean(c) + means.soil.ownMean(c));
      to = 0.5 * (means.plants.targetMean(c) + means.soil.targetMean(c));
    }
    tone.gain[c] = static_cast<float>(gain);
    tone.offset[c] = static_cast<float>(to - gain * from);
  }
  if (own.found.status == map::VegetationStatus::kOk &&
      target.found.status == map::VegetationStatus::kOk) {
    const double gain = (target.found.vegetation_mean - target.found.soil_mean) /
                        (own.found.vegetation_mean - own.found.soil_mean);
    tone.exg_gain = static_cast<float>(gain);
    tone.exg_offset = static_cast<float>(target.found.soil_mean - gain * own.found.soil_mean);
  }
  return tone;
}

}  // namespace agricolmap::fuse
