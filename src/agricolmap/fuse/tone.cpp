#include "agricolmap/fuse/tone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "agricolmap/fuse/strip_cells.hpp"

namespace agricolmap::fuse {
namespace {

constexpr double kLeastCells = 50.0;
constexpr double kMostGain = 2.0;

/// Colours of cells that both show.
struct Means {
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
  bool enough() const { return cells >= kLeastCells; }
};

/// All cells, and those of which both say the same.
struct Kinds {
  Means all, soil, plants;
};

Kinds kindsOf(const StripCells& strip, const Greenness& own, const map::GridMap& fixed,
              const Greenness& target) {
  constexpr float kPlant = 0.8F, kSoil = 0.2F;
  Kinds kinds;
  for (int r = 0; r < strip.depth.rows(); ++r) {
    for (int c = 0; c < strip.depth.cols(); ++c) {
      const int row = strip.row + r, col = strip.col + c;
      if (strip.depth(r, c) <= 0.0F || !fixed.valid(row, col)) continue;
      const Rgb from = strip.coarse.colour(r, c), to = fixed.colour(row, col);
      kinds.all.add(from, to);
      const float cover = own.cover(strip.coarse.exg(r, c));
      const float other = target.cover(fixed.exg(row, col));
      if (std::min(cover, other) >= kPlant) kinds.plants.add(from, to);
      if (std::max(cover, other) <= kSoil) kinds.soil.add(from, to);
    }
  }
  return kinds;
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
    const float to = gain[c] * static_cast<float>(value);
    return static_cast<std::uint8_t>(std::lround(std::clamp(to, 0.0F, 255.0F)));
  };
  return {moved(0, colour.r), moved(1, colour.g), moved(2, colour.b)};
}

Tone toneOf(const StripCells& strip, const Greenness& own, const map::GridMap& fixed,
            const Greenness& target, bool same_day) {
  const Kinds kinds = kindsOf(strip, own, fixed, target);
  std::vector<const Means*> used;
  if (kinds.soil.enough()) used.push_back(&kinds.soil);
  if (kinds.plants.enough() && same_day) used.push_back(&kinds.plants);
  if (used.empty()) used.push_back(&kinds.all);
  Tone tone;
  if (!used.front()->enough()) return tone;
  for (std::size_t c = 0; c < 3; ++c) {
    double products = 0.0, squares = 0.0;  // soil and plants weigh alike
    for (const Means* means : used) {
      const double from = means->own[c] / means->cells;
      products += from * means->target[c] / means->cells;
      squares += from * from;
    }
    if (squares > 0.0) {
      tone.gain[c] = static_cast<float>(std::clamp(products / squares, 1.0 / kMostGain, kMostGain));
    }
  }
  return tone;
}

}  // namespace agricolmap::fuse
